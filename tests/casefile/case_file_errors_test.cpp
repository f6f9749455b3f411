// What a wrong case file is told: line, key, value, and what to do.
#include "case_text.hpp"

#include <utility>

namespace gridmorph::test {
namespace {

std::string const head = "[mesh]\ninput = \"in.cgns\"\n";
std::string const rule = "[[motion]]\npatches = \"a\"\nrule = \"fixed\"\n";

/// One wrong line 7 of a rule on 'blade'.
std::vector<std::string> rule_problems(std::string const& lines) { return problems_of(case_with_rule(lines)); }

TEST(CaseFileErrors, MissingFileFolderAndBinaryFile) {
  TemporaryFolder const folder;
  EXPECT_TRUE(reported(error_lines([&] { (void)read_case_file(folder.path("no.toml")); }), "case file",
                       {"no.toml", "does not exist"}));
  EXPECT_TRUE(reported(error_lines([&] { (void)read_case_file(folder.path("")); }), "case file", {"directory"}));
  auto const binary = folder.write("mesh.cgns", std::string("\x89HDF\r\n\x1a\n\0\0\0", 11));
  EXPECT_TRUE(reported(error_lines([&] { (void)read_case_file(binary); }), binary.string(), {"not a text file"}));
  auto const large = folder.write("large.toml", std::string(std::size_t(5) << 20, '#'));
  EXPECT_TRUE(reported(error_lines([&] { (void)read_case_file(large); }), "case file", {"large.toml", "bytes"}));
}

TEST(CaseFileErrors, SyntaxErrorsComeInOneLineWithTheirPlace) {
  for (auto const& [text, line] : std::vector<std::pair<std::string, int>>{{"[mesh]\ninput = \n", 2},
                                                                           {"[mesh]\ninput = \"a\ny = 1\n", 2},
                                                                           {"[mesh\n", 1},
                                                                           {"x = 1\nx = 2\n", 2},
                                                                           {"[mesh]\n\nx = 1 y = 2\n", 3},
                                                                           {"\xff\xfe\n", 1}}) {
    auto const lines = problems_of(text);
    EXPECT_EQ(lines.size(), 1u) << text;
    EXPECT_TRUE(reported(lines, "case.toml:" + std::to_string(line) + ": not valid TOML: ", {})) << text;
  }
}

TEST(CaseFileErrors, ABackgroundFromAFileHasItsOwnWrap) {
  std::string const near = "[near_field]\noffset = 0.1\n", file = "[background]\nfile = \"b.cgns\"\n";
  EXPECT_TRUE(reported(problems_of(head + rule + near + file), "case.toml:7: ", {"offset", "read from a file"}));
  EXPECT_TRUE(reported(problems_of(head + rule + file + "cells = 3\n"), "case.toml:8: ", {"cells", "remove it"}));
  EXPECT_TRUE(reported(problems_of(head + rule + "[background]\nouter = \"box\"\n"),
                       "case.toml:7: ", {"outer", "add file = "}));
  TemporaryFolder const folder;
  std::string const there = "[background]\nfile = \"" + folder.write("b.cgns", "").string() + "\"\n";
  EXPECT_TRUE(problems_of(head + rule + there + "wrap = [\"inner\"]\nouter = \"box\"\nlaw = \"c1\"\n").empty());
}

TEST(CaseFileErrors, ValuesThatCannotBeReadAreShown) {
  for (std::string const& value : std::vector<std::string>{"-.01", "5.", "+.5", "x.cgns"})
    for (std::string const& text :
         std::vector<std::string>{"a = [" + value + ", 0, 0]\n", "a = [0, 0, " + value + "]\n", "a = " + value + "\n"})
      EXPECT_TRUE(reported(problems_of("\n" + text), "case.toml:2: not valid TOML: ", {"found " + value})) << text;
  EXPECT_TRUE(reported(problems_of("a = [-.01, 0, 0]"), "case.toml:1: ", {"found -.01, write a digit on both sides"}));
}

TEST(CaseFileErrors, OfAnEmptyFileNameWhatIsMissing) {
  auto const lines = problems_of("");
  EXPECT_TRUE(reported(lines, "case.toml:1: key 'mesh' is missing", {"[mesh]"}));
  EXPECT_TRUE(reported(lines, "case.toml: no [[motion]] rule", {}));
}

TEST(CaseFileErrors, KeysOfPartsWithoutEndAreRefused) {
  std::string key = "a";
  for (int n = 0; n < 200'000; ++n) key += ".a";
  EXPECT_TRUE(reported(problems_of("\n" + key + " = 1"), "case.toml:2: not valid TOML", {"parts"}));
  EXPECT_TRUE(reported(problems_of("[" + key + "]"), "case.toml:1: not valid TOML", {"parts"}));
}

// Each of these took minutes where a line was looked for from the beginning of the text, or read anew for each value in
// it.
TEST(CaseFileErrors, LongTablesAndListsAreReadAtOnceAndKeepTheirLines) {
  std::string constants = "[constants]\n", list = "[[motion]]\nrule = \"fixed\"\npatches = [",
              inline_table = "[constants]\n[x]\ny = {";
  constexpr int many = 30'000;
  for (int n = 0; n < many; ++n) {
    constants += "c" + std::to_string(n) + " = 1\n";
    list += "\"p" + std::to_string(n) + "\",";
    inline_table += "k" + std::to_string(n) + "=1,";
  }
  EXPECT_TRUE(reported(problems_of(constants + "x = 1\n"), "case.toml:30002", {"cannot be the name of a constant"}));
  EXPECT_TRUE(reported(problems_of(list + "\"last\"]\nwrong = 1\n"), "case.toml:4", {"unknown key 'wrong'"}));
  EXPECT_TRUE(reported(problems_of(inline_table + "last=1}\n"), "case.toml:3", {"one in a line"}));
}

TEST(CaseFileErrors, WhatStandsInStringsOfSeveralLinesCountsAsText) {
  std::string const brackets(100, '['), dots(100, '.'), text(300, ',');
  EXPECT_TRUE(reported(problems_of("a = [\"\"\"\n" + brackets + dots + "\n" + text + "\n\"\"\", 1]\nb = 2\n"),
                       "case.toml:5", {"unknown key 'b'"}));
}

TEST(CaseFileErrors, BracketsNestedWithoutEndAreRefused) {
  EXPECT_TRUE(reported(problems_of("a = " + std::string(300'000, '[')), "case.toml:1: not valid TOML", {"nested"}));
  EXPECT_TRUE(reported(problems_of("\n\na = " + std::string(300'000, '{')), "case.toml:3: not valid TOML", {"nested"}));
}

TEST(CaseFileErrors, AllProblemsAreReportedInOnePass) {
  auto const lines = problems_of(
      "[mesh]\n"
      "inptu = \"in.cgns\"\n"
      "[[motion]]\n"
      "patches = []\n"
      "rule = \"rigit\"\n"
      "[[motion]]\n"
      "patches = [\"b\"]\n"
      "rule = \"formula\"\n"
      "dx = \"0.1*xx\"\n"
      "[volume]\n"
      "law = \"cubic\"\n"
      "[gaurd]\n");
  EXPECT_TRUE(reported(lines, "case.toml:1: ", {"[mesh]", "'input' is missing"}));
  EXPECT_TRUE(reported(lines, "case.toml:2: ", {"[mesh]", "unknown key 'inptu'", "did you mean 'input'?"}));
  EXPECT_TRUE(reported(lines, "case.toml:4: ", {"[[motion]] patches", "empty"}));
  EXPECT_TRUE(reported(lines, "case.toml:5: ", {"[[motion]] rule", "\"rigit\"", "did you mean 'rigid'?"}));
  EXPECT_TRUE(reported(lines, "case.toml:9: ", {"dx", "'xx' at character 5"}));
  EXPECT_TRUE(reported(lines, "case.toml:11: ", {"[volume] law", "\"cubic\"", "linear, c1, c2"}));
  EXPECT_TRUE(reported(lines, "case.toml:12: ", {"unknown key 'gaurd'", "did you mean 'guard'?"}));
  EXPECT_EQ(lines.size(), 7u);
}

TEST(CaseFileErrors, LawsThatAreNone) {
  auto const of_volume = [](std::string const& keys) { return problems_of(head + rule + "[volume]\n" + keys + "\n"); };
  EXPECT_TRUE(of_volume("law = \"formula\"\nw = \"t^2 * (3 - 2*t)\"").empty());
  EXPECT_TRUE(
      of_volume("laws = [ { between = [\"blade\", \"type:periodic\"], law = \"formula\", w = \"t^3\" } ]").empty());
  EXPECT_TRUE(reported(of_volume("law = \"formula\""), "case.toml:6: ", {"'w' is missing"}));
  EXPECT_TRUE(reported(of_volume("law = \"c1\"\nw = \"t\""), "case.toml:8: ", {"[volume] w", "formula"}));
  EXPECT_TRUE(
      reported(of_volume("law = \"formula\"\nw = \"t + 0.5\""), "case.toml:8: ", {"[volume] w", "0.5 at t = 0"}));
  EXPECT_TRUE(reported(of_volume("law = \"formula\"\nw = \"t * x\""), "case.toml:8: ", {"uses x", "alone"}));
  EXPECT_TRUE(reported(of_volume("law = \"formula\"\nw = \"t * step\""), "case.toml:8: ", {"uses step", "alone"}));
  EXPECT_TRUE(reported(of_volume("law = \"formula\"\nw = \"t^\""), "case.toml:8: ", {"formula w"}));
  EXPECT_TRUE(reported(of_volume("law = \"formula\"\nw = \"t > 0.5 && t < 0.6 ? sqrt(-1) : t\""),
                       "case.toml:8: ", {"not finite at t = 0.5"}));
  EXPECT_TRUE(reported(of_volume("laws = [ { between = [\"wall\", \"inflow\", \"wall\"], law = \"c1\" } ]"),
                       "case.toml:7: ", {"between", "two ends", "found 3"}));
  EXPECT_TRUE(reported(
      problems_of(head + rule + "[[volume.laws]]\nbetween = [\"wall\", \"wall\"]\nlaw = \"formula\"\nw = \"1 - t\"\n"),
      "case.toml:9: ", {"w", "is 1 at t = 0"}));
  EXPECT_TRUE(reported(problems_of(head + rule + "[background]\nlaw = \"formula\"\nw = \"2 * t\"\n"),
                       "case.toml:8: ", {"[background] w", "2 at t = 1"}));
}

TEST(CaseFileErrors, AnEmptyFileIsToldWhatItNeeds) {
  auto const lines = problems_of("");
  EXPECT_TRUE(reported(lines, "case.toml", {"'mesh' is missing", "input = "}));
  EXPECT_TRUE(reported(lines, "case.toml", {"no [[motion]]"}));
}

TEST(CaseFileErrors, ValuesOfTheWrongTypeAreNamed) {
  EXPECT_TRUE(reported(problems_of("[mesh]\ninput = 3\n" + rule),
                       "case.toml:2: ", {"[mesh] input", "a string", "the number 3"}));
  EXPECT_TRUE(reported(problems_of("mesh = 3\n" + rule), "case.toml:1: ", {"mesh", "a table", "the number 3"}));
  EXPECT_TRUE(reported(problems_of(head + rule + "[output]\nquality = \"yes\"\n"),
                       "case.toml:7: ", {"[output] quality", "true or false", "the string \"yes\""}));
  EXPECT_TRUE(reported(problems_of(head + "[motion]\npatches = 1979-05-27\nrule = \"fixed\"\n"),
                       "case.toml:4: ", {"patches", "a date or time"}));
  EXPECT_TRUE(reported(problems_of(head + "motion = 1\n"), "case.toml:3: ", {"unknown key 'motion'"}));
  EXPECT_TRUE(
      reported(problems_of("motion = 1\n" + head), "case.toml:1: ", {"motion", "array of tables", "the number 1"}));
  EXPECT_TRUE(
      reported(rule_problems("rule = \"rigid\"\ntranslation = [1, 2]"), "case.toml:8: ", {"three numbers", "found 2"}));
  EXPECT_TRUE(
      reported(rule_problems("rule = \"rigid\"\ntranslation = [1, 2, \"3\"]"), "case.toml:8: ", {"a number", "\"3\""}));
  EXPECT_TRUE(
      reported(rule_problems("rule = \"rigid\"\ntranslation = [1, 2, nan]"), "case.toml:8: ", {"finite", "nan"}));
  EXPECT_TRUE(
      reported(rule_problems("rule = \"fixed\"\nrank = 1.5"), "case.toml:8: ", {"rank", "whole number", "1.5"}));
  EXPECT_TRUE(reported(rule_problems("rule = \"fixed\"\nrank = 9999999999"), "case.toml:8: ", {"too large"}));
}

TEST(CaseFileErrors, MeshSettings) {
  EXPECT_TRUE(
      reported(problems_of(head + "output = \"./in.cgns\"\n" + rule), "case.toml:3: ", {"output", "is the input"}));
  EXPECT_TRUE(
      reported(problems_of(head + "matching_tolerance = -1\n" + rule), "case.toml:3: ", {"matching_tolerance", "-1"}));
  EXPECT_TRUE(reported(problems_of(head + "axis = \"u\"\n" + rule), "case.toml:3: ", {"axis", "\"u\"", "x, y, z"}));
  EXPECT_TRUE(
      reported(problems_of(head + "axis = 1\n" + rule), "case.toml:3: ", {"axis", "direction", "the number 1"}));
  EXPECT_TRUE(reported(problems_of(head + "axis = { origin = [0, 0, 0] }\n" + rule),
                       "case.toml:3: ", {"'direction' is missing"}));
  EXPECT_TRUE(
      reported(problems_of(head + "axis = { direction = [0, 0, 0] }\n" + rule), "case.toml:3: ", {"no length"}));
  EXPECT_TRUE(reported(problems_of(head + "axis = { direction = [1, 0, 0], orign = [0, 0, 0] }\n" + rule),
                       "case.toml:3: ", {"[mesh] axis", "'orign'", "'origin'"}));
  EXPECT_TRUE(reported(problems_of("default = \"eror\"\n" + head + rule), "case.toml:1: ", {"default", "'error'"}));
}

TEST(CaseFileErrors, MisspeltNearFieldModes) {
  EXPECT_TRUE(reported(problems_of(head + rule + "[boundary_layer]\nmode = \"rotated\"\n"),
                       "case.toml:7: ", {"mode", "'rotate'"}));
}

TEST(CaseFileErrors, RulesWithoutTheirKeys) {
  EXPECT_TRUE(reported(problems_of(head + "[[motion]]\nrule = \"fixed\"\n"),
                       "case.toml:3: ", {"'patches' is missing", "type:wall"}));
  EXPECT_TRUE(reported(problems_of(head + "[[motion]]\npatches = \"a\"\n"), "case.toml:3: ", {"'rule' is missing"}));
  EXPECT_TRUE(reported(rule_problems("rule = \"rigid\""), "case.toml:7: ", {"translation", "rotation", "scale"}));
  EXPECT_TRUE(reported(rule_problems("rule = \"formula\""), "case.toml:7: ", {"dx, dy, dz", "dtheta"}));
  EXPECT_TRUE(reported(rule_problems("rule = \"field\""), "case.toml:5: ", {"'file' is missing"}));
  EXPECT_TRUE(reported(rule_problems("rule = \"follow\""), "case.toml:5: ", {"'of' is missing"}));
  EXPECT_TRUE(reported(rule_problems("rule = \"circumferential-slide\""), "case.toml:5: ", {"'of' is missing"}));
  EXPECT_TRUE(reported(rule_problems("rule = \"slip\""), "case.toml:5: ", {"'surface' is missing"}));
}

TEST(CaseFileErrors, KeysOfOtherRulesAreUnknown) {
  EXPECT_TRUE(reported(rule_problems("rule = \"fixed\"\ntranslation = [0, 0, 1]"),
                       "case.toml:8: ", {"unknown key 'translation'", "known here: patches, rank, rule"}));
  EXPECT_TRUE(
      reported(rule_problems("rule = \"follow\"\nof = \"b\"\nsurface = \"plane\""), "case.toml:9: ", {"'surface'"}));
}

TEST(CaseFileErrors, RigidMotions) {
  EXPECT_TRUE(reported(rule_problems("rule = \"rigid\"\nrotation = { axis = [0, 0, 1], origin = [0, 0, 0] }"),
                       "case.toml:8: ", {"'angle_deg' is missing"}));
  EXPECT_TRUE(reported(rule_problems("rule = \"rigid\"\nrotation = { axis = [0, 0, 1], angle_deg = 1 }"),
                       "case.toml:8: ", {"origin", "is missing"}));
  EXPECT_TRUE(
      reported(rule_problems("rule = \"rigid\"\nrotation = { axis = [0, 0, 0], origin = [0, 0, 0], angle_deg = 1 }"),
               "case.toml:8: ", {"no length"}));
  EXPECT_TRUE(reported(rule_problems("rule = \"rigid\"\nrotation = { angel_deg = 1 }"),
                       "case.toml:8: ", {"'angel_deg'", "'angle_deg'"}));
  EXPECT_TRUE(
      reported(problems_of(head + "[[motion]]\npatches = \"a\"\nrule = \"rigid\"\nrotation = { angle_deg = 5 }\n"),
               "case.toml:6: ", {"[mesh] has no axis"}));
  EXPECT_TRUE(reported(rule_problems("rule = \"rigid\"\nscale = -1"), "case.toml:8: ", {"positive"}));
  EXPECT_TRUE(reported(rule_problems("rule = \"rigid\"\nscale = [1, 0, 1]"), "case.toml:8: ", {"positive"}));
  EXPECT_TRUE(
      reported(rule_problems("rule = \"rigid\"\nscale = 2\nsteps = [ { scale = 3 } ]"), "case.toml:9: ", {"steps"}));
  EXPECT_TRUE(reported(rule_problems("rule = \"rigid\"\nsteps = [ { } ]"), "case.toml:8: ", {"steps", "needs scale"}));
}

TEST(CaseFileErrors, Formulas) {
  EXPECT_TRUE(reported(rule_problems("rule = \"formula\"\ndx = \"1\"\ndtheta = \"1\""), "case.toml:7: ", {"mixes"}));
  EXPECT_TRUE(
      reported(rule_problems("rule = \"formula\"\ndx = 1"), "case.toml:8: ", {"dx", "a string", "the number 1"}));
  EXPECT_TRUE(reported(rule_problems("rule = \"formula\"\ndy = \"1\"\ndx = \"(x\""), "case.toml:9: ", {"dx = \"(x\""}));
  EXPECT_TRUE(reported(rule_problems("rule = \"formula\"\ndx = \"k\"\nconstants = { k = \"1\" }"),
                       "case.toml:9: ", {"k", "a number"}));
  EXPECT_TRUE(reported(rule_problems("rule = \"formula\"\ndx = \"1\"\nconstants = { sin = 1 }"),
                       "case.toml:9: ", {"sin", "constant"}));
  for (std::string const text : {"dx = \"r\"", "dr = \"0.1\"", "dy = \"2*axial\""})
    EXPECT_TRUE(reported(problems_of(head + "[[motion]]\npatches = \"a\"\nrule = \"formula\"\n" + text + "\n"),
                         "case.toml:5: ", {"[mesh] has no axis"}))
        << text;
}

TEST(CaseFileErrors, FieldsPassOnWhatIsWrongWithTheirFile) {
  TemporaryFolder const folder;
  folder.write("bad.csv", "1,2,3,4,5,6\n1,2,3,4,5,x\n");
  auto const lines = error_lines(
      [&] { (void)read_case_file(folder.write("case.toml", case_with_rule("rule = \"field\"\nfile = \"bad.csv\""))); });
  EXPECT_TRUE(reported(lines, folder.path("case.toml").string() + ":8: ", {"bad.csv:2", "dz = \"x\""}));
  EXPECT_TRUE(reported(rule_problems("rule = \"field\"\nfile = \"nowhere.csv\""),
                       "case.toml:8: ", {"'nowhere.csv' does not exist"}));
  EXPECT_TRUE(reported(rule_problems("rule = \"field\"\nfile = \"n.csv\"\nlength_scale = 0"),
                       "case.toml:9: ", {"positive", "0"}));
  EXPECT_TRUE(reported(rule_problems("rule = \"field\"\nfile = \"n.csv\"\nmax_distance = -1"),
                       "case.toml:9: ", {"positive", "-1"}));
}

TEST(CaseFileErrors, RulesThatNeedTheMachineAxis) {
  for (std::string const text :
       {"rule = \"follow\"\nof = \"b\"", "rule = \"circumferential-slide\"\nof = \"b\"",
        "rule = \"slip\"\nsurface = \"revolution\"", "rule = \"free\"\nconstraint = \"axial\""}) {
    auto const lines = problems_of(head + "[[motion]]\npatches = \"a\"\n" + text + "\n");
    ASSERT_EQ(lines.size(), 1u) << text;
    EXPECT_NE(lines[0].find("axis"), std::string::npos) << lines[0];
    EXPECT_NE(lines[0].find("[mesh]"), std::string::npos) << lines[0];
  }
}

TEST(CaseFileErrors, Slip) {
  EXPECT_TRUE(reported(rule_problems("rule = \"slip\"\nsurface = \"plane\"\ncrease_angle_deg = 30"),
                       "case.toml:9: ", {"baseline"}));
  EXPECT_TRUE(reported(rule_problems("rule = \"slip\"\nsurface = \"baseline\"\ncrease_angle_deg = -30"),
                       "case.toml:9: ", {"-30", "180"}));
  EXPECT_TRUE(reported(
      rule_problems("rule = \"slip\"\nsurface = \"baseline\"\nplane = { point = [0, 0, 0], normal = [0, 0, 1] }"),
      "case.toml:9: ", {"surface = \"plane\""}));
  EXPECT_TRUE(reported(rule_problems("rule = \"slip\"\nsurface = \"plane\"\nprofile = [[0, 1], [1, 1]]"),
                       "case.toml:9: ", {"revolution"}));
  EXPECT_TRUE(reported(rule_problems("rule = \"slip\"\nsurface = \"revolution\"\nprofile = [[0, 1]]"),
                       "case.toml:9: ", {"two points"}));
  EXPECT_TRUE(reported(rule_problems("rule = \"slip\"\nsurface = \"revolution\"\nprofile = [[0, 1], [1]]"),
                       "case.toml:9: ", {"two points"}));
  EXPECT_TRUE(reported(rule_problems("rule = \"slip\"\nsurface = \"revolution\"\nprofile = [[0, 1], [1, -1]]"),
                       "case.toml:9: ", {"[1, -1]"}));
  EXPECT_TRUE(
      reported(rule_problems("rule = \"slip\"\nsurface = \"plane\"\nplane = { point = [0, 0, 0], normal = [0, 0, 0] }"),
               "case.toml:9: ", {"no length"}));
  EXPECT_TRUE(reported(rule_problems("rule = \"slip\"\nsurface = \"plane\"\nplane = { point = [0, 0, 0] }"),
                       "case.toml:9: ", {"'normal' is missing"}));
}

TEST(CaseFileErrors, BoundaryLayers) {
  auto const problems = [](std::string const& line) {
    return problems_of(head + rule + "[boundary_layer]\n" + line + "\n");
  };
  EXPECT_TRUE(reported(problems("extent = \"blok\""), "case.toml:7: ", {"extent", "\"blok\"", "'block'"}));
  EXPECT_TRUE(reported(problems("extent = { layers = 0 }"), "case.toml:7: ", {"layers", "at least 1"}));
  EXPECT_TRUE(reported(problems("extent = { thickness = 0 }"), "case.toml:7: ", {"thickness", "positive"}));
  EXPECT_TRUE(reported(problems("extent = { layers = 3, thickness = 1 }"), "case.toml:7: ", {"exactly one"}));
  EXPECT_TRUE(reported(problems("extent = {}"), "case.toml:7: ", {"exactly one"}));
  EXPECT_TRUE(reported(problems("extent = 5"), "case.toml:7: ", {"extent", "the number 5"}));
}

TEST(CaseFileErrors, VolumeGuardAndConformity) {
  auto const problems = [](std::string const& lines) { return problems_of(head + rule + lines + "\n"); };
  EXPECT_TRUE(reported(problems("[volume]\npriority = [ { rule = \"bondary\" } ]"), "case.toml:7: ", {"'boundary'"}));
  EXPECT_TRUE(reported(problems("[volume]\npriority = [ { rule = \"boundary\", order = [\"wal\"] } ]"),
                       "case.toml:7: ", {"\"wal\"", "'wall'"}));
  EXPECT_TRUE(reported(problems("[volume]\npriority = [ { rule = \"boundary\", order = [\"wall\", \"wall\"] } ]"),
                       "case.toml:7: ", {"\"wall\" twice"}));
  EXPECT_TRUE(reported(problems("[volume]\npriority = [ { rule = \"quality\", order = [\"wall\"] } ]"),
                       "case.toml:7: ", {"'order'"}));
  EXPECT_TRUE(reported(problems("[guard]\nmin_determinant = 1"), "case.toml:7: ", {"min_determinant", "found 1"}));
  EXPECT_TRUE(reported(problems("[conformity]\ntolerance = -1e-3"), "case.toml:7: ", {"tolerance", "-0.001"}));
}

TEST(CaseFileErrors, AConstantThatNoFormulaCanNameHasItsLine) {
  for (std::string const name : {"tip-bend", "a.b", "sin", "\"2x\"", "t", "\"\"", "\"\u00e4\""}) {
    std::string const quoted = name == "a.b" ? "\"a.b\"" : name;
    auto const lines =
        problems_of("[constants]\n" + quoted + " = 1.5\n" + case_with_rule("rule = \"formula\"\ndx = \"0.1 * x\"\n"));
    EXPECT_TRUE(reported(lines, "case.toml:2: ", {"cannot be the name of a constant"})) << name;
    EXPECT_EQ(lines.size(), 1U) << name;
  }
  EXPECT_TRUE(reported(problems_of(case_with_rule("rule = \"formula\"\ndx = \"a-b * x\"\nconstants = { a-b = 1 }\n")),
                       "case.toml:9: ", {"cannot be the name of a constant"}));
  EXPECT_TRUE(reported(problems_of(case_with_rule("rule = \"formula\"\ndx = \"\"\n")), "case.toml:8: ", {"is empty"}));
}

}  // namespace
}  // namespace gridmorph::test
