// Every rule of a case file becomes the rule it says.
#include "case_text.hpp"

#include <cmath>
#include <numbers>

namespace gridmorph::testing {
namespace {

Vec3 moved(Rule const& rule, Vec3 const& p) {
  auto const& rigid = std::get<RigidRule>(rule);
  return rigid.matrix * p + rigid.translation;
}

TEST(FixedRuleText, IsRead) { EXPECT_TRUE(std::holds_alternative<FixedRule>(rule_of("rule = \"fixed\""))); }

TEST(RigidRuleText, TranslatesWithAnExactIdentityMatrix) {
  Rule const rule = rule_of("rule = \"rigid\"\ntranslation = [1, 0.5, -2]");
  EXPECT_EQ(moved(rule, {0.1, 0.2, 0.3}), (Vec3{0.1 + 1, 0.2 + 0.5, 0.3 - 2}));
}

TEST(RigidRuleText, LeavesEverythingInPlaceForZeroMotions) {
  Vec3 const p{0.1, 1e9, -7e-9};
  for (std::string const text : {"translation = [0, 0, 0]", "scale = 1", "rotation = { angle_deg = 0 }",
                                 "scale = { factor = 1, origin = [1, 2, 3] }\nrotation = { angle_deg = 0.0 }"})
    EXPECT_EQ(moved(rule_of("rule = \"rigid\"\n" + text), p), p) << text;
}

TEST(RigidRuleText, TurnsRightHandedAboutItsAxisAndOrigin) {
  Rule const rule = rule_of("rule = \"rigid\"\nrotation = { axis = [0, 0, 2], origin = [1, 0, 0], angle_deg = 90 }");
  EXPECT_VEC3_NEAR(moved(rule, {2, 0, 5}), (Vec3{1, 1, 5}), 1e-15);
}

TEST(RigidRuleText, TurnsAboutTheMachineAxisWhenItNamesNone) {
  EXPECT_VEC3_NEAR(moved(rule_of("rule = \"rigid\"\nrotation = { angle_deg = 90 }"), {3, 1, 0}), (Vec3{3, 0, 1}),
                   1e-15);
}

TEST(RigidRuleText, ScalesThenTurnsThenTranslates) {
  Rule const rule = rule_of(
      "rule = \"rigid\"\ntranslation = [0, 0, 10]\nrotation = { axis = [0, 0, 1], origin = [0, 0, 0], angle_deg = 90 "
      "}\n"
      "scale = [2, 3, 4]");
  EXPECT_VEC3_NEAR(moved(rule, {1, 1, 1}), (Vec3{-3, 2, 14}), 1e-14);
}

TEST(RigidRuleText, ScalesAboutAnOrigin) {
  Rule const rule = rule_of("rule = \"rigid\"\nscale = { factor = 0.5, origin = [1, 1, 1] }");
  EXPECT_EQ(moved(rule, {1, 1, 1}), (Vec3{1, 1, 1}));
  EXPECT_EQ(moved(rule, {3, 1, -1}), (Vec3{2, 1, 0}));
}

TEST(RigidRuleText, AppliesStepsInTheirOrder) {
  Rule const rule = rule_of(
      "rule = \"rigid\"\nsteps = [ { translation = [1, 0, 0] }, { scale = 2 }, { rotation = { axis = [0, 0, 1], origin "
      "= [0, "
      "0, 0], angle_deg = 90 } } ]");
  EXPECT_VEC3_NEAR(moved(rule, {0, 0, 0}), (Vec3{0, 2, 0}), 1e-15);
}

TEST(FormulaRuleText, UsesConstantsOfTheFileAndOfTheRule) {
  Rule const rule =
      rule_of("rule = \"formula\"\ndx = \"a*x\"\ndz = \"b\"\nconstants = { b = 7 }\n[constants]\na = 0.5\nb = 1");
  EXPECT_EQ(displacement_of(rule, {4, 0, 0}), (Vec3{2, 0, 7}));
}

TEST(FormulaRuleText, MovesInCylindricalComponents) {
  Rule const rule = rule_of("rule = \"formula\"\ndr = \"0\"\ndtheta = \"90*deg\"\ndaxial = \"1\"");
  EXPECT_VEC3_NEAR(displacement_of(rule, {0, 2, 0}), (Vec3{1, -2, 2}), 1e-14);
  EXPECT_NE(std::get<FunctionRule>(rule).description.find("dtheta = 90*deg"), std::string::npos);
}

TEST(FieldRuleText, ReadsItsFileBesideTheCaseFile) {
  TemporaryFolder const folder;
  folder.write("blade.csv", "x,y,z,dx,dy,dz\n0,0,0,1,2,3\n1,0,0,1,2,3\n");
  auto const path = folder.write("case.toml", case_with_rule("rule = \"field\"\nfile = \"blade.csv\"\nfactor = 2"));
  CaseFile const c = read_case_file(path);
  EXPECT_EQ(displacement_of(c.motion.rules.at(0).rule, {0, 0, 0}), (Vec3{2, 4, 6}));
  EXPECT_EQ(std::get<FunctionRule>(c.motion.rules.at(0).rule).description, "field blade.csv (2 points)");
  ASSERT_EQ(c.fields.size(), 1u);
  EXPECT_EQ(c.fields[0].field->mapping().evaluated, 1);
  EXPECT_EQ(c.fields[0].where, path.string() + ":5");
}

TEST(SlideAndFollowRuleTexts, KeepWhatTheyFollow) {
  Rule const slide = rule_of("rule = \"circumferential-slide\"\nof = \"blade\"");
  EXPECT_EQ(std::get<CircumferentialSlideRule>(slide).of, (std::vector<std::string>{"blade"}));
  Rule const follow = rule_of("rule = \"follow\"\nof = [\"a\", \"b*\"]");
  EXPECT_EQ(std::get<FollowRule>(follow).of, (std::vector<std::string>{"a", "b*"}));
}

TEST(SlipRuleText, ReadsPlanesAndProfiles) {
  auto const plain = std::get<SlipRule>(rule_of("rule = \"slip\"\nsurface = \"plane\""));
  EXPECT_EQ(plain.surface, SlipRule::Surface::plane);
  EXPECT_FALSE(plain.plane.has_value());
  auto const plane = std::get<SlipRule>(
      rule_of("rule = \"slip\"\nsurface = \"plane\"\nplane = { point = [0, 0, 1], normal = [0, 0, 2] }"));
  ASSERT_TRUE(plane.plane.has_value());
  EXPECT_EQ(plane.plane->first, (Vec3{0, 0, 1}));
  EXPECT_EQ(plane.plane->second, (Vec3{0, 0, 2}));
  auto const round =
      std::get<SlipRule>(rule_of("rule = \"slip\"\nsurface = \"revolution\"\nprofile = [[0, 1], [0.5, 1.25], [1, 2]]"));
  EXPECT_EQ(round.surface, SlipRule::Surface::revolution);
  EXPECT_EQ(round.profile, (std::vector<std::pair<double, double>>{{0, 1}, {0.5, 1.25}, {1, 2}}));
}

TEST(SlipRuleText, ReadsTheBaselineSurface) {
  auto const plain = std::get<SlipRule>(rule_of("rule = \"slip\"\nsurface = \"baseline\""));
  EXPECT_EQ(plain.surface, SlipRule::Surface::baseline);
  EXPECT_EQ(plain.crease_angle_rad, SlipRule{}.crease_angle_rad);
  auto const sharp = std::get<SlipRule>(rule_of("rule = \"slip\"\nsurface = \"baseline\"\ncrease_angle_deg = 30"));
  EXPECT_NEAR(sharp.crease_angle_rad, std::numbers::pi / 6, 1e-15);
}

TEST(FreeRuleText, ReadsItsConstraint) {
  auto const constraint = [](std::string const& text) {
    return std::get<FreeRule>(rule_of("rule = \"free\"\n" + text)).constraint;
  };
  EXPECT_EQ(constraint(""), FreeRule::Constraint::none);
  EXPECT_EQ(constraint("constraint = \"none\""), FreeRule::Constraint::none);
  EXPECT_EQ(constraint("constraint = \"axial\""), FreeRule::Constraint::axial);
  EXPECT_EQ(constraint("constraint = \"plane\""), FreeRule::Constraint::plane);
}

}  // namespace
}  // namespace gridmorph::testing
