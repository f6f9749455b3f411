#include "case_text.hpp"

#include <gridmorph/case/formula.hpp>

#include <cmath>
#include <numbers>

namespace gridmorph::test {
namespace {

constexpr double pi = std::numbers::pi;

FunctionRule formula(FormulaFrame frame, std::array<std::string, 3> const& expressions, Axis const& axis = {},
                     std::map<std::string, double> const& constants = {}) {
  std::array<std::string, 3> const keys = frame == FormulaFrame::cartesian
                                              ? std::array<std::string, 3>{"dx", "dy", "dz"}
                                              : std::array<std::string, 3>{"dr", "dtheta", "daxial"};
  std::array<FormulaComponent, 3> components;
  for (int c = 0; c < 3; ++c) components[c] = {keys[c], expressions[c], "case.toml:9"};
  Problems problems;
  FunctionRule rule = make_formula(frame, components, constants, axis, problems);
  problems.throw_if_any<ConfigError>();
  return rule;
}

Vec3 at(FunctionRule const& rule, Vec3 const& p) { return displacement_of(Rule{rule}, p); }

TEST(Formula, EvaluatesExpressionsOfThePosition) {
  auto const rule = formula(FormulaFrame::cartesian, {"x*y + 1", "sin(z)", "x > 1 ? 2 : -2"});
  EXPECT_EQ(at(rule, {2, 3, 0.5}), (Vec3{7, std::sin(0.5), 2}));
  EXPECT_EQ(at(rule, {1, 0, 0}), (Vec3{1, 0, -2}));
}

TEST(Formula, TakesAbsentComponentsAsZero) {
  EXPECT_EQ(at(formula(FormulaFrame::cartesian, {"", "0.25", ""}), {1, 2, 3}), (Vec3{0, 0.25, 0}));
}

TEST(Formula, GivesEveryPointOfALongListItsOwnValue) {
  auto const rule = formula(FormulaFrame::cartesian, {"x", "y*z", "0.5"});
  std::vector<Vec3> points, out(1777);
  for (int n = 0; n < 1777; ++n) points.push_back({0.1 * n, n % 7 + 1.0, n % 11 - 5.0});
  rule.function(points, out);
  for (int n = 0; n < 1777; ++n) EXPECT_EQ(out[n], (Vec3{points[n].x, points[n].y * points[n].z, 0.5}));
}

TEST(Formula, KnowsConstantsPiAndDegrees) {
  auto const rule = formula(FormulaFrame::cartesian, {"amplitude*x", "pi", "90*deg"}, {}, {{"amplitude", 0.125}});
  EXPECT_EQ(at(rule, {2, 0, 0}), (Vec3{0.25, pi, pi / 2}));
}

TEST(Formula, KnowsSmoothstepAndClamp) {
  auto const rule = formula(FormulaFrame::cartesian,
                            {"smoothstep(1, 3, x)", "clamp(x, 0, 1)", "hypot(3, 4) + floor(1.5) + ceil(1.5)"});
  EXPECT_EQ(at(rule, {0, 0, 0}), (Vec3{0, 0, 8}));
  EXPECT_EQ(at(rule, {2, 0, 0}), (Vec3{0.5, 1, 8}));
  EXPECT_EQ(at(rule, {9, 0, 0}), (Vec3{1, 1, 8}));
}

TEST(Formula, MeasuresThetaRightHandedAboutCoordinateAxes) {
  Vec3 const e[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int a = 0; a < 3; ++a) {
    Vec3 const origin{0.5, -1, 2};
    auto const rule = formula(FormulaFrame::cartesian, {"r", "theta", "axial"}, {origin, 3.0 * e[a]});
    Vec3 const zero = e[(a + 1) % 3], quarter = e[(a + 2) % 3];
    EXPECT_VEC3_NEAR(at(rule, origin + 2 * zero + 7 * e[a]), (Vec3{2, 0, 7}), 1e-14);
    EXPECT_VEC3_NEAR(at(rule, origin + 2 * quarter - e[a]), (Vec3{2, pi / 2, -1}), 1e-14);
    EXPECT_VEC3_NEAR(at(rule, origin + quarter + zero), (Vec3{std::sqrt(2), pi / 4, 0}), 1e-14);
  }
}

TEST(Formula, MovesAlongCirclesExactly) {
  Axis const axis{{1, 2, 3}, {1, 1, 0}};
  Vec3 const p{2, 0, 5};
  for (double const angle : {1e-9, 0.1, 1.0, -3.0}) {
    auto const rule = formula(FormulaFrame::cylindrical, {"", "angle", ""}, axis, {{"angle", angle}});
    Vec3 const turned = rotation_about(axis.origin, axis.direction, angle)(p);
    EXPECT_VEC3_NEAR(p + at(rule, p), turned, 1e-14);
  }
}

TEST(Formula, AddsRadialAndAxialMotionInTheTurnedDirection) {
  auto const rule = formula(FormulaFrame::cylindrical, {"0.5*r", "90*deg", "-axial"}, {{0, 0, 0}, {0, 0, 1}});
  EXPECT_VEC3_NEAR((Vec3{2, 0, 4} + at(rule, {2, 0, 4})), (Vec3{0, 3, 0}), 1e-14);
}

TEST(Formula, GivesExactZerosForZeroMotion) {
  auto const rule = formula(FormulaFrame::cylindrical, {"0*x", "0*r", "0"}, {{0.3, 0.1, 0}, {1, 0.2, -0.4}});
  for (Vec3 const& p : {Vec3{1, 2, 3}, Vec3{0.3, 0.1, 0}, Vec3{-1e9, 1e-9, 7}}) EXPECT_EQ(at(rule, p), (Vec3{0, 0, 0}));
}

TEST(Formula, LeavesPointsOnTheAxisUnlessTheRadiusChangesThere) {
  EXPECT_EQ(at(formula(FormulaFrame::cylindrical, {"r", "1", "2"}), {5, 0, 0}), (Vec3{2, 0, 0}));
  auto const lines = error_lines<MotionError>([] { at(formula(FormulaFrame::cylindrical, {"1", "", ""}), {5, 0, 0}); });
  EXPECT_TRUE(reported(lines, "case.toml:9: ", {"dr", "(5, 0, 0)", "on the axis"}));
}

TEST(Formula, ReportsThePointWhereAValueIsNotFinite) {
  auto const rule = formula(FormulaFrame::cartesian, {"", "sqrt(x)", ""});
  auto const lines = error_lines<MotionError>([&] { at(rule, {-4, 2, 3}); });
  EXPECT_TRUE(reported(lines, "case.toml:9: ", {"dy = \"sqrt(x)\"", "nan", "x = -4", "y = 2", "z = 3"}));
  EXPECT_TRUE(reported(error_lines<MotionError>([] {
                         at(formula(FormulaFrame::cartesian, {"1/x", "", ""}), {0, 0, 0});
                       }),
                       "case.toml:9: ", {"inf"}));
}

TEST(Formula, ReportsUnknownNamesWithPositionAndTheNearestName) {
  auto const problems = error_lines([] {
    formula(FormulaFrame::cartesian, {"0.1*thetta + 1", "frobnicate", "sinn(x)"});
  });
  EXPECT_TRUE(reported(problems, "case.toml:9: ", {"dx", "'thetta' at character 5", "'theta'"}));
  EXPECT_TRUE(reported(problems, "case.toml:9: ", {"dy", "'frobnicate' at character 1", "known here"}));
  EXPECT_TRUE(reported(problems, "case.toml:9: ", {"dz", "'sinn'", "'sin'"}));
}

TEST(Formula, ReportsSyntaxErrorsWithTheirPosition) {
  auto const problem = [](std::string const& e) {
    return error_lines([&] { formula(FormulaFrame::cartesian, {e, "", ""}); });
  };
  for (std::string const text : {"x +", "(x", "x)", "2 * * 3", "sin()", "x y", "?", "\"a\"", "x ? 1"})
    EXPECT_TRUE(reported(problem(text), "case.toml:9: ", {"dx = \"" + text + "\"", "at character"})) << text;
}

TEST(Formula, RefusesAssignmentsAndSeveralValues) {
  auto const problem = [](std::string const& e) {
    return error_lines([&] { formula(FormulaFrame::cartesian, {e, "", ""}); });
  };
  EXPECT_TRUE(reported(problem("x = 3"), "case.toml:9: ", {"single '='", "=="}));
  EXPECT_TRUE(reported(problem("x, y"), "case.toml:9: ", {"2 values"}));
  EXPECT_NO_THROW(formula(FormulaFrame::cartesian, {"x == 3", "x <= 3", "x != 3 && y >= 1"}));
}

TEST(Formula, TellsNamesThatConstantsMayHave) {
  for (std::string const good : {"a", "amplitude_2", "_b", "X"}) EXPECT_TRUE(is_free_formula_name(good)) << good;
  for (std::string const bad : {"", "2a", "x", "theta", "pi", "_pi", "sin", "a-b", "clamp"})
    EXPECT_FALSE(is_free_formula_name(bad)) << bad;
}

}  // namespace
}  // namespace gridmorph::test
