// What other programs meet: JSON on standard output, quiet runs, versions, help, completion, the manual page, threads.
#include "run_command.hpp"
#include "support/reduced.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <regex>
#include <set>

namespace gridmorph::test {
namespace {

std::vector<std::string> const commands{"morph",  "inspect",   "plan",    "certify", "quality", "wheel", "fillet",
                                        "blocks", "hexahedra", "surface", "view",    "keys",    "demo"};

class CommandInterface : public CommandTest {
 protected:
  /// Cases for every command: a motion of the blade, once for the passage alone and once for a wheel.
  void SetUp() override {
    CommandTest::SetUp();
    std::string const rules =
        "[[motion]]\npatches = [\"blade\"]\nrule = \"rigid\"\nrotation = { angle_deg = 0.2, axis = [1, 0, 0], origin = "
        "[0, 0, 0] }\n"
        "[[motion]]\npatches = [\"hub\", \"case\"]\nrule = \"slip\"\nsurface = \"revolution\"\n"
        "[[motion]]\npatches = [\"inlet\", \"outlet\"]\nrule = \"circumferential-slide\"\nof = \"blade\"\n"
        "[[motion]]\npatches = [\"type:periodic\"]\nrule = \"follow\"\nof = \"blade\"\n";
    write_case("case.toml", rules);
    write_case("wheel.toml", rules + "[wheel]\noutput = \"out_wheel.cgns\"\npassages = 2\n");
    std::string const su2 = GRIDMORPH_SOURCE "/examples/meshes/mesh_vki_turbine.su2";
    write("flat.toml", "[mesh]\ninput = \"" + su2 +
                           "\"\noutput = \"out.su2\"\n[[motion]]\npatches = [\"airfoil\"]\nrule = \"rigid\"\n"
                           "translation = [0.0001, 0, 0]\n");
  }

  /// Arguments of a run of every command, and a key that its document has.
  static std::vector<std::pair<std::string, std::string>> runs() {
    return {{"morph case.toml", "times"},
            {"morph flat.toml", "plan"},
            {"morph case.toml --dry-run", "stages"},
            {"plan case.toml", "stages"},
            {"plan flat.toml", "plan"},
            {"inspect passage.cgns", "zones"},
            {"quality passage.cgns", "baseline"},
            {"wheel wheel.toml", "passages"},
            {"fillet passage.cgns -b blade -w hub --radius 0.002 -o filled.cgns", "stations"},
            {"hexahedra passage.cgns -o elements.cgns", "hexahedra"},
            {"blocks elements.cgns -o found.cgns", "blocks"},
            {"surface passage.cgns -p blade -o out.stl", "facets"},
            {"keys guard", "keys"},
            {"demo passage -n 10000 -m chord -d made", "morphs"}};
  }

  /// Options of the program or of a command, as its help lists them: "-o", "--output", ...
  [[nodiscard]] std::set<std::string> options_of(std::string const& command) const {
    std::string const help = gridmorph(command + " --help").out;
    std::set<std::string> out;
    std::regex const line("(^|\n)  (-[^ {\n]*)");  // "--no-x{false}"
    for (std::sregex_iterator at(help.begin(), help.end(), line), end; at != end; ++at) {
      std::istringstream list((*at)[2]);
      for (std::string option; std::getline(list, option, ',');) out.insert(option);
    }
    return out;
  }
};

TEST_F(CommandInterface, EveryCommandPrintsItsResultAsJsonAndNothingElse) {
  for (auto const& [arguments, key] : runs()) {
    Outcome const run = gridmorph(arguments + " --json");
    EXPECT_EQ(run.status, 0) << arguments << "\n" << run.err;
    auto const json = nlohmann::json::parse(run.out, nullptr, false);
    ASSERT_FALSE(json.is_discarded()) << arguments << "\n" << run.out;
    EXPECT_TRUE(json.contains(key)) << arguments << "\n" << run.out.substr(0, 400);
  }
  auto const demo = nlohmann::json::parse(gridmorph("--json demo passage -n 10000 -d twice").out);
  EXPECT_EQ(demo["morphs"].size(), 2U);
  EXPECT_EQ(demo["morphs"][0]["output"], "twice/passage_rotation.cgns");
}

TEST_F(CommandInterface, TheJsonOfAMorphIsItsReport) {
  Outcome const run = gridmorph("morph case.toml --json --report report.json");
  ASSERT_EQ(run.status, 0) << run.err;
  auto printed = nlohmann::json::parse(run.out), written = nlohmann::json::parse(contents(path("report.json")));
  EXPECT_EQ(printed, written);
}

TEST_F(CommandInterface, PlansPredictWhatMotionsMakeOfCells) {
  expect_bad_input(gridmorph("plan flat.toml --optimise"), {"unstructured", "--optimise"});
  auto const json = nlohmann::json::parse(gridmorph("--json plan case.toml").out);
  auto const& prediction = json["prediction"];
  EXPECT_GT(prediction["cells"], 100);
  EXPECT_EQ(prediction["inverted"], 0);
  auto const report = nlohmann::json::parse(gridmorph("--json morph case.toml").out)["morphed"];
  double const smallest = report["far_field"]["measures"]["determinant_3x3x3"]["min"];
  EXPECT_GE(prediction["determinant_3x3x3"]["value"], smallest - 1e-9);
  EXPECT_LE(prediction["scaled_jacobian"]["value"], prediction["chains"][1]["scaled_jacobian"]["value"]);

  EXPECT_NE(gridmorph("plan case.toml --optimise").out.find("by priority"), std::string::npos);
  std::string const gentle = contents(path("case.toml")), by = "angle_deg = 0.2";
  write("case.toml", std::string(gentle).replace(gentle.find(by), by.size(), "angle_deg = 25"));
  Outcome const run = gridmorph("plan case.toml");
  EXPECT_EQ(run.status, 0);
  EXPECT_NE(run.err.find("warning: predicted: "), std::string::npos) << run.err << run.out;
  EXPECT_NE(run.out.find("\npredicted from "), std::string::npos) << run.out;
}

TEST_F(CommandInterface, QuietRunsPrintOnlyWhatWasAskedFor) {
  if (test::reduced()) GTEST_SKIP() << "the same runs as with --json";
  for (auto const& [arguments, key] : runs()) {
    Outcome const run = gridmorph("-q " + arguments);
    EXPECT_EQ(run.status, 0) << arguments << "\n" << run.err;
    for (auto const& line : run.error_lines())
      EXPECT_EQ(line.rfind("gridmorph: warning: ", 0), 0U) << arguments << "\n" << line;
    bool const asked = arguments.find("inspect") == 0 || arguments.find("plan") == 0 ||
                       arguments.find("quality") == 0 || arguments.find("keys") == 0 ||
                       arguments.find("--dry-run") != std::string::npos;
    EXPECT_EQ(run.out.empty(), !asked) << arguments << "\n" << run.out;
  }
}

TEST_F(CommandInterface, ErrorsLeaveStandardOutputEmptyWithJsonToo) {
  expect_bad_input(gridmorph("--json morph nowhere.toml"), {"nowhere.toml"});
  expect_bad_input(gridmorph("--json inspect passage.cgns --suggest"), {"--suggest", "--json"});
}

TEST_F(CommandInterface, TheVersionSaysWhatTheProgramIsMadeOf) {
  std::string const out = gridmorph("--version").out;
  EXPECT_TRUE(std::regex_search(out, std::regex("^gridmorph [0-9.]+( \\(commit [0-9a-f]+(-dirty)?\\))?\n"))) << out;
  EXPECT_TRUE(std::regex_search(out, std::regex("\nKokkos [0-9]+\\.[0-9]+\\.[0-9]+, backend [A-Za-z]+"))) << out;
  EXPECT_TRUE(std::regex_search(out, std::regex("\nCGNS [0-9]+\\.[0-9]+\\.[0-9]+\n"))) << out;
}

TEST_F(CommandInterface, HelpBeginsWithExamplesAndEndsWithTheDocs) {
  for (auto const& command : commands) {
    Outcome const help = gridmorph(command + " --help");
    EXPECT_EQ(help.status, 0);
    EXPECT_EQ(help.out.rfind("Examples:\n  gridmorph " + command + " ", 0), 0U) << help.out;
    EXPECT_NE(help.out.find("Exit status"), std::string::npos) << command;
    auto const at = help.out.rfind("Docs: ");
    ASSERT_NE(at, std::string::npos) << command;
    // Every page is where the help says it is.
    std::string const docs = help.out.substr(at);
    std::smatch folder;
    ASSERT_TRUE(std::regex_search(docs, folder, std::regex("in (/[^;]*);"))) << docs;
    std::regex const page("[a-z_]+\\.md");
    for (std::sregex_iterator p(docs.begin(), docs.end(), page), end; p != end; ++p)
      EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(folder[1].str()) / p->str())) << p->str();
  }
  for (std::string const command : {"inspect", "quality"})
    EXPECT_NE(gridmorph(command + " --help").out.find("SU2"), std::string::npos) << command;
}

TEST_F(CommandInterface, TheManualPageHasEveryCommandAndOption) {
  std::string const page = contents(GRIDMORPH_SOURCE "/docs/gridmorph.1");
  ASSERT_FALSE(page.empty());
  std::string plain;  // "\-\-json" -> "--json"
  for (std::size_t n = 0; n < page.size(); ++n)
    if (page[n] != '\\' || n + 1 == page.size() || page[n + 1] != '-') plain += page[n];
  for (auto const& command : commands) {
    auto const begin = plain.find("\n.SS gridmorph " + command + "\n");
    ASSERT_NE(begin, std::string::npos) << "docs/gridmorph.1 has no section .SS gridmorph " << command;
    std::string const section = plain.substr(begin, plain.find("\n.S", begin + 5) - begin) +
                                plain.substr(plain.find("\n.SH OPTIONS"), plain.find("\n.SH COMMANDS"));
    for (auto const& option : options_of(command)) {
      std::regex const whole("(^|[^-a-z])" + option + "($|[^-a-z])");
      EXPECT_TRUE(std::regex_search(section, whole)) << option << " of " << command << " is not in docs/gridmorph.1";
    }
  }
}

TEST_F(CommandInterface, BashCompletesCommandsOptionsAndFiles) {
  auto const complete = [&](std::string const& words) {
    Outcome const run =
        shell("gridmorph() { :; }; PATH=$(dirname $G):$PATH bash -c '. " GRIDMORPH_SOURCE
              "/scripts/completion/gridmorph.bash; COMP_WORDS=(" +
              words + "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _gridmorph; printf \"%s\\n\" \"${COMPREPLY[@]}\"'");
    EXPECT_EQ(run.err, "") << words;
    std::istringstream in(run.out);
    std::set<std::string> out;
    for (std::string line; std::getline(in, line);)
      if (!line.empty()) out.insert(line);
    return out;
  };
  EXPECT_EQ(complete("gridmorph \"\""), std::set<std::string>(commands.begin(), commands.end()));
  EXPECT_EQ(complete("gridmorph -q in"), std::set<std::string>{"inspect"});
  for (auto const& command : commands)
    EXPECT_EQ(complete("gridmorph " + command + " -"), options_of(command)) << command;
  EXPECT_EQ(complete("gridmorph morph ca"), std::set<std::string>{"case.toml"});
  EXPECT_EQ(complete("gridmorph inspect passage.cg"), std::set<std::string>{"passage.cgns"});
  EXPECT_EQ(complete("gridmorph demo b"), std::set<std::string>{"ball"});
  EXPECT_EQ(complete("gridmorph demo passage --motion r"), std::set<std::string>{"rotation"});
}

TEST_F(CommandInterface, ThreadsWaitPassivelyUnlessTheUserSaysHow) {
  std::string const bare = "env -u OMP_WAIT_POLICY -u GOMP_SPINCOUNT -u KMP_BLOCKTIME OMP_DISPLAY_ENV=true ";
  auto const starts = [](Outcome const& run) {
    std::size_t n = 0;
    for (std::size_t at = run.err.find("DISPLAY ENVIRONMENT BEGIN"); at != std::string::npos;
         at = run.err.find("DISPLAY ENVIRONMENT BEGIN", at + 1))
      ++n;
    return n;
  };
  Outcome const run = shell(bare + "$G quality passage.cgns");
  EXPECT_EQ(run.status, 0);
  if (starts(run) == 0) GTEST_SKIP() << "an OpenMP that does not say its settings, or none";
  EXPECT_EQ(starts(run), 2U);
  EXPECT_TRUE(std::regex_search(run.err, std::regex("WAIT_POLICY *= *'PASSIVE'"))) << run.err;
  for (std::string const own : {"OMP_WAIT_POLICY=active ", "GOMP_SPINCOUNT=1000 ", "KMP_BLOCKTIME=1 "})
    EXPECT_EQ(starts(shell(bare + own + "$G quality passage.cgns")), 1U) << own;
  // Arguments and exit status come through; what does not compute does not start anew.
  std::filesystem::copy(path("passage.cgns"), path("a mesh.cgns"));
  EXPECT_EQ(shell(bare + "$G quality 'a mesh.cgns'").status, 0);
  EXPECT_EQ(shell(bare + "$G quality 'no mesh.cgns'").status, 2);
  EXPECT_EQ(starts(shell(bare + "$G --help")), 1U);
}

TEST_F(CommandInterface, KeysWithoutAnEffectOnTheMeshAreErrorsBeforeAnyWork) {
  std::string const flat = contents(path("flat.toml")), round = contents(path("case.toml"));
  write("flat.toml", flat + "[volume]\nlaw = \"c1\"\n[output]\nquality = true\n");
  for (std::string const command : {"morph", "plan", "morph --dry-run"})
    expect_bad_input(gridmorph(command + " flat.toml"),
                     {"flat.toml:8: [volume]", "unstructured", "flat.toml:11: [output] quality", "SU2"});
  write("case.toml", round + "[near_field]\noffset = 0.01\n[guard]\nsteps = 3\n");
  expect_bad_input(gridmorph("morph case.toml"), {"[near_field]", "[guard] steps", "structured"});
  write("wheel.toml", contents(path("wheel.toml")) + "[output]\nquality = true\n");
  expect_bad_input(gridmorph("wheel wheel.toml"), {"[output] quality", "wheels"});
}

}  // namespace
}  // namespace gridmorph::test
