// Shocks that go from one place to another.
#include "shock_flow.hpp"
#include "support/expect_error.hpp"
#include "support/motions.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/motion/boundary_motion.hpp>
#include <gridmorph/motion/shock/shock_shift.hpp>

#include <gtest/gtest.h>

namespace gridmorph::test {
namespace {

ShockCells shock_of(Mesh const& mesh, NormalShock const& shock) {
  ShockSearch search;
  search.sensor = ShockSearch::Sensor::jump;
  search.threshold = 0.03;
  return find_shock(mesh, solution_of(mesh, shock), search,
                    std::vector<std::uint8_t>(corners_of_cells(mesh).size(), 1));
}

TEST(ShockShift, TheWayOfAShockIsFoundWellWithinACell) {
  for (Vec3 const& normal : {Vec3{1, 0, 0}, Vec3{0.96, 0.28, 0}, Vec3{0.9, 0, std::sqrt(0.19)}}) {
    Mesh const mesh = box({33, 17, 19}, Shape::straight, 1);  // cells of 1/16
    NormalShock const before{.through = {0.8, 0.5, 0.6}, .normal = normal, .width = 0.08};
    ShockCells const from = shock_of(mesh, before);
    EXPECT_GT(dot(from.direction, normal), 0.9999);
    for (double const way : {0.0, 0.02, -0.1, 0.3}) {
      NormalShock after = before;
      after.through += way * normal;
      ShockShift const shift(from.points, shock_of(mesh, after).points, from.direction, 0.3);
      for (Vec3 const& x : {Vec3{0.8, 0.5, 0.6}, Vec3{0.75, 0.4, 0.5}, Vec3{1.4, 0.5, 0.6}})
        EXPECT_LE(distance(shift.at(x), way * normal), 0.1 / 16) << way;
    }
  }
}

TEST(ShockShift, AShockThatMovesMoreOnOneSideIsFollowedThere) {
  std::vector<ShockPoint> from, to;
  auto const way = [](double y, double z) { return 0.2 + 0.1 * y - 0.05 * z; };
  for (double y = 0; y <= 1.001; y += 0.05)
    for (double z = 0; z <= 2.001; z += 0.05) {
      from.push_back({{0.3 * y, y, z}, 1});
      to.push_back({{0.3 * y + way(y, z), y, z}, 2});
    }
  ShockShift const shift(from, to, {1, 0, 0}, 0.2);
  for (double const y : {0.3, 0.5, 0.7})
    for (double const z : {0.4, 1.0, 1.6}) {
      Vec3 const u = shift.at({7, y, z});
      EXPECT_NEAR(u.x, way(y, z), 1e-3);
      EXPECT_EQ(u.y, 0);
      EXPECT_EQ(u.z, 0);
    }
  // Beyond its ends: as at the nearest of them.
  EXPECT_NEAR(shift.at({0, 0.5, 9}).x, shift.at({0, 0.5, 2}).x, 1e-12);
  EXPECT_NEAR(shift.least(), 0.1, 0.01);
  EXPECT_NEAR(shift.greatest(), 0.3, 0.01);
}

TEST(ShockShift, WhereTheNewShockCoversAPartTheRestGoesAlongWithThatPart) {
  std::vector<ShockPoint> from, to;
  for (double z = 0; z <= 2.001; z += 0.05) {
    from.push_back({{0.5 * z, 0, z}, 1});  // swept
    if (z <= 1) to.push_back({{0.5 * z + 0.25, 0, z}, 1});
  }
  ShockShift const shift(from, to, {1, 0, 0}, 0.2);
  for (double const z : {0.0, 0.4, 1.0, 1.8}) EXPECT_NEAR(shift.at({0.5 * z, 0, z}).x, 0.25, 1e-12);
}

TEST(ShockShift, ShocksThatDoNotLieOverOneAnotherAreAnError) {
  std::vector<ShockPoint> const from{{{0, 0, 0}, 1}, {{0, 0, 1}, 1}}, to{{{0, 0, 4}, 1}};
  expect_all_in(message_of<MotionError>([&] {
                  ShockShift(from, to, {1, 0, 0}, 0.5);
                }),
                {"does not cover the old one within 0.5", "and is 3 from it at best"});
}

TEST(ShockRule, OnTheWallItIsTheWallsMotionAndAwayFromItTheShocks) {
  Mesh const mesh = box({3, 5, 5}, Shape::straight, 1);
  std::vector<ShockPoint> from, to;
  for (double y = 0; y <= 1.001; y += 0.1)
    for (double z = 0; z <= 1.2; z += 0.1) {
      from.push_back({{1, y, z}, 1});
      to.push_back({{1.25, y, z}, 1});
    }
  ShockRule shock;
  shock.of = {"v_min"};
  shock.fade = 0.4;
  shock.share = 0.5;
  shock.shift = std::make_shared<ShockShift const>(from, to, Vec3{1, 0, 0}, 0.3);
  VectorField const wall = [](Vec3 const& p) { return Vec3{0.01 * p.z, 0, 0}; };
  Motion const m = motion({rule({"v_min"}, function_rule(wall)), rule({"u_max"}, shock)});
  BoundaryMotion const moves(mesh, resolve(mesh, m));
  EXPECT_TRUE(moves.is_explicit(1));
  std::vector<Vec3> const at{{1, 0, 0.6}, {1, 0.2, 0.6}, {1, 0.4, 0.6}, {1, 0.9, 0.6}};
  std::vector<Vec3> u(at.size());
  moves.displacement(1, at, u);
  double const free[] = {0, 0.5, 1, 1};
  for (std::size_t n = 0; n < at.size(); ++n) EXPECT_NEAR(u[n].x, 0.006 + free[n] * 0.125, 1e-12) << n;
  EXPECT_EQ(u[0].x, wall(at[0]).x);
  // Without walls nothing fades.
  shock.of.clear();
  BoundaryMotion const loose(mesh, resolve(mesh, motion({rule({"u_max"}, shock)})));
  loose.displacement(0, at, u);
  for (Vec3 const& v : u) EXPECT_NEAR(v.x, 0.125, 1e-12);
  shock.shift = nullptr;
  expect_all_in(message_of<MotionError>(
                    [&] { BoundaryMotion const none(mesh, resolve(mesh, motion({rule({"u_max"}, shock)}))); }),
                {"where the shock goes to"});
}

}  // namespace
}  // namespace gridmorph::test
