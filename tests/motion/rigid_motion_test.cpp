// Rigid motions: composition against steps done by hand, and exactness.
#include <gridmorph/core/error.hpp>
#include <gridmorph/motion/rigid_motion.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace gridmorph {
namespace {

Vec3 random_point(std::mt19937& random) {
  std::uniform_real_distribution<> u(-10, 10);
  double const x = u(random), y = u(random);
  return {x, y, u(random)};
}

void expect_near(Vec3 const& a, Vec3 const& b, double tolerance) { EXPECT_LT(distance(a, b), tolerance); }

TEST(RigidMotion, NothingToDoIsExactlyZero) {
  std::mt19937 random(1);
  RigidRule const rule = make_rigid({});
  for (int n = 0; n < 100; ++n) EXPECT_EQ(displacement(rule, random_point(random)), (Vec3{0, 0, 0}));
}

TEST(RigidMotion, ATranslationDisplacesEveryPointByExactlyThat) {
  std::mt19937 random(2);
  Vec3 const t{0.1, -1.0 / 3, 1e-9};
  RigidRule const rule = make_rigid({.translation = t});
  for (int n = 0; n < 100; ++n) EXPECT_EQ(displacement(rule, random_point(random)), t);
}

TEST(RigidMotion, ScalesThenRotatesThenTranslates) {
  // A quarter turn about the line x = 1, y = 0 along z takes (x, y) to (1 - y, x - 1).
  RigidRule const rule = make_rigid({.scale = {2, 3, 0.5},
                                     .scale_center = {1, 1, 1},
                                     .angle_rad = std::numbers::pi / 2,
                                     .axis = {{1, 0, 0}, {0, 0, 7}},
                                     .translation = {0.25, 0.5, 0.75}});
  std::mt19937 random(3);
  for (int n = 0; n < 100; ++n) {
    Vec3 const p = random_point(random);
    Vec3 const s{2 * (p.x - 1) + 1, 3 * (p.y - 1) + 1, 0.5 * (p.z - 1) + 1};
    Vec3 const r{1 - s.y, s.x - 1, s.z};
    expect_near(p + displacement(rule, p), r + Vec3{0.25, 0.5, 0.75}, 1e-13);
  }
}

TEST(RigidMotion, ARotationLeavesItsAxisInPlaceAndDistancesAlone) {
  Axis const axis{{1, 2, 3}, {1, 1, 1}};
  RigidRule const rule = make_rigid({.angle_rad = 0.3, .axis = axis});
  std::mt19937 random(4);
  for (int n = 0; n < 100; ++n) {
    Vec3 const on_axis = axis.origin + double(n) * axis.direction;
    expect_near(displacement(rule, on_axis), {0, 0, 0}, 1e-12);
    Vec3 const p = random_point(random), q = random_point(random);
    EXPECT_NEAR(distance(p + displacement(rule, p), q + displacement(rule, q)), distance(p, q), 1e-13);
  }
}

TEST(RigidMotion, SharesFollowOneAnotherOnTheWayOfTheParameters) {
  Axis const axis{{1, 2, 3}, {1, -1, 2}};
  std::vector<RigidSteps> const turn{{.angle_rad = 1.2, .axis = axis}},
      stretch{{.scale = {2, 0.5, 1.5}, .scale_center = {3, 1, 0}}};
  std::mt19937 random(5);
  for (int n = 0; n < 50; ++n) {
    Vec3 const p = random_point(random);
    expect_near(displacement(make_rigid_steps(turn, 0.25), p),
                displacement(make_rigid({.angle_rad = 0.3, .axis = axis}), p), 1e-14);
    for (auto const& steps : {turn, stretch}) {
      Vec3 q = p;
      for (double const share : {0.3, 0.9, -0.2}) q = q + displacement(make_rigid_steps(steps, share), q);
      expect_near(q, p + displacement(make_rigid_steps(steps), p), 1e-13);
      EXPECT_EQ(displacement(make_rigid_steps(steps, 0), p), (Vec3{0, 0, 0}));
    }
    std::vector<RigidSteps> const both{{.angle_rad = 1.2, .axis = axis}, {.translation = {1, 2, 3}}};
    expect_near(displacement(make_rigid_steps(both, 0.5), p),
                displacement(make_rigid({.angle_rad = 0.6, .axis = axis, .translation = {0.5, 1, 1.5}}), p), 1e-14);
  }
  EXPECT_THROW(make_rigid_steps(std::vector<RigidSteps>{{.scale = {-1, 1, 1}}}, 0.5), MotionError);
}

TEST(RigidMotion, RefusesWhatIsNoMotion) {
  EXPECT_THROW(make_rigid({.scale = {1, 0, 1}}), MotionError);
  EXPECT_THROW(make_rigid({.angle_rad = 1, .axis = {{0, 0, 0}, {0, 0, 0}}}), MotionError);
  EXPECT_THROW(make_rigid({.translation = {0, std::nan(""), 0}}), MotionError);
}

}  // namespace
}  // namespace gridmorph
