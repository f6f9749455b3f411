// The keys of rule = "sections": what they become, and what is refused with which line.
#include "case_text.hpp"

#include <gridmorph/case/detail/sections_reader.hpp>

#include <cmath>

namespace gridmorph::test {
namespace {

using Stations = std::vector<std::pair<double, double>>;

SectionsRule sections_of(std::string const& lines) {
  return std::get<SectionsRule>(rule_of("rule = \"sections\"\n" + lines));
}

std::vector<std::string> sections_problems(std::string const& lines) {
  return problems_of(case_with_rule("rule = \"sections\"\n" + lines));
}

TEST(SectionsRuleText, ReadsTablesNumbersAndDegrees) {
  SectionsRule const rule = sections_of(
      "chord = [[0.15, -0.1], [0.5, 0.1], [0.9, -0.1]]\ntwist_deg = 90\nlean = [[0, 0], [1, 2]]\npivot = 0.25");
  EXPECT_EQ(rule.chord.stations, (Stations{{0.15, -0.1}, {0.5, 0.1}, {0.9, -0.1}}));
  EXPECT_EQ(rule.chord.interpolation, SpanwiseTable::Interpolation::spline);
  EXPECT_DOUBLE_EQ(rule.twist_rad.at(0.7), std::acos(0.0));
  EXPECT_EQ(rule.lean.stations, (Stations{{0, 0}, {1, 2}}));
  EXPECT_TRUE(rule.thickness.stations.empty());
  EXPECT_EQ(rule.pivot, 0.25);
  EXPECT_EQ(sections_of("chord = 0.1\ninterpolation = \"linear\"").chord.interpolation,
            SpanwiseTable::Interpolation::linear);
}

TEST(SectionsRuleText, IsAboutBladesWhereThereIsAnAxisAndAboutWingsOtherwise) {
  EXPECT_EQ(sections_of("chord = 0.1").sections, SectionsRule::Sections::blade);
  SectionsRule const given = sections_of("chord = 0.1\nkind = \"wing\"\nspan = [0, 0, 1]\nflow = [1, 0.1, 0]");
  EXPECT_EQ(given.sections, SectionsRule::Sections::wing);
  EXPECT_EQ(given.span, (Vec3{0, 0, 1}));
  EXPECT_EQ(given.flow, (Vec3{1, 0.1, 0}));
  CaseFile const without = parse_case_file(
      "[mesh]\ninput = \"a\"\n[[motion]]\npatches = \"wing\"\nrule = \"sections\"\ntwist_deg = 1\n", "case.toml");
  EXPECT_EQ(std::get<SectionsRule>(without.motion.rules.at(0).rule).sections, SectionsRule::Sections::wing);
}

TEST(SectionsRuleText, ReadsColumnsOfAFile) {
  TemporaryFolder const folder;
  folder.write("redesign.csv", "# redesign 7\nspan, chord, stagger_deg\n0, 0, 1\n0.5, 0.1,\n1, , -1\n");
  auto const path = folder.write(
      "case.toml", case_with_rule("rule = \"sections\"\nfile = \"redesign.csv\"\nsweep = [[0, 0], [1, 0.01]]"));
  auto const rule = std::get<SectionsRule>(read_case_file(path).motion.rules.at(0).rule);
  EXPECT_EQ(rule.chord.stations, (Stations{{0, 0}, {0.5, 0.1}}));
  ASSERT_EQ(rule.stagger_rad.stations.size(), 2u);
  EXPECT_DOUBLE_EQ(rule.stagger_rad.stations[1].second, -std::acos(-1.0) / 180);
  EXPECT_EQ(rule.sweep.stations, (Stations{{0, 0}, {1, 0.01}}));
}

TEST(SectionsRuleText, ColumnsMayBeSeparatedByBlanksOrSemicolons) {
  for (std::string const text : {"span chord\n0 0.1\n1\t0.2\n", "span;chord\r\n0;0.1\r\n1;0.2\r\n"}) {
    auto const columns = casefile::parse_spanwise_columns(text, "t.csv", {"chord"});
    ASSERT_EQ(columns.size(), 1u);
    EXPECT_EQ(columns[0].name, "chord");
    EXPECT_EQ(columns[0].stations, (Stations{{0, 0.1}, {1, 0.2}}));
  }
}

TEST(SectionsRuleErrors, NameTheLineTheValueAndTheRemedy) {
  EXPECT_TRUE(reported(sections_problems(""), "case.toml:7: ", {"at least one of chord", "bow_deg"}));
  EXPECT_TRUE(reported(sections_problems("cord = 0.1"), "case.toml:8: ", {"unknown key 'cord'", "'chord'"}));
  EXPECT_TRUE(
      reported(sections_problems("chord = [[0, 0.1], [0.5]]"), "case.toml:8: ", {"chord", "[span fraction, value]"}));
  EXPECT_TRUE(reported(sections_problems("chord = []"), "case.toml:8: ", {"empty"}));
  EXPECT_TRUE(reported(sections_problems("chord = \"a\""), "case.toml:8: ", {"expected a number"}));
  EXPECT_TRUE(reported(sections_problems("chord = [[0, 0], [0, 1]]"), "case.toml:8: ", {"must ascend", "0 after 0"}));
  EXPECT_TRUE(reported(sections_problems("chord = [[0, 0], [1.5, 1]]"), "case.toml:8: ", {"between 0", "1.5"}));
  EXPECT_TRUE(reported(sections_problems("chord = -1"), "case.toml:8: ", {"above -1", "found -1"}));
  EXPECT_TRUE(reported(sections_problems("bow_deg = 90"), "case.toml:8: ", {"between -90 and 90", "found 90"}));
  EXPECT_TRUE(reported(sections_problems("chord = 0\nspan = [0, 0, 1]"), "case.toml:9: ", {"kind = \"wing\""}));
  EXPECT_TRUE(reported(sections_problems("chord = 0\nkind = \"wing\"\nspan = [2, 0, 0]"),
                       "case.toml:10: ", {"runs along the flow"}));
  EXPECT_TRUE(reported(problems_of("[mesh]\ninput = \"a\"\n[[motion]]\npatches = \"b\"\nrule = \"sections\"\n"
                                   "kind = \"blade\"\nchord = 0.1\n"),
                       "case.toml:6: ", {"machine axis"}));
}

TEST(SectionsRuleErrors, OfFilesNameTheLineInTheFile) {
  auto const problems = [](std::string const& text) {
    return error_lines([&] { (void)casefile::parse_spanwise_columns(text, "t.csv", {"chord", "twist_deg"}); });
  };
  EXPECT_TRUE(reported(problems("0, 1\n"), "t.csv:1: ", {"no parameter"}));
  EXPECT_TRUE(reported(problems("chord\n0\n"), "t.csv:1: ", {"'span'"}));
  EXPECT_TRUE(reported(problems("span,cord\n0,1\n"), "t.csv:1: ", {"'cord'", "'chord'"}));
  EXPECT_TRUE(reported(problems("span,chord,chord\n0,1,1\n"), "t.csv:1: ", {"twice"}));
  EXPECT_TRUE(reported(problems("span,chord\n\n0,1\n1\n"), "t.csv:4: ", {"expected 2 columns", "found 1"}));
  EXPECT_TRUE(reported(problems("span,chord\n0,x\n"), "t.csv:2: ", {"chord = \"x\"", "not a number"}));
  EXPECT_TRUE(reported(problems("span,chord\n0.5,1\n0.4,1\n"), "t.csv:3: ", {"ascend", "0.4 after 0.5"}));
  EXPECT_TRUE(reported(problems("\n# nothing\n"), "t.csv: ", {"holds no table"}));
  TemporaryFolder const folder;
  auto const missing = folder.write("case.toml", case_with_rule("rule = \"sections\"\nfile = \"none.csv\"\n"));
  EXPECT_TRUE(reported(error_lines([&] { (void)read_case_file(missing); }),
                       missing.string() + ":8: ", {"none.csv", "does not exist"}));
  folder.write("t.csv", "span,chord\n0,0.1\n");
  auto const twice = folder.write("twice.toml", case_with_rule("rule = \"sections\"\nfile = \"t.csv\"\nchord = 0.2\n"));
  EXPECT_TRUE(reported(error_lines([&] { (void)read_case_file(twice); }), twice.string() + ":9: ", {"remove one"}));
}

}  // namespace
}  // namespace gridmorph::test
