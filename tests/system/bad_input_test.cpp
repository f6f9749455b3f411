// Bad input gets status 2 and one clear message, and leaves nothing behind.
#include "run_command.hpp"

namespace gridmorph::test {
namespace {

using BadInput = CommandTest;

TEST_F(BadInput, MissingFiles) {
  expect_bad_input(gridmorph("morph nowhere.toml"), {"nowhere.toml", "does not exist"});
  expect_bad_input(gridmorph("inspect nowhere.cgns"), {"nowhere.cgns"});
  expect_bad_input(gridmorph("quality nowhere.cgns"), {"nowhere.cgns"});
  expect_bad_input(gridmorph("plan ."), {"directory"});
  write("case.toml", "[mesh]\ninput = \"gone.cgns\"\noutput = \"out.cgns\"\n" + still);
  expect_bad_input(gridmorph("morph case.toml"), {"gone.cgns"});
}

TEST_F(BadInput, FilesThatAreNoMesh) {
  write("text.cgns", "this is not a mesh\n");
  write("empty.cgns", "");
  expect_bad_input(gridmorph("inspect text.cgns"), {"text.cgns", "not a CGNS file"});
  expect_bad_input(gridmorph("inspect empty.cgns"), {"empty.cgns"});
  expect_bad_input(gridmorph("morph passage.cgns"), {"passage.cgns", "not a text file"});
}

TEST_F(BadInput, MeshesOfOtherProgramsAreNamed) {
  std::string const cards = "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nENDDATA\n";
  for (auto const& [text, is] : std::vector<std::pair<std::string, char const*>>{
           {"# vtk DataFile Version 3.0\nmesh\nASCII\nDATASET UNSTRUCTURED_GRID\n", "a legacy VTK file (.vtk)"},
           {"$ made by a mesher\n\nSOL 101\nCEND\nBEGIN BULK\n" + cards, "a Nastran mesh"},
           {std::string(3000, '$') + "\n" + cards, "a Nastran mesh"},
           {"grid*   1\n*\n" + cards, "a Nastran mesh"},
           {"CTETRA  1       1       1       2       3       4\n" + cards, "a Nastran mesh"},
           {"    -1\n   164\n         1  SI\n    -1\n    -1\n  2411\n", "an I-deas mesh (UNV)"},
           {"** comment\n*Part, name=a\n*Node\n1, 0, 0, 0\n", "an Abaqus mesh"}}) {
    write("mesh.any", text);
    expect_bad_input(gridmorph("inspect mesh.any"), {"mesh.any: is ", is});
  }
  // Words and numbers of other files are none of these.
  write("mesh.any", "grids of words\n");
  expect_bad_input(gridmorph("inspect mesh.any"), {"not a CGNS file"});
}

TEST_F(BadInput, TruncatedMesh) {
  std::string const whole = contents(path("passage.cgns"));
  for (double const share : {0.02, 0.3, 0.9}) {
    write("cut.cgns", whole.substr(0, std::size_t(share * double(whole.size()))));
    expect_bad_input(gridmorph("inspect cut.cgns"), {"cut.cgns"});
  }
}

TEST_F(BadInput, UnknownKeysWithLineAndNearestKey) {
  write_case("case.toml", still + "[volum]\nlaw = \"linear\"\n");
  expect_bad_input(gridmorph("morph case.toml"), {"case.toml:8: ", "'volum'", "'volume'"});
}

TEST_F(BadInput, EveryProblemOfACaseFileAtOnce) {
  write_case("case.toml", "[[motion]]\npatches = [\"blade\"]\nrule = \"rigit\"\n[volume]\nlaw = 3\n");
  Outcome const run = gridmorph("morph case.toml");
  expect_bad_input(run, {"case.toml:7: ", "case.toml:9: "});
  EXPECT_EQ(run.error_lines().size(), 2u);
}

TEST_F(BadInput, PatchesThatAreNotThere) {
  write_case("case.toml", "[[motion]]\npatches = [\"balde\"]\nrule = \"fixed\"\n");
  expect_bad_input(gridmorph("morph case.toml"), {"case.toml:5", "balde", "blade", "hub"});
}

TEST_F(BadInput, PatchWithoutARuleInAStrictCaseFile) {
  write_case("case.toml", "[[motion]]\npatches = [\"blade\"]\nrule = \"fixed\"\n", "default = \"error\"\n");
  expect_bad_input(gridmorph("morph case.toml"), {"hub"});
}

TEST_F(BadInput, TwoRulesForOnePatch) {
  write_case("case.toml",
             "[[motion]]\npatches = [\"blade\"]\nrule = \"fixed\"\n[[motion]]\npatches = [\"bl*\"]\nrule = \"free\"\n");
  expect_bad_input(gridmorph("morph case.toml"), {"case.toml:5", "case.toml:8", "blade"});
}

TEST_F(BadInput, RulesThatDisagreeWherePatchesMeet) {
  write_case("case.toml",
             "[[motion]]\npatches = [\"inlet\"]\nrule = \"rigid\"\ntranslation = [-0.01, 0, 0]\n"
             "[[motion]]\npatches = [\"hub\", \"case\"]\nrule = \"fixed\"\n");
  expect_bad_input(gridmorph("morph case.toml"), {"inlet", "hub"});
}

TEST_F(BadInput, DisplacementFilesThatCannotBeUsed) {
  std::string const field = "[[motion]]\npatches = [\"blade\"]\nrule = \"field\"\nfile = \"d.csv\"\n";
  write_case("case.toml", field);
  expect_bad_input(gridmorph("morph case.toml"), {"case.toml:8: ", "d.csv", "does not exist"});
  write("d.csv", "x,y,z,dx,dy,dz\n0,0,0,0,nan,0\n");
  expect_bad_input(gridmorph("morph case.toml"), {"d.csv:2", "nan", "not finite"});
  write("d.csv", "0,0,0,0,0,0\n0,0,0,0,1,0\n");
  expect_bad_input(gridmorph("morph case.toml"), {"d.csv:2", "line 1"});
}

TEST_F(BadInput, FormulasThatAreNotFiniteOnTheSurface) {
  write_case("case.toml", "[[motion]]\npatches = [\"blade\"]\nrule = \"formula\"\ndx = \"sqrt(-1 - x*x)\"\n");
  expect_bad_input(gridmorph("morph case.toml"), {"case.toml:8: ", "nan", "x = "});
}

TEST_F(BadInput, OutputsThatCannotBe) {
  write_case("case.toml", still);
  expect_bad_input(gridmorph("morph case.toml -o passage.cgns"), {"is the input"});
  expect_bad_input(gridmorph("morph case.toml -o no/such/folder/m.cgns"), {"no/such/folder", "does not exist"});
  expect_bad_input(gridmorph("morph case.toml -o ."), {"folder"});
  expect_bad_input(gridmorph("morph case.toml -r no/such/folder/r.json"), {"report", "does not exist"});
  expect_bad_input(gridmorph("morph case.toml -o out.cgns -r out.cgns"), {"same file"});
  write("none.toml", "[mesh]\ninput = \"passage.cgns\"\n" + still);
  expect_bad_input(gridmorph("morph none.toml"), {"no output", "--output"});
}

}  // namespace
}  // namespace gridmorph::test
