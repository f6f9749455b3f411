// Clearances of tips to walls of known shape.
#include "support/expect_error.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/report/tip_clearance.hpp>

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace gridmorph::test {
namespace {

Axis const axis{{0.1, -0.2, 0.3}, {0, 0, 2}};

Vec3 place(double axial, double radius, double angle) {
  return axis.origin + Vec3{radius * std::cos(angle), radius * std::sin(angle), axial};
}

std::vector<Vec3> wall(std::function<double(double)> const& radius, int stations = 40) {
  std::vector<Vec3> out;
  for (int i = 0; i <= stations; ++i)
    for (double angle = 0; angle < 0.3; angle += 0.05)
      out.push_back(place(double(i) / stations, radius(double(i) / stations), angle));
  return out;
}

TEST(TipClearance, IsTheRadialGapUnderACylinderAndTheShortestOneUnderACone) {
  ClearanceWall const cylinder(axis, wall([](double) { return 0.9; }));
  EXPECT_LT(cylinder.scatter(), 1e-15);
  double const slope = 0.5;
  ClearanceWall const cone(axis, wall([&](double a) { return 0.9 + slope * a; }));
  for (double const axial : {0.213, 0.5, 0.77})
    for (double const gap : {0.02, 0.001, -0.004}) {
      EXPECT_NEAR(cylinder.distance(place(axial, 0.9 - gap, 2.1)), gap, 1e-15);
      EXPECT_NEAR(cone.distance(place(axial, 0.9 + slope * axial - gap, 2.1)), gap / std::hypot(1, slope), 1e-15);
    }
}

TEST(TipClearance, SaysTheSmallestWithItsPlaceAndTheMean) {
  ClearanceWall const cylinder(axis, wall([](double) { return 0.9; }));
  std::vector<Vec3> const tip{place(0.2, 0.89, 0), place(0.4, 0.895, 0.1), place(0.6, 0.87, 0.2)};
  Clearance const inside = cylinder.of(tip, 1);
  EXPECT_NEAR(inside.smallest, 0.005, 1e-15);
  EXPECT_NEAR(inside.mean, (0.01 + 0.005 + 0.03) / 3, 1e-15);
  EXPECT_TRUE(inside.at == tip[1]);
  Clearance const outside = cylinder.of(tip, -1);  // vanes that end at a hub rub there
  EXPECT_NEAR(outside.smallest, -0.03, 1e-15);
  std::string const table = clearance_table({{"blade 1", 3, inside, outside, inside, 0}});
  expect_all_in(table, {"before", "by the rule", "in the mesh", "blade 1", "0.005", "-0.03", "rubs"});
  auto const json = clearance_json({{"blade 1", 3, inside, {}, outside, 0}});
  EXPECT_EQ(json[0]["nodes"], 3);
  EXPECT_TRUE(json[0]["by_rule"].is_null());
  EXPECT_NEAR(double(json[0]["after"]["smallest"]), -0.03, 1e-15);
}

TEST(TipClearance, FindsTheEndOfABladeNextToTheWall) {
  ClearanceWall const cylinder(axis, wall([](double) { return 0.9; }));
  std::vector<Vec3> blade;
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j <= 10; ++j) blade.push_back(place(0.3 + 0.05 * i, 0.5 + 0.039 * j, 0));
  auto const tip = tip_nodes(cylinder, blade, 0.05);
  ASSERT_EQ(tip.size(), 5U);
  for (std::size_t const n : tip) EXPECT_NEAR(cylinder.distance(blade[n]), 0.01, 1e-14);
  EXPECT_EQ(tip_nodes(cylinder, blade, 0.15).size(), 10U);
  EXPECT_EQ(tip_nodes(cylinder, blade, 1).size(), blade.size());
}

TEST(TipClearance, NeedsAWallOfRevolution) {
  std::vector<Vec3> flat;
  for (double x = 0; x < 1; x += 0.1)
    for (double y = 0; y < 1; y += 0.1) flat.push_back({x, y, 0.5 + 0.1 * x});
  expect_all_in(message_of<MotionError>([&] { ClearanceWall(axis, flat); }), {"clearance", "revolution"});
}

}  // namespace
}  // namespace gridmorph::test
