// Options, help, exit statuses and output channels.
#include "run_command.hpp"

#include <gridmorph/case/case_file.hpp>

#include <nlohmann/json.hpp>

#include <fstream>
#include <iterator>

namespace gridmorph::test {
namespace {

using CommandLine = CommandTest;

TEST_F(CommandLine, HelpAndVersionSucceed) {
  EXPECT_EQ(gridmorph("--version").status, 0);
  EXPECT_NE(gridmorph("--version").out.find("gridmorph "), std::string::npos);
  Outcome const help = gridmorph("--help");
  EXPECT_EQ(help.status, 0);
  for (std::string const word : {"morph", "inspect", "plan", "quality", "demo", "--quiet", "Exit status"})
    EXPECT_NE(help.out.find(word), std::string::npos) << word;
  EXPECT_EQ(gridmorph("morph --help").status, 0);
}

TEST_F(CommandLine, WrongCommandLinesAreBadInput) {
  expect_bad_input(gridmorph(""), {"subcommand"});
  expect_bad_input(gridmorph("morhp rotation.toml"), {"'morhp'", "'morph'"});
  expect_bad_input(gridmorph("morph"), {"case"});
  expect_bad_input(gridmorph("inspect passage.cgns --jsn"), {"--jsn"});
  expect_bad_input(gridmorph("--threads 0 inspect passage.cgns"), {"threads"});
  expect_bad_input(gridmorph("--threads many inspect passage.cgns"), {"many"});
  expect_bad_input(gridmorph("demo bal"), {"'bal'", "'ball'"});
  expect_bad_input(gridmorph("demo passage --nodes 5"), {"nodes"});
  expect_bad_input(gridmorph("demo passage --motion sideways"), {"sideways", "rotation"});
  expect_bad_input(gridmorph("demo passage --elements 60000"), {"--elements", "'ball'"});
  expect_bad_input(gridmorph("demo ball --nodes 60000"), {"--nodes", "'passage'"});
  expect_bad_input(gridmorph("demo ball --elements 5"), {"elements"});
  expect_bad_input(gridmorph("demo ball --elements 60000 --angle 100 -d none"), {"100 degrees", "crane"});
}

TEST_F(CommandLine, OptionsMayStandBeforeAndAfterTheCommand) {
  EXPECT_EQ(gridmorph("--threads 1 inspect passage.cgns").status, 0);
  EXPECT_EQ(gridmorph("inspect passage.cgns --threads 2 --quiet").status, 0);
}

TEST_F(CommandLine, InspectNamesWhatACaseFileCouldName) {
  Outcome const run = gridmorph("inspect passage.cgns");
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.err, "");
  for (std::string const word : {"blade", "hub", "case", "inlet", "outlet", "family", "wall", "inflow", "36 sectors",
                                 "rotation of 10 degrees", "[mesh]", "[[motion]]"})
    EXPECT_NE(run.out.find(word), std::string::npos) << word;
  EXPECT_EQ(run.out.find('\x1b'), std::string::npos) << "colours into a pipe";
}

TEST_F(CommandLine, InspectAsJsonSaysTheSame) {
  Outcome const run = gridmorph("inspect --json passage.cgns");
  ASSERT_EQ(run.status, 0) << run.err;
  auto const json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json["zones"].size(), 12u);
  EXPECT_TRUE(json["problems"].empty());
  EXPECT_EQ(json["periodic"].at(0)["rotation"]["sectors"], 36);
  bool found = false;
  for (auto const& b : json["boundaries"])
    if (b["name"] == "hub") {
      found = true;
      EXPECT_EQ(b["source"], "family");
      EXPECT_EQ(b["kinds"], nlohmann::json::array({"wall"}));
      EXPECT_NE(b["guess"].get<std::string>().find("innermost: hub"), std::string::npos);
    }
  EXPECT_TRUE(found);
}

TEST_F(CommandLine, TheCaseFileThatInspectSuggestsIsReadAndRuns) {
  auto const json = nlohmann::json::parse(gridmorph("inspect --json passage.cgns").out);
  write("suggested.toml", json["case_file"]);
  CaseFile const c = read_case_file(path("suggested.toml"));
  EXPECT_EQ(c.motion.rules.size(), 4u);
  Outcome const run = gridmorph("morph suggested.toml");
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(std::filesystem::exists(path("passage_morphed.cgns")));
}

TEST_F(CommandLine, PlanPrintsStagesAndWritesNothing) {
  Outcome const run = gridmorph("plan rotation.toml");
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.out.find("near field"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(path("passage_rotation.cgns")));
}

TEST_F(CommandLine, PlanIsDrawnAsSvgOrForGraphviz) {
  for (std::string const name : {"plan.svg", "plan.dot", "plan.gv"}) {
    Outcome const run = gridmorph("plan rotation.toml --graph " + name);
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.out.find("wrote " + name), std::string::npos);
    std::string const text = contents(path(name));
    EXPECT_EQ(text.rfind(name == "plan.svg" ? "<svg" : "graph", 0), 0U) << name;
    for (std::string const word : {"near field", "iteration 1", "blade", "periodic"})
      EXPECT_NE(text.find(word), std::string::npos) << name << ": " << word;
  }
  EXPECT_EQ(contents(path("plan.dot")), contents(path("plan.gv")));
  expect_bad_input(gridmorph("plan rotation.toml --graph plan.png"), {"plan.png", "NAME.svg"});
}

TEST_F(CommandLine, QualityMeasuresOneMeshAndRefusesToCompareDifferentOnes) {
  Outcome const one = gridmorph("quality passage.cgns");
  EXPECT_EQ(one.status, 0) << one.err;
  EXPECT_NE(one.out.find("determinant"), std::string::npos);
  Outcome const json = gridmorph("quality --json passage.cgns passage.cgns");
  EXPECT_EQ(json.status, 0) << json.err;
  EXPECT_TRUE(nlohmann::json::parse(json.out).contains("morphed"));
  Outcome const made = gridmorph("--quiet demo passage -n 20000 -m rotation -d other");
  EXPECT_EQ(made.status, 0) << made.err;
  expect_bad_input(gridmorph("quality passage.cgns other/passage.cgns"), {"zone", "baseline"});
}

TEST_F(CommandLine, QuietDemoPrintsNothingAndLeavesItsFiles) {
  Outcome const run = gridmorph("demo passage -n 10000 -m chord -d here --quiet --threads 2");
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.out, "");
  for (std::string const name : {"passage.cgns", "chord.csv", "chord.toml", "passage_chord.cgns", "passage_chord.json"})
    EXPECT_TRUE(std::filesystem::exists(path("here") / name)) << name;
}

TEST_F(CommandLine, ADemoInSinglePrecisionAboutAnotherAxisWithFineFirstCellsIsSound) {
  Outcome const run =
      gridmorph("demo passage -n 20000 -m chord -d fine --first-cell 1e-5 --single --axis 0,3,4 --quiet --threads 2");
  EXPECT_LE(run.status, 1) << run.out << run.err;
  Outcome const read = gridmorph("inspect fine/passage.cgns --json");
  EXPECT_EQ(read.status, 0) << read.err;
  std::ifstream in(path("fine/chord.toml"));
  std::string const text{std::istreambuf_iterator<char>(in), {}};
  EXPECT_NE(text.find("0.6"), std::string::npos) << text;
  expect_bad_input(gridmorph("demo passage --axis w"), {"'w'", "1,2,3"});
  expect_bad_input(gridmorph("demo passage --first-cell 0.5"), {"0.5", "span"});
  expect_bad_input(gridmorph("demo ball --single"), {"--single", "'passage'"});
}

TEST_F(CommandLine, MoreThreadsThanThereArePlacesForAreCutDownWithAWarning) {
  for (char const* command : {"$G keys -t 4096 mesh", "$G inspect -q -t 1024 passage.cgns",
                              "OMP_NUM_THREADS=900 $G inspect -q passage.cgns"}) {
    Outcome const run = shell(command);
    EXPECT_EQ(run.status, 0) << run.err;
    if (std::string(command).find("keys") == std::string::npos) {
      EXPECT_NE(run.err.find("at most 512"), std::string::npos) << run.err;
    }
  }
}

TEST_F(CommandLine, AReaderThatGoesAwayIsNoFailure) {
  Outcome const run = shell("( $G inspect --json passage.cgns; echo $? >status ) | true");
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(contents(path("status")), "0\n");
}

TEST_F(CommandLine, AnOutputThatCannotBeWrittenIsAFailureOfTheMachine) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "needs /dev/full";
  Outcome const run = shell("$G inspect passage.cgns >/dev/full");
  EXPECT_EQ(run.status, 3);
  EXPECT_NE(run.err.find("gridmorph: error: standard output"), std::string::npos);
}

}  // namespace
}  // namespace gridmorph::test
