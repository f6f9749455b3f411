// Times of the steps of a morph as text and JSON.
#include <gridmorph/report/progress_text.hpp>
#include <gridmorph/report/step_times.hpp>

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>

namespace gridmorph {
namespace {

StepTimes const times{{"read", 0.25, true}, {"topology", 0.125}, {"morph", 0.5, true}, {"write", 0, true}};

TEST(StepTimes, TheTableHasOneRowPerStepInOrderAndTheirSum) {
  std::istringstream table(format_times(times, 4'000'000));
  std::string line, heading;
  std::getline(table, heading);
  EXPECT_NE(heading.find("4000000 nodes"), std::string::npos);
  for (auto const& [first, second] : {std::pair<std::string, std::string>{"read", "0.2500"},
                                      {"topology", "0.1250"},
                                      {"morph", "0.5000"},
                                      {"write", "0.0000"},
                                      {"total", "0.8750"}}) {
    ASSERT_TRUE(std::getline(table, line)) << first;
    std::istringstream words(line);
    std::string a, b;
    words >> a >> b;
    EXPECT_EQ(a, first);
    EXPECT_EQ(b, second);
  }
  EXPECT_FALSE(std::getline(table, line));
}

TEST(StepTimes, RatesAreGivenForVolumeWorkThatTookTime) {
  nlohmann::json const json = times_json(times, 4'000'000);
  EXPECT_EQ(json["nodes"], 4'000'000);
  EXPECT_EQ(json["total_seconds"], 0.875);
  ASSERT_EQ(json["steps"].size(), times.size());
  EXPECT_EQ(json["steps"][0]["nodes_per_second"], 16e6);
  EXPECT_TRUE(json["steps"][1]["nodes_per_second"].is_null()) << "topology does not touch every node";
  EXPECT_EQ(json["steps"][2]["nodes_per_second"], 8e6);
  EXPECT_TRUE(json["steps"][3]["nodes_per_second"].is_null()) << "no time, no rate";
  std::string const text = format_times(times, 4'000'000);
  EXPECT_NE(text.find("16.0"), std::string::npos);
  EXPECT_EQ(text.find("inf"), std::string::npos);
}

TEST(StepTimes, NothingMeasuredIsATableWithoutRows) {
  EXPECT_EQ(times_json({}, 0)["total_seconds"], 0);
  std::string const text = format_times({}, 0);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2);
  EXPECT_EQ(text.find("nan"), std::string::npos);
}

TEST(Progress, SaysPercentAndTimeLeftOnceItCanBeTold) {
  EXPECT_EQ(progress_text("reading", {}, 100), "reading");
  EXPECT_EQ(progress_text("reading", 0, 100), "reading, 0 %");
  EXPECT_EQ(progress_text("step 2 of 4", 0.25, 1), "step 2 of 4, 25 %");
  EXPECT_EQ(progress_text("step 2 of 4", 0.25, 10), "step 2 of 4, 25 %, about 30 s left");
  EXPECT_EQ(progress_text("step 4 of 4", 0.75, 5400), "step 4 of 4, 75 %, about 30 min left");
  EXPECT_EQ(progress_text("step 2 of 11", 0.1, 3600), "step 2 of 11, 10 %, about 9 h left");
}

TEST(Progress, StagesCountByTheirCostAndOneTooManyIsUnknown) {
  StagedProgress stages;
  EXPECT_FALSE(stages.advance());
  stages.expect({2, 5, 3});
  EXPECT_EQ(stages.advance(), 0.0);
  EXPECT_EQ(stages.advance(), 0.2);
  EXPECT_EQ(stages.advance(), 0.7);
  EXPECT_FALSE(stages.advance());
}

TEST(Progress, ALogGetsALineNowAndThen) {
  LogPace pace(10);
  int lines = 0;
  for (double now = 0; now < 100; now += 0.5) lines += pace.due(now) ? 1 : 0;
  EXPECT_EQ(lines, 9);
  EXPECT_FALSE(LogPace(10).due(9.9));  // short runs have none
}

}  // namespace
}  // namespace gridmorph
