// Every rule of a case file becomes the rule it says.
#include "case_text.hpp"

#include <cmath>
#include <numbers>

namespace gridmorph::test {
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

/// The rule of case_with_rule() at a time of a sequence.
Rule rule_at(std::string const& lines, double time, int step = 1) {
  CaseFile const c =
      parse_case_file("[constants]\ngain = 2\n[sequence]\nsteps = 4\n" + case_with_rule(lines), "case.toml");
  return motion_at(c, {time, time, step}).rules.at(0).rule;
}

TEST(AmplitudeText, AShareOfATurnIsATurnByThatShareOfTheAngle) {
  std::string const turn = "rule = \"rigid\"\nrotation = { axis = [0, 0, 1], origin = [1, 0, 0], angle_deg = 90 }\n";
  auto const turned = [&](std::string const& amplitude, double time) {
    return moved(rule_at(turn + amplitude, time), {2, 0, 5});
  };
  auto const by = [](double degrees) {
    double const angle = degrees * std::numbers::pi / 180;
    return Vec3{1 + std::cos(angle), std::sin(angle), 5};
  };
  std::string const ramp = "amplitude = [[1, 0], [2, 1], [4, -1]]\n";
  EXPECT_EQ(turned(ramp, 0.5), (Vec3{2, 0, 5}));
  EXPECT_VEC3_NEAR(turned(ramp, 1.5), by(45), 1e-14);
  EXPECT_VEC3_NEAR(turned(ramp, 3.5), by(-45), 1e-14);
  EXPECT_VEC3_NEAR(turned(ramp, 9), by(-90), 1e-14);
  EXPECT_VEC3_NEAR(turned(ramp + "amplitude_law = \"smooth\"\n", 1.25), by(90 * (3. / 16 - 2. / 64)), 1e-14);
  EXPECT_VEC3_NEAR(turned("amplitude = \"gain * t / step\"\n", 0.25), by(45), 1e-14);
  EXPECT_VEC3_NEAR(moved(rule_of(turn + "amplitude = 0.5\n"), {2, 0, 5}), by(45), 1e-14);
}

TEST(AmplitudeText, MultipliesWhatEveryRuleWithADisplacementSays) {
  std::string const half = "amplitude = [[0, 0], [1, 0.5]]\n";
  EXPECT_VEC3_NEAR(displacement_of(rule_at("rule = \"formula\"\ndx = \"x + t\"\n" + half, 1), {3, 0, 0}),
                   (Vec3{2, 0, 0}), 1e-15);
  Vec3 const turned = displacement_of(rule_at("rule = \"formula\"\ndtheta = \"pi\"\n" + half, 1), {0, 1, 0});
  EXPECT_VEC3_NEAR(turned, (Vec3{0, -1, 1}), 1e-15);
  auto const sections =
      std::get<SectionsRule>(rule_at("rule = \"sections\"\nchord = [[0, 0.2], [1, -0.1]]\n" + half, 1));
  EXPECT_EQ(sections.chord.at(0), 0.1);
  EXPECT_EQ(sections.chord.at(1), -0.05);
  EXPECT_VEC3_NEAR(displacement_of(rule_at("rule = \"contour\"\nprofile = [[0, 1], [2, 1]]\n" + half, 1), {0.5, 0, 2}),
                   (Vec3{0, 0, -0.5}), 1e-15);
}

TEST(AmplitudeText, FormulasKnowTimeAndStep) {
  Rule const rule = rule_at("rule = \"formula\"\ndx = \"10 * step\"\ndy = \"x * t\"\n", 0.25, 3);
  EXPECT_EQ(displacement_of(rule, {8, 0, 0}), (Vec3{30, 2, 0}));
}

TEST(AmplitudeText, ProblemsHaveTheirLine) {
  auto const problems = [](std::string const& lines, std::string const& top = "[sequence]\nsteps = 4\n") {
    return problems_of(top + case_with_rule(lines));
  };
  std::string const rigid = "rule = \"rigid\"\ntranslation = [1, 0, 0]\n";
  EXPECT_TRUE(reported(problems(rigid + "amplitude = [[0, 0], [1, 1]]", ""), "case.toml:9: ", {"no [sequence]"}));
  EXPECT_TRUE(reported(problems("rule = \"formula\"\ndx = \"t\"", ""), "case.toml:8: ", {"no [sequence]"}));
  EXPECT_TRUE(
      reported(problems(rigid + "amplitude = [[1, 0], [1, 1]]"), "case.toml:11: ", {"must ascend", "1 after 1"}));
  EXPECT_TRUE(reported(problems(rigid + "amplitude = [[0, 1, 2]]"), "case.toml:11: ", {"[[time, value], ...]"}));
  EXPECT_TRUE(reported(problems(rigid + "amplitude = \"t * x\""), "case.toml:11: ", {"uses x", "t and step"}));
  EXPECT_TRUE(reported(problems(rigid + "amplitude = \"tt\""), "case.toml:11: ", {"unknown name 'tt'"}));
  EXPECT_TRUE(
      reported(problems(rigid + "amplitude = 1\namplitude_law = \"smooth\""), "case.toml:12: ", {"amplitude_law"}));
  EXPECT_TRUE(reported(problems("rule = \"fixed\"\namplitude = 2"), "case.toml:10: ", {"\"fixed\" gives none"}));
  EXPECT_TRUE(
      reported(problems("rule = \"follow\"\nof = \"hub\"\namplitude = 2"), "case.toml:11: ", {"rule of the blade"}));
  EXPECT_TRUE(reported(problems(rigid), "case.toml:1: ", {"no rule changes with time"}));
  EXPECT_TRUE(reported(problems(rigid + "amplitude = \"t\"", "[sequence]\ntimes = [0, 2, 1]\n"),
                       "case.toml:2: ", {"must ascend", "1 after 2"}));
  EXPECT_TRUE(reported(problems(rigid + "amplitude = \"t\"", "[sequence]\ntimes = [0, 1]\nsteps = 2\n"),
                       "case.toml:3: ", {"stands beside times"}));
}

TEST(SequenceText, StepsAreWhereTheTimesSay) {
  auto const sequence = [](std::string const& keys) {
    return *parse_case_file("[sequence]\n" + keys + case_with_rule("rule = \"formula\"\ndx = \"t\"\n"), "case.toml")
                .sequence;
  };
  SequenceOptions const given = sequence("times = [0, 0.25, 3]\nperiod = 2\n");
  EXPECT_EQ(given.steps, 3);
  EXPECT_EQ(given.time_at(1), 0.25);
  EXPECT_EQ(given.periods_at(2), 1.5);
  EXPECT_EQ(given.moment(2).step, 3);
  SequenceOptions const closed = sequence("steps = 5\nperiod = 2\ninclude_end = true\n");
  EXPECT_EQ(closed.time_at(0), 0);
  EXPECT_EQ(closed.time_at(4), 2);
  EXPECT_EQ(sequence("steps = 4\nperiod = 2\n").time_at(3), 1.5);
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
}  // namespace gridmorph::test
