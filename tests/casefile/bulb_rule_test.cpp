// The keys of rule = "bulb", of contours with an offset, and of rule = "extend".
#include "case_text.hpp"

#include <cmath>

namespace gridmorph::test {
namespace {

InflateRule bulbs_of(std::string const& lines) { return std::get<InflateRule>(rule_of("rule = \"bulb\"\n" + lines)); }

double height_at(InflateRule const& rule, double chords, double side, double span) {
  SurfacePlace place;
  place.chord = 1;
  place.span_fraction = span;
  place.side = side;
  place.from_leading_edge = chords;
  place.from_trailing_edge = 1 - chords;
  double out = -1;
  rule.height({&place, 1}, {&out, 1});
  return out;
}

std::vector<std::string> bulb_problems(std::string const& lines) {
  return problems_of(case_with_rule("rule = \"bulb\"\n" + lines));
}

TEST(BulbRuleText, AddsUpItsBulbs) {
  InflateRule const rule = bulbs_of(
      "bulbs = [ { height = 0.5, extent = 0.2, span = 0, span_extent = 0.5 },\n"
      "          { height = [[0, 1], [1, 2]], extent = 0.1, edge = \"trailing\", position = 0.3, shape = \"parabola\" "
      "} ]");
  EXPECT_EQ(height_at(rule, 0, 1, 0), 0.5);
  EXPECT_NEAR(height_at(rule, 0.1, 1, 0), 0.25, 1e-15);
  EXPECT_NEAR(height_at(rule, 0.7, 1, 1), 2, 1e-14);
  EXPECT_EQ(height_at(rule, 0.7, -1, 1), 0);
  EXPECT_TRUE(rule.sections->sides);
  EXPECT_EQ(rule.most_chords, 1);
  InflateRule const half = bulbs_of("bulbs = { height = 1, extent = 0.2 }\namplitude = 0.5\ncrease_angle_deg = 70");
  EXPECT_EQ(half.share, 0.5);
  EXPECT_EQ(half.crease_angle_deg, 70);
  EXPECT_FALSE(half.sections->sides);
}

TEST(BulbRuleErrors, NameTheLineAndTheRemedy) {
  EXPECT_TRUE(reported(bulb_problems(""), "case.toml:5: ", {"holds no bulb"}));
  EXPECT_TRUE(reported(bulb_problems("bulbs = { extent = 0.1 }"), "case.toml:8: ", {"height"}));
  EXPECT_TRUE(reported(bulb_problems("bulbs = { height = 1 }"), "case.toml:8: ", {"extent"}));
  EXPECT_TRUE(reported(bulb_problems("bulbs = { height = 1, extent = 0.1, span = 0 }"),
                       "case.toml:8: ", {"span and span_extent belong together"}));
  EXPECT_TRUE(reported(bulb_problems("bulbs = { height = 1, extent = [[0, 0.1], [2, 0.1]] }"),
                       "case.toml:8: ", {"extent", "between 0"}));
  EXPECT_TRUE(reported(bulb_problems("bulbs = { height = 1, extent = 0.8, position = -0.5 }"),
                       "case.toml:8: ", {"bulb 1", "other edge"}));
  EXPECT_TRUE(
      reported(bulb_problems("bulbs = { height = 1, extent = 0.1, shape = \"kosine\" }"), "case.toml:8: ", {"cosine"}));
}

TEST(ContourRuleText, OffsetsAreAddedToTheProfileOrStandAlone) {
  std::string const offset = "offset = \"0.25 * a * cos(2 * theta)\"\nconstants = { a = 2 }\n";
  // theta = 0 is along y.
  EXPECT_VEC3_NEAR(displacement_of(rule_of("rule = \"contour\"\n" + offset), {0.5, 2, 0}), (Vec3{0, 0.5, 0}), 1e-15);
  EXPECT_VEC3_NEAR(displacement_of(rule_of("rule = \"contour\"\n" + offset), {0.5, 0, 2}), (Vec3{0, 0, -0.5}), 1e-15);
  EXPECT_VEC3_NEAR(
      displacement_of(rule_of("rule = \"contour\"\nprofile = [[0, 1], [2, 1]]\namplitude = 0.5\n" + offset),
                      {0.5, 2, 0}),
      (Vec3{0, -0.25, 0}), 1e-15);
  EXPECT_TRUE(
      reported(problems_of(case_with_rule("rule = \"contour\"\noffset = \"t\"")), "case.toml:8: ", {"no [sequence]"}));
  EXPECT_TRUE(reported(problems_of(case_with_rule("rule = \"contour\"\n")), "case.toml:5: ", {"profile", "offset"}));
}

TEST(ExtendRuleText, NamesItsWalls) {
  EXPECT_EQ(std::get<ExtendRule>(rule_of("rule = \"extend\"\nof = [\"hub\", \"case\"]")).of,
            (std::vector<std::string>{"hub", "case"}));
  EXPECT_TRUE(reported(problems_of(case_with_rule("rule = \"extend\"")), "case.toml:5: ", {"of"}));
  EXPECT_TRUE(reported(problems_of(case_with_rule("rule = \"extend\"\nof = \"hub\"\namplitude = 2")),
                       "case.toml:9: ", {"rule of the blade or wall"}));
}

}  // namespace
}  // namespace gridmorph::test
