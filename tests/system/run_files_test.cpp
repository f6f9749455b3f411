// Files of a run: inputs stay as they are, outputs are ordinary files of their own, nothing is left behind.
#include "run_command.hpp"

#include <algorithm>

#include <sys/stat.h>

namespace gridmorph::test {
namespace {

class RunFiles : public CommandTest {
 protected:
  /// Bad input that names what is wrong, and leaves every file of the folder as it was.
  void expect_refused(std::string const& arguments, std::vector<std::string> const& words) const {
    auto const before = all_contents();
    Outcome const run = gridmorph(arguments);
    EXPECT_EQ(run.status, 2) << arguments << "\n" << run.err;
    for (auto const& word : words) EXPECT_NE(run.err.find(word), std::string::npos) << word << " not in: " << run.err;
    EXPECT_EQ(all_contents(), before) << arguments;
  }
  [[nodiscard]] std::vector<std::string> left_behind() const {
    std::vector<std::string> out;
    for (auto const& entry : std::filesystem::directory_iterator(path(".")))
      if (std::string const name = entry.path().filename().string(); name.find(".part") != std::string::npos)
        out.push_back(name);
    return out;
  }

 private:
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> all_contents() const {
    std::vector<std::pair<std::string, std::string>> out;
    for (auto const& entry : std::filesystem::recursive_directory_iterator(path(".")))
      if (std::string const name = entry.path().string(); entry.is_regular_file() && name.find(".std") == name.npos)
        out.emplace_back(name, contents(entry.path()));
    std::sort(out.begin(), out.end());
    return out;
  }
};

TEST_F(RunFiles, NoInputIsTakenForAnOutput) {
  write("table.csv", contents(path("rotation.csv")));
  write("side.toml", "");
  write("case.toml",
        "[mesh]\ninput = \"passage.cgns\"\noutput = \"out.cgns\"\naxis = \"x\"\nside_file = \"side.toml\"\n"
        "[[motion]]\npatches = [\"blade\"]\nrule = \"field\"\nfile = \"table.csv\"\n");
  ASSERT_EQ(gridmorph("surface passage.cgns -p blade -o target.stl").status, 0);
  write_case("target.toml", "[[motion]]\npatches = [\"blade\"]\nrule = \"target\"\nfile = \"target.stl\"\n");
  ASSERT_EQ(shell("mkdir sub && ln passage.cgns hard.cgns && ln -s passage.cgns soft.cgns").status, 0);
  for (std::string const option : {"-o ", "-r "}) {
    std::string const run = "morph case.toml " + option;
    expect_refused(run + "case.toml", {"case file", "never overwritten"});
    expect_refused(run + "table.csv", {"table.csv", "never overwritten"});
    expect_refused(run + "side.toml", {"side file", "never overwritten"});
    for (std::string const spelling :
         {"passage.cgns", "hard.cgns", "soft.cgns", "./passage.cgns", "sub/../passage.cgns"})
      expect_refused(run + spelling, {spelling, "input mesh", "never overwritten"});
    expect_refused("morph target.toml " + option + "target.stl", {"target.stl", "never overwritten"});
  }
  expect_refused("surface passage.cgns -p blade -o sub/../passage.cgns", {"input mesh"});
  expect_refused("inspect passage.cgns --suggest soft.cgns", {"input mesh"});
  expect_refused("inspect passage.cgns --side-file side.toml --suggest side.toml", {"side file"});
  write_case("wheel.toml", "[wheel]\noutput = \"wheel.toml\"\n" + still);
  expect_refused("wheel wheel.toml", {"case file"});
}

TEST_F(RunFiles, NoStepOfASequenceTakesThePlaceOfAnInput) {
  write("wave_2.csv", contents(path("rotation.csv")));
  write("case.toml",
        "[mesh]\ninput = \"passage.cgns\"\naxis = \"x\"\n[sequence]\nsteps = 3\noutput = \"wave_{step}.csv\"\n"
        "[[motion]]\npatches = [\"blade\"]\nrule = \"field\"\nmodes = [ { file = \"wave_2.csv\" } ]\n");
  expect_refused("morph case.toml", {"wave_2.csv", "never overwritten"});
  expect_refused("morph case.toml -o other_{step}.cgns -r ./other_3.cgns", {"other_3.cgns", "same file"});
}

TEST_F(RunFiles, NoStageTakesThePlaceOfTheMesh) {
  std::filesystem::create_directory(path("stages"));
  write("stages/wrap.cgns",
        "NDIME= 2\nNELEM= 1\n9 0 1 2 3\nNPOIN= 4\n0 0\n1 0\n1 1\n0 1\nNMARK= 1\nMARKER_TAG= wall\nMARKER_ELEMS= 4\n"
        "3 0 1\n3 1 2\n3 2 3\n3 3 0\n");
  write("case.toml",
        "[mesh]\ninput = \"stages/wrap.cgns\"\noutput = \"out.su2\"\n[output]\nstages = \"stages\"\n" + still);
  expect_refused("morph case.toml", {"stages/wrap.cgns", "never overwritten"});
}

TEST_F(RunFiles, NoStageOfBlocksTakesThePlaceOfAnyOtherFile) {
  std::filesystem::create_directory(path("stages"));
  std::filesystem::copy(path("passage.cgns"), path("stages/stage_00_boundary.cgns"));
  std::string const output = "[output]\nstages = \"stages\"\n" + still;
  write("case.toml",
        "[mesh]\ninput = \"stages/stage_00_boundary.cgns\"\noutput = \"out.cgns\"\naxis = \"x\"\n" + output);
  expect_refused("morph case.toml", {"stages/stage_00_boundary.cgns", "never overwritten"});
  write_case("other.toml", output);
  expect_refused("morph other.toml -o stages/stage_00_boundary.cgns", {"same file"});
  expect_refused("morph other.toml -o stages/stage_03_iteration_2.cgns", {"same file"});
  expect_refused("morph other.toml -r stages/stages.json", {"same file"});
  expect_refused("plan other.toml --graph passage.svg/no.svg", {"no.svg"});
  ASSERT_EQ(shell("ln passage.cgns mesh.svg").status, 0);
  expect_refused("plan other.toml --graph mesh.svg", {"input mesh", "never overwritten"});
}

TEST_F(RunFiles, TwoOutputsAreTwoFiles) {
  write_case("case.toml", still);
  ASSERT_EQ(shell("mkdir sub && ln -s sub also && touch one.cgns && ln -s one.cgns two.json").status, 0);
  expect_refused("morph case.toml -o new.cgns -r ./new.cgns", {"same file"});
  expect_refused("morph case.toml -o sub/new.cgns -r also/new.cgns", {"same file"});
  expect_refused("morph case.toml -o one.cgns -r two.json", {"same file"});
}

TEST_F(RunFiles, OutputsAreOrdinaryFiles) {
  write_case("case.toml", still);
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  ASSERT_EQ(shell("ln -s pipe link").status, 0);
  expect_refused("morph case.toml -o pipe", {"no ordinary file"});
  expect_refused("morph case.toml -r link", {"no ordinary file"});
  expect_refused("surface passage.cgns -p blade -o pipe", {"no ordinary file"});
  expect_refused("inspect passage.cgns --suggest link", {"no ordinary file"});
  EXPECT_TRUE(std::filesystem::is_fifo(path("pipe")));
}

TEST_F(RunFiles, InputsThatArePipesAreRefusedAtOnce) {
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  ASSERT_EQ(shell("ln -s pipe pipe.toml && ln -s pipe pipe.stl").status, 0);
  auto const refused = [&](std::string const& arguments) {
    Outcome const run = shell("timeout 20 $G " + arguments);
    EXPECT_EQ(run.status, 2) << arguments << "\n" << run.err;
    EXPECT_NE(run.err.find("ordinary file"), std::string::npos) << run.err;
  };
  refused("morph pipe");
  refused("inspect pipe");
  refused("quality passage.cgns pipe");
  refused("inspect passage.cgns --side-file pipe.toml");
  for (std::string const rule :
       {"rule = \"field\"\nfile = \"pipe\"\n", "rule = \"target\"\nfile = \"pipe\"\n",
        "rule = \"target\"\nfile = \"pipe.stl\"\n", "rule = \"field\"\nfile = \"rotation.csv\"\nelements = \"pipe\"\n",
        "rule = \"sections\"\nfile = \"pipe\"\n"}) {
    write_case("case.toml", "[[motion]]\npatches = [\"blade\"]\n" + rule);
    refused("morph case.toml");
  }
}

TEST_F(RunFiles, TablesAndCaseFilesWithoutEndAreRefusedAtOnce) {
  std::string keys = "[mesh]\ninput = \"passage.cgns\"\n", columns = "x";
  for (int k = 0; k < 30'000; ++k) keys += "key_" + std::to_string(k) + " = 1\n";
  for (int c = 0; c < 1'000'000; ++c) columns += ",c" + std::to_string(c);
  write("case.toml", keys);
  Outcome const run = shell("timeout 20 $G plan case.toml");
  EXPECT_EQ(run.status, 2) << run.err;
  EXPECT_NE(run.err.find("29980 more unknown keys"), std::string::npos) << run.err;
  write("wide.csv", columns + "\n");
  for (std::string const rule : {"field", "sections"}) {
    write_case("case.toml", "[[motion]]\npatches = [\"blade\"]\nrule = \"" + rule + "\"\nfile = \"wide.csv\"\n");
    Outcome const wide = shell("timeout 20 $G plan case.toml");
    EXPECT_EQ(wide.status, 2) << wide.err;
    EXPECT_NE(wide.err.find("more than 1000 columns"), std::string::npos) << wide.err;
  }
}

TEST_F(RunFiles, AFileThatIsReplacedKeepsItsPermissions) {
  write_case("case.toml", still);
  write("out.cgns", "old");
  write("report.json", "old");
  ASSERT_EQ(chmod(path("out.cgns").c_str(), 0640), 0);
  ASSERT_EQ(chmod(path("report.json").c_str(), 0604), 0);
  ASSERT_EQ(gridmorph("morph case.toml -r report.json").status, 0);
  EXPECT_EQ(int(std::filesystem::status(path("out.cgns")).permissions()), 0640);
  EXPECT_EQ(int(std::filesystem::status(path("report.json")).permissions()), 0604);
}

TEST_F(RunFiles, NamesMayBeAsLongAsTheFileSystemAllows) {
  write_case("case.toml", still);
  std::string const name = std::string(250, 'n') + ".cgns";
  EXPECT_EQ(gridmorph("morph case.toml -o " + name + " -r " + std::string(250, 'r') + ".json").status, 0);
  EXPECT_GT(std::filesystem::file_size(path(name)), 0u);
  EXPECT_TRUE(left_behind().empty());
}

/// Starts a sequence, waits for its first temporary file, sends a signal.
std::string stopped_by(std::string const& signal) {
  return "rm -f .gridmorph*; $G morph case.toml & p=$!; while kill -0 $p 2>/dev/null; do ls .gridmorph* >/dev/null "
         "2>&1 && break;"
         " sleep 0.01; done; kill -" +
         signal + " $p; wait $p";
}

TEST_F(RunFiles, ARunThatIsEndedLeavesNothingBehindAndTheNextOneClearsAwayWhatAKilledOneLeft) {
  write("case.toml",
        "[mesh]\ninput = \"passage.cgns\"\naxis = \"x\"\n[sequence]\nsteps = 5000\noutput = \"series.cgns\"\n"
        "[[motion]]\npatches = [\"blade\"]\nrule = \"field\"\nmodes = [ { file = \"rotation.csv\", amplitude = 0.001 } "
        "]\n"
        "[[motion]]\npatches = [\"inlet\", \"outlet\", \"hub\", \"case\", \"type:periodic\"]\nrule = \"free\"\n");
  for (std::string const signal : {"TERM", "HUP"}) {
    Outcome const run = shell(stopped_by(signal));
    EXPECT_EQ(run.status, signal == "TERM" ? 143 : 129) << run.err;
    EXPECT_TRUE(left_behind().empty()) << left_behind().front();
  }
  EXPECT_EQ(shell(stopped_by("KILL")).status, 137);
  EXPECT_EQ(left_behind().size(), 1u);
  std::string text = contents(path("case.toml"));
  write("case.toml", text.replace(text.find("5000"), 4, "2"));
  Outcome const again = gridmorph("morph case.toml");
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_TRUE(left_behind().empty());
}

TEST_F(RunFiles, HelpThatCannotBePrintedIsAFailureOfTheMachine) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  EXPECT_EQ(shell("$G --help >/dev/full").status, 3);
  EXPECT_EQ(shell("$G --version >/dev/full").status, 3);
  EXPECT_EQ(shell("$G morph --help >/dev/full").status, 3);
}

}  // namespace
}  // namespace gridmorph::test
