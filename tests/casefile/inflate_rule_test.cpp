// The keys of rule = "inflate": the heights they become, and what is refused with which line.
#include "case_text.hpp"

#include <gridmorph/case/detail/rule_kinds.hpp>

namespace gridmorph::test {
namespace {

InflateRule inflate_of(std::string const& lines) {
  return std::get<InflateRule>(rule_of("rule = \"inflate\"\n" + lines));
}

double height(InflateRule const& rule, SurfacePlace const& place) {
  double out = -1;
  rule.height({&place, 1}, {&out, 1});
  return out;
}

SurfacePlace place(Vec3 const& point, double span = 0, double chord = 0, double side = 1) {
  SurfacePlace out;
  out.point = point;
  out.span_fraction = span;
  out.chord_fraction = chord;
  out.side = side;
  return out;
}

std::vector<std::string> inflate_problems(std::string const& lines) {
  return problems_of(case_with_rule("rule = \"inflate\"\n" + lines));
}

TEST(InflateRuleText, ReadsALengthOrAnExpressionOfThePosition) {
  InflateRule const flat = inflate_of("height = 0.25\ncrease_angle_deg = 60");
  EXPECT_EQ(height(flat, place({1, 2, 3})), 0.25);
  EXPECT_EQ(flat.crease_angle_deg, 60);
  EXPECT_FALSE(flat.sections);
  InflateRule const wavy = inflate_of("height = \"a * x + r\"\nconstants = { a = 2 }");
  EXPECT_EQ(height(wavy, place({1, 3, 4})), 7);
  EXPECT_FALSE(wavy.sections);
}

TEST(InflateRuleText, PlacesOnSectionsAreVariablesUnlessConstantsHideThem) {
  InflateRule const rule = inflate_of("height = \"side * (span_fraction + 10 * chord_fraction)\"");
  ASSERT_TRUE(rule.sections);
  EXPECT_EQ(rule.sections->kind, SectionsRule::Sections::blade);
  EXPECT_TRUE(rule.sections->sides);
  EXPECT_EQ(height(rule, place({}, 0.5, 0.25, -1)), -3);
  EXPECT_FALSE(inflate_of("height = \"span_fraction\"").sections->sides);
  InflateRule const hidden = inflate_of("height = \"side\"\nconstants = { side = 3 }");
  EXPECT_FALSE(hidden.sections);
  EXPECT_EQ(height(hidden, place({}, 0, 0, -1)), 3);
  // Many places, more than are evaluated at once.
  std::vector<SurfacePlace> places(1300);
  for (std::size_t n = 0; n < places.size(); ++n) places[n].span_fraction = double(n);
  std::vector<double> heights(places.size());
  inflate_of("height = \"2 * span_fraction\"").height(places, heights);
  for (std::size_t n = 0; n < places.size(); ++n) EXPECT_EQ(heights[n], 2.0 * double(n));
}

TEST(InflateRuleText, ReadsATableOfHeights) {
  TemporaryFolder const folder;
  folder.write("heights.csv", "chord,span,height,side\n0,0,1,1\n1,0,3,1\n0,0,5,-1\n0.5,1,7,\n");
  auto const path = folder.write(
      "case.toml", case_with_rule("rule = \"inflate\"\nfile = \"heights.csv\"\ninterpolation = \"linear\""));
  auto const rule = std::get<InflateRule>(read_case_file(path).motion.rules.at(0).rule);
  ASSERT_TRUE(rule.sections);
  EXPECT_TRUE(rule.sections->sides);
  EXPECT_EQ(height(rule, place({}, 0, 0.5, 1)), 2);
  EXPECT_EQ(height(rule, place({}, 0, 0.5, -1)), 5);
  EXPECT_EQ(height(rule, place({}, 1, 0.1, -1)), 7);
  EXPECT_EQ(height(rule, place({}, 0.5, 0, 1)), 4);
}

TEST(InflateRuleText, AmplitudesAreSharesOfTheHeightAndTimeIsKnown) {
  EXPECT_EQ(inflate_of("height = 1\namplitude = 0.5").share, 0.5);
  CaseFile const c = parse_case_file(
      "[sequence]\nsteps = 4\n" + case_with_rule("rule = \"inflate\"\nheight = \"t * x\"\namplitude = \"step\""),
      "case.toml");
  auto const rule = std::get<InflateRule>(motion_at(c, {2, 2, 3}).rules.at(0).rule);
  EXPECT_EQ(rule.share, 3);
  EXPECT_EQ(height(rule, place({5, 0, 0})), 10);
}

TEST(InflateRuleErrors, NameTheLineAndTheRemedy) {
  EXPECT_TRUE(reported(inflate_problems(""), "case.toml:7: ", {"inflate needs height", "file ="}));
  EXPECT_TRUE(reported(inflate_problems("height = \"\""), "case.toml:8: ", {"empty"}));
  EXPECT_TRUE(reported(inflate_problems("height = \"spam_fraction\""),
                       "case.toml:8: ", {"unknown name 'spam_fraction'", "'span_fraction'"}));
  EXPECT_TRUE(reported(inflate_problems("height = \"t\""), "case.toml:8: ", {"no [sequence]"}));
  EXPECT_TRUE(reported(inflate_problems("height = 1\nkind = \"wing\""), "case.toml:9: ", {"span_fraction"}));
  EXPECT_TRUE(reported(inflate_problems("height = 1\ncrease_angle_deg = 0"), "case.toml:9: ", {"above 0"}));
  EXPECT_TRUE(reported(inflate_problems("height = 1\ninterpolation = \"linear\""), "case.toml:9: ", {"file"}));
  EXPECT_TRUE(reported(inflate_problems("height = 1\nfile = \"a.csv\""), "case.toml:9: ", {"remove one"}));
  EXPECT_TRUE(reported(problems_of("[mesh]\ninput = \"a\"\n[[motion]]\npatches = \"b\"\nrule = \"inflate\"\n"
                                   "height = \"r\"\n"),
                       "case.toml:6: ", {"[mesh] has no axis"}));
}

TEST(InflateRuleErrors, OfTablesNameTheLineInTheFile) {
  auto const problems = [](std::string const& text) {
    return error_lines([&] { (void)casefile::parse_heights(text, "h.csv"); });
  };
  EXPECT_TRUE(reported(problems("span,chord\n0,0\n"), "h.csv:1: ", {"no column 'height'"}));
  EXPECT_TRUE(reported(problems("span,chord,hight\n"), "h.csv:1: ", {"'hight'", "'height'"}));
  EXPECT_TRUE(reported(problems("span,chord,height,span\n"), "h.csv:1: ", {"twice"}));
  EXPECT_TRUE(reported(problems("span,chord,height\n\n0,1.5,1\n"), "h.csv:3: ", {"chord = \"1.5\"", "0 to 1"}));
  EXPECT_TRUE(reported(problems("span,chord,height\n0,1,a\n"), "h.csv:2: ", {"height = \"a\"", "a number"}));
  EXPECT_TRUE(reported(problems("span,chord,height\n0,1\n"), "h.csv:2: ", {"expected 3 columns"}));
  EXPECT_TRUE(reported(problems("span,chord,height,side\n0,1,1,2\n"), "h.csv:2: ", {"side = \"2\"", "1 or -1"}));
  EXPECT_TRUE(reported(problems("span,chord,height\n"), "h.csv: ", {"holds no heights"}));
}

}  // namespace
}  // namespace gridmorph::test
