// Keys that are right in themselves and mean nothing for the mesh, or the command, at hand.
#include "case_text.hpp"

#include <gridmorph/case/ignored_keys.hpp>

namespace gridmorph::test {
namespace {

using Run = CaseUse::Run;
using Format = CaseUse::Format;

struct Example {
  std::string tables;
  std::vector<std::string> words;
};

std::string const region = "[[region]]\nname = \"wake\"\nzones = \"a\"\n";
std::vector<Example> const of_unstructured{{"[volume]\nlaw = \"c1\"\n", {"[volume]", "unstructured", "[background]"}}};
std::vector<Example> const of_structured{
    {"[near_field]\noffset = 0.1\n", {"[near_field]", "'m' is structured", "[boundary_layer]"}},
    {"[background]\ncells = 4\n", {"[background]", "[volume]"}},
    {"[guard]\nsteps = 4\n", {"[guard] steps"}}};

/// The example begins on line 7 where `mesh`, more keys of [mesh], is empty.
std::vector<std::string> check(Example const& example, CaseUse const& use, std::string const& mesh = "") {
  CaseFile const c = parse_case_file(
      "[[motion]]\npatches = [\"*\"]\nrule = \"fixed\"\n[mesh]\ninput = \"m\"\naxis = \"x\"\n" + mesh + example.tables,
      "case.toml");
  return error_lines([&] { refuse_ignored_keys(c, use); });
}

TEST(IgnoredKeys, OfTheOtherKindOfMeshAreErrorsWithTheirLine) {
  for (bool const unstructured : {false, true}) {
    for (Example const& example : unstructured ? of_unstructured : of_structured) {
      auto const lines = check(example, {.unstructured = unstructured});
      ASSERT_EQ(lines.size(), 1U) << example.tables;
      EXPECT_TRUE(reported(lines, "case.toml:", example.words)) << example.tables;
      EXPECT_TRUE(reported(lines, "case.toml:", {"has no effect", "; "}));
    }
    for (Example const& example : unstructured ? of_structured : of_unstructured)
      EXPECT_EQ(check(example, {.unstructured = unstructured}), std::vector<std::string>()) << example.tables;
  }
}

TEST(IgnoredKeys, AreAllListedInOnePassInTheOrderOfTheFile) {
  auto const lines = check({"[near_field]\noffset = 0.1\n[guard]\nmin_determinant = 0.1\nsteps = 3\n", {}}, {});
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0].rfind("case.toml:7: [near_field]", 0), 0U) << lines[0];
  EXPECT_EQ(lines[1].rfind("case.toml:11: [guard] steps", 0), 0U) << lines[1];
}

TEST(IgnoredKeys, OfTheMeshTableAreFoundToo) {
  for (std::string const key : {"open_faces = \"open\"\n", "matching_tolerance = 1e-6\n"}) {
    EXPECT_TRUE(reported(check({"", {}}, {.unstructured = true}, key), "case.toml:7: [mesh]", {"structured meshes"}))
        << key;
    EXPECT_EQ(check({"", {}}, {}, key).size(), 0U) << key;
  }
}

TEST(IgnoredKeys, OfOtherRunsAreErrors) {
  std::string const output = "output = \"one.cgns\"\n";
  EXPECT_TRUE(reported(check({"", {}}, {.run = Run::sequence}, output), "case.toml:7: [mesh] output", {"[sequence]"}));
  EXPECT_EQ(check({"", {}}, {.run = Run::morph}, output).size(), 0U);
  EXPECT_EQ(check({"", {}}, {.run = Run::wheel}, output).size(), 0U) << "one case file serves morph and wheel";
  Example const fields{"[output]\ndisplacement = true\nquality = false\n", {}};
  EXPECT_TRUE(reported(check(fields, {.run = Run::wheel}), "case.toml:8: [output] displacement", {"wheels"}));
  EXPECT_EQ(check(fields, {.run = Run::wheel}).size(), 1U) << "false says what is the case";
  Example const order{"[volume]\norder = \"prediction\"\n", {}};
  EXPECT_TRUE(reported(check(order, {.run = Run::wheel}), "case.toml:8: [volume] order", {"wheel"}));
  EXPECT_TRUE(reported(check({region, {}}, {.run = Run::wheel}), "case.toml:7: [region]", {"without regions"}));
  EXPECT_EQ(check(order, {.run = Run::morph}).size(), 0U);
  for (bool const unstructured : {false, true}) {
    Example const wheel{"[wheel]\noutput = \"w.cgns\"\n", {}};
    EXPECT_EQ(check(wheel, {.unstructured = unstructured, .run = Run::wheel}).size(), 0U);
    auto const lines = check({"[guard]\nsteps = 2\n", {}}, {.unstructured = unstructured, .run = Run::wheel});
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_TRUE(reported(lines, "case.toml:8: [guard]", {"no effect"}));
  }
  EXPECT_EQ(check({"[guard]\nfreeze = true\n", {}}, {.unstructured = true, .run = Run::wheel}).size(), 0U);
  EXPECT_EQ(check({"[guard]\nsmooth = true\nfreeze = true\n", {}}, {.run = Run::wheel}).size(), 0U);
  for (std::string const alone : {"freeze = true\n", "freeze = true\nretry = true\n"})
    EXPECT_TRUE(reported(check({"[guard]\n" + alone, {}}, {.run = Run::wheel}), "case.toml:8: [guard] freeze",
                         {"smooth = true"}));
  Example const stages{"[output]\nstages = \"s\"\n", {}};
  for (bool const unstructured : {false, true}) {
    for (auto const& [run, word] : {std::pair(Run::sequence, "sequence"), std::pair(Run::wheel, "wheel")}) {
      auto const lines = check(stages, {.unstructured = unstructured, .run = run});
      ASSERT_EQ(lines.size(), 1U) << word;
      EXPECT_TRUE(reported(lines, "case.toml:8: [output] stages", {word}));
    }
    EXPECT_EQ(check(stages, {.unstructured = unstructured}).size(), 0U);
  }
}

TEST(IgnoredKeys, OfOutputsInFormatsWithoutSolutionsAreErrors) {
  Example const fields{"[output]\ndisplacement = true\nquality = true\n", {}};
  for (auto const& [format, name] : {std::pair(Format::su2, "SU2"), std::pair(Format::plot3d, "PLOT3D")}) {
    auto const lines = check(fields, {.unstructured = format == Format::su2, .format = format});
    EXPECT_EQ(lines.size(), 2U);
    EXPECT_TRUE(reported(lines, "case.toml:9: [output] quality", {name, "CGNS"}));
  }
  EXPECT_EQ(check(fields, {.unstructured = true, .format = Format::vtk}).size(), 0U);
  Example const beside{"[output]\ndisplacement = true\nvtk = \"m.vtu\"\n", {}};
  EXPECT_EQ(check(beside, {.unstructured = true, .format = Format::su2}).size(), 0U);
  EXPECT_TRUE(reported(check(beside, {.unstructured = true, .run = Run::sequence}), "case.toml:9: [output] vtk",
                       {"one morph"}));
  EXPECT_EQ(check(fields, {}).size(), 0U);
}

TEST(IgnoredKeys, OfRulesAreErrorsWhileTheFileIsRead) {
  TemporaryFolder const folder;
  auto const file = [&](std::string const& name, std::string const& text) {
    std::ofstream(folder / name) << text;
    return "\"" + std::string(folder / name) + "\"";
  };
  std::string const points = file("d.csv", "0,0,0,0,0,1\n1,0,0,0,0,1\n0,1,0,0,0,1\n");
  std::string const sections = file("new.dat", "# span 0\n0 0 0\n1 0 0\n1 1 0\n\n# span 1\n0 0 1\n1 0 1\n1 1 1\n");
  std::string const head = "[mesh]\ninput = \"m\"\naxis = \"x\"\n[[motion]]\npatches = [\"blade\"]\n";
  EXPECT_TRUE(reported(problems_of(head + "rule = \"field\"\nfile = " + points + "\noffset = \"translate\"\n"),
                       "case.toml:8: ", {"offset", "elements"}));
  EXPECT_EQ(problems_of(head + "rule = \"field\"\nfile = " + points + "\n").size(), 0U);
  EXPECT_TRUE(reported(
      problems_of(head + "rule = \"target\"\nfile = " + sections + "\nmapping = \"sections\"\ncrease_angle_deg = 30\n"),
      "case.toml:9: ", {"crease_angle_deg", "projection"}));
}

}  // namespace
}  // namespace gridmorph::test
