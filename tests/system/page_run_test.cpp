// Report pages of whole runs.
#include <system/run_command.hpp>

#include <gridmorph/page/html.hpp>
#include <gridmorph/page/page_parts.hpp>

#include <nlohmann/json.hpp>

#include <regex>
#include <sstream>
#include <string>

namespace gridmorph::test {
namespace {

using PageRun = CommandTest;

/// Without what differs between two runs of one command: times, dates, paths of the outputs.
std::string without_times(std::string text) {
  std::size_t const timings = text.find("<section id=\"timings\"");
  text = text.substr(0, timings);
  return std::regex_replace(text, std::regex("<span>time</span><b>[^<]*</b>"), "");
}

TEST_F(PageRun, HasTheNumbersOfTheReport) {
  Outcome const run = gridmorph("morph rotation.toml --html page.html --report r.json");
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.err, "");
  EXPECT_NE(run.out.find("wrote page.html"), std::string::npos);
  std::string const text = contents(path("page.html"));
  auto const report = nlohmann::json::parse(contents(path("r.json")));
  for (char const* region : {"near_field", "far_field"})
    for (auto const& [name, measure] : report["morphed"][region]["measures"].items()) {
      if (name != "determinant_3x3x3" && name != "minimum_angle_deg" && name != "aspect_ratio") continue;
      EXPECT_NE(text.find(">" + page::number(measure["worst"]["value"]) + "<"), std::string::npos) << name;
      EXPECT_NE(text.find(">" + page::number(measure["mean"]) + "<"), std::string::npos) << name;
    }
  EXPECT_NE(text.find(page::number(100 * report["morphed"]["walls"]["first_height_change"]["max"].get<double>())),
            std::string::npos);
  for (auto const& step : report["times"]["steps"])
    EXPECT_NE(text.find("<td>" + step["step"].get<std::string>() + "</td>"), std::string::npos);
  EXPECT_NE(text.find("gridmorph morph rotation.toml --html page.html --report r.json"), std::string::npos);
  EXPECT_NE(text.find("rule    = &quot;circumferential-slide&quot;"), std::string::npos) << "the case file is in it";
}

TEST_F(PageRun, IsTheSameInEveryRunButForTimes) {
  ASSERT_EQ(gridmorph("--threads 1 morph rotation.toml --html a.html").status, 0);
  ASSERT_EQ(gridmorph("--threads 2 morph rotation.toml --html b.html").status, 0);
  EXPECT_EQ(without_times(contents(path("a.html"))), without_times(contents(path("b.html"))));
}

TEST_F(PageRun, HasSizeAndChecksumOfWhatWasReadAndWritten) {
  ASSERT_EQ(gridmorph("morph rotation.toml -o moved.cgns --html page.html").status, 0);
  std::string const text = contents(path("page.html"));
  for (std::string const name : {"passage.cgns", "rotation.csv", "moved.cgns"}) {
    Outcome const sum = shell("cksum " + name);  // of POSIX.1: CRC, bytes, name
    ASSERT_EQ(sum.status, 0) << sum.err;
    std::istringstream in(sum.out);
    std::string crc, bytes;
    in >> crc >> bytes;
    EXPECT_NE(text.find(bytes + " bytes, cksum " + crc), std::string::npos) << name;
  }
}

TEST_F(PageRun, LeavesTheMeshAndTheReportAsTheyAre) {
  ASSERT_EQ(gridmorph("morph rotation.toml -o plain.cgns --report plain.json").status, 0);
  ASSERT_EQ(gridmorph("morph rotation.toml -o paged.cgns --report paged.json --html page.html").status, 0);
  auto plain = nlohmann::json::parse(contents(path("plain.json"))),
       paged = nlohmann::json::parse(contents(path("paged.json")));
  for (auto* report : {&plain, &paged})
    for (char const* key : {"times", "output"}) report->erase(key);
  EXPECT_EQ(plain, paged);
}

TEST_F(PageRun, TellsOfAVerdictAloneWhatItHas) {
  ASSERT_EQ(gridmorph("morph rotation.toml --quality fast --html page.html").status, 0);
  std::string const text = contents(path("page.html"));
  EXPECT_NE(text.find("A verdict was measured"), std::string::npos);
  EXPECT_NE(text.find("class=\"histogram\""), std::string::npos);
}

TEST_F(PageRun, IsThereWhereTheMeshIsRefused) {
  std::string text = contents(path("rotation.toml"));
  std::string const file = "file    = \"rotation.csv\"";
  write("case.toml",
        text.replace(text.find(file), file.size(), file + "\namplitude = 10") + "\n[guard]\nretry = false\n");
  Outcome const run = gridmorph("morph case.toml -o out.cgns --html page.html");
  ASSERT_EQ(run.status, 4) << run.err;
  EXPECT_NE(contents(path("page.html")).find("Inverted: nothing was written"), std::string::npos);
  expect_nothing_written();
}

TEST_F(PageRun, IsAKeyOfCaseFiles) {
  std::string const rules = contents(path("rotation.toml"));
  write("case.toml", rules + "\n[output]\nhtml = \"made.html\"\n");
  ASSERT_EQ(gridmorph("morph case.toml").status, 0);
  EXPECT_NE(contents(path("made.html")).find("</html>"), std::string::npos);
}

TEST_F(PageRun, OfAWheelHasEveryPassageAndShowsTheWorst) {
  std::string const rules = contents(path("rotation.toml"));
  std::string const wheel =
      "\n[wheel]\noutput = \"wheel.cgns\"\npassages = 4\nfactors = [1, 0.5, -1, 0.5]\n[output]\nhtml = \"own.html\"\n";
  write("wheel.toml", rules + wheel);
  Outcome const run = gridmorph("wheel wheel.toml --html page.html --report r.json");
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.out.find("wrote page.html"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(path("own.html"))) << "the option comes before the key";
  std::string const text = contents(path("page.html"));
  auto const report = nlohmann::json::parse(contents(path("r.json")));
  ASSERT_EQ(report["passages"].size(), 4U);
  std::size_t worst = 0;
  double least = 2;
  for (std::size_t p = 0; p < 4; ++p) {
    auto const of_all = page::worst_of(report["passages"][p]["quality"], "determinant_3x3x3", false);
    EXPECT_NE(text.find(">" + page::number(of_all["value"]) + "<"), std::string::npos) << "passage " << p + 1;
    EXPECT_NE(text.find(">" + page::number(report["passages"][p]["largest_displacement"]) + "<"), std::string::npos);
    if (of_all["value"].get<double>() < least) {
      least = of_all["value"];
      worst = p + 1;
    }
  }
  EXPECT_NE(text.find("The 4 passages"), std::string::npos);
  // Cards are of all passages.
  std::string const card = " \u2192 " + page::number(least) + "</b><small>passage " + std::to_string(worst) + ", zone";
  EXPECT_NE(text.find(card), std::string::npos) << card;
  EXPECT_NE(text.find("No cell is inverted in any of 4 passages"), std::string::npos);
  EXPECT_NE(text.find("Of passage " + std::to_string(worst) + ", the worst one"), std::string::npos) << worst;
  for (std::string const part : {"class=\"histogram\"", "Span 50 %", "data:image/png", "the whole of all"})
    EXPECT_NE(text.find(part), std::string::npos) << part;
  std::istringstream sum(shell("cksum wheel.cgns").out);
  std::string crc;
  sum >> crc;
  EXPECT_NE(text.find("cksum " + crc), std::string::npos);
}

TEST_F(PageRun, OfAWheelSaysInHowManyPassagesCellsAreInverted) {
  write("wheel.toml",
        contents(path("rotation.toml")) + "\n[wheel]\noutput = \"out.cgns\"\npassages = 3\nfactors = [1, 12, 1]\n");
  Outcome const run = gridmorph("wheel wheel.toml --html page.html");
  ASSERT_EQ(run.status, 4) << run.err;
  std::string const text = contents(path("page.html"));
  EXPECT_NE(text.find("Inverted: nothing was written"), std::string::npos);
  EXPECT_NE(text.find(" of 3 passages turned inside out"), std::string::npos);
  expect_nothing_written();
}

TEST_F(PageRun, OfAWheelOverTimeShowsTheWorstPassageOfTheWorstStep) {
  std::string text = contents(path("rotation.toml"));
  std::string const file = "file    = \"rotation.csv\"";
  text.replace(text.find(file), file.size(), file + "\namplitude = \"0.5 - cos(2 * pi * t)\"");
  write("wheel.toml", text +
                          "\n[wheel]\noutput = \"out_{step}.cgns\"\npassages = 2\nfactors = [1, 0.5]\n[sequence]\n"
                          "steps = 2\n[guard]\nmax_trim = 1\n");
  Outcome const run = gridmorph("wheel wheel.toml --html page.html --report r.json");
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.out.find("wrote page.html"), std::string::npos);
  std::string const html = contents(path("page.html"));
  auto const report = nlohmann::json::parse(contents(path("r.json")));
  auto const& steps = report["sequence"]["steps"];
  ASSERT_EQ(steps.size(), 2U);
  int const worst = report["sequence"]["worst_step"];
  EXPECT_EQ(worst, 2) << "the rotation goes farthest there";
  for (auto const& step : steps) {
    auto const& least = step["min_determinant"];
    auto const number = std::to_string(step["worst_passage"].get<int>());
    EXPECT_NE(html.find(">" + page::number(least["value"]) + "<"), std::string::npos);
    EXPECT_NE(html.find(">passage " + number + ", " + page::escaped(page::place_of(least)) + "<"), std::string::npos);
    EXPECT_EQ(least["value"], step["passages"][step["worst_passage"].get<std::size_t>() - 1]["min_determinant"]);
    for (auto const& passage : step["passages"])
      EXPECT_LE(passage["largest_displacement"], step["largest_displacement"]);
  }
  for (std::string const part :
       {"The 2 steps", "The 2 passages", "Over all steps", "At step 2, the worst one", "Of step 2, the worst one",
        "Passage 1, the worst one at step 2", "No cell is inverted in any of 2 steps", "of the wheel of the worst step",
        "class=\"curve\"", "class=\"histogram\"", "Span 50 %", "data:image/png"})
    EXPECT_NE(html.find(part), std::string::npos) << part;
}

TEST_F(PageRun, RefusesPathsBeforeTheRun) {
  expect_bad_input(gridmorph("morph rotation.toml -o out.cgns --html nowhere/page.html"),
                   {"page 'nowhere/page.html'", "make it first"});
  expect_bad_input(gridmorph("morph rotation.toml -o out.cgns --html rotation.toml"), {"never overwritten"});
  expect_bad_input(gridmorph("morph rotation.toml -o out.cgns --html page.cgns"), {"HTML"});
  expect_bad_input(gridmorph("morph rotation.toml -o out.cgns --html r.json --report r.json"), {"the same file"});
}

}  // namespace
}  // namespace gridmorph::test
