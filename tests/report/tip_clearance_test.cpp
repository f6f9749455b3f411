// Clearances of tips to walls of known shape.
#include "support/expect_error.hpp"

#include <gridmorph/report/tip_clearance.hpp>

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

namespace gridmorph::test {
namespace {

Axis const axis{{0.1, -0.2, 0.3}, {0, 0, 2}};

Vec3 place(double axial, double radius, double angle) {
  return axis.origin + Vec3{radius * std::cos(angle), radius * std::sin(angle), axial};
}

std::shared_ptr<RevolutionWall const> cylinder() {
  std::vector<Vec3> out;
  for (int i = 0; i <= 40; ++i)
    for (double angle = 0; angle < 0.3; angle += 0.05) out.push_back(place(i / 40.0, 0.9, angle));
  return RevolutionWall::through(axis, out);
}

TEST(TipClearance, SaysTheSmallestWithItsPlaceAndTheMean) {
  auto const wall = cylinder();
  ASSERT_TRUE(wall);
  std::vector<Vec3> const tip{place(0.2, 0.89, 0), place(0.4, 0.895, 0.1), place(0.6, 0.87, 0.2)};
  Clearance const inside = wall->of(tip, 1);
  EXPECT_NEAR(inside.smallest, 0.005, 1e-15);
  EXPECT_NEAR(inside.mean, (0.01 + 0.005 + 0.03) / 3, 1e-15);
  EXPECT_TRUE(inside.at == tip[1]);
  Clearance const outside = wall->of(tip, -1);  // vanes that end at a hub rub there
  EXPECT_NEAR(outside.smallest, -0.03, 1e-15);
  std::string const table = clearance_table({{"blade 1", 3, inside, outside, inside, 0}});
  expect_all_in(table, {"before", "by the rule", "in the mesh", "blade 1", "0.005", "-0.03", "rubs", "meridional"});
  auto const json = clearance_json({{"blade 1", 3, inside, {}, outside, 0}});
  EXPECT_EQ(json[0]["nodes"], 3);
  EXPECT_TRUE(json[0]["by_rule"].is_null());
  EXPECT_NEAR(double(json[0]["after"]["smallest"]), -0.03, 1e-15);
  EXPECT_EQ(json[0]["distance"], "meridional");
  TipClearance const of_surface{"blade 1", 3, inside, outside, inside, 0, ClearanceMeasure::surface};
  expect_all_in(clearance_table({of_surface}), {"distance", "surface"});
  expect_all_in(clearance_steps_table({{of_surface}}), {"distance", "surface"});
  EXPECT_EQ(clearance_json({of_surface})[0]["distance"], "surface");
}

TEST(TipClearance, FindsTheEndOfABladeNextToTheWall) {
  auto const wall = cylinder();
  ASSERT_TRUE(wall);
  std::vector<Vec3> blade;
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j <= 10; ++j) blade.push_back(place(0.3 + 0.05 * i, 0.5 + 0.039 * j, 0));
  auto const tip = tip_nodes(*wall, blade, 0.05);
  ASSERT_EQ(tip.size(), 5U);
  for (std::size_t const n : tip) EXPECT_NEAR(wall->distance(blade[n]), 0.01, 1e-14);
  EXPECT_EQ(tip_nodes(*wall, blade, 0.15).size(), 10U);
  EXPECT_EQ(tip_nodes(*wall, blade, 1).size(), blade.size());
}

}  // namespace
}  // namespace gridmorph::test
