// Near fields that get in each other's way.
#include "support/morph_run.hpp"
#include "support/motions.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace gridmorph::test {
namespace {

BoundaryLayer layers_at(std::string const& wall, int n) {
  return {{wall}, BoundaryLayer::Extent::layers, n, 0, BoundaryLayer::Mode::translate};
}

/// A straight box whose two u faces are walls, 8 cells apart: u_min moves, u_max stays, the rest is free.
Outcome morph_between_walls(int layers_of_moving, int layers_of_fixed) {
  PlanOptions options;
  options.boundary_layers = {layers_at("u_min", layers_of_moving), layers_at("u_max", layers_of_fixed)};
  return morph(box({9, 4, 5}, Shape::straight, 1),
               motion({rule({"u_min"}, function_rule([](Vec3 const&) {
                              return Vec3{0, 0.25, 0.5};
                            })),
                       rule({"u_max"}, FixedRule{}), rule({"v_min", "v_max", "w_min", "w_max"}, FreeRule{})}),
               options);
}

bool notes_mention(Outcome const& r, std::string_view word) {
  auto const& notes = r.plan().notes;
  return std::any_of(notes.begin(), notes.end(), [&](auto const& n) { return n.find(word) != std::string::npos; });
}

TEST(NearField, TwoWithRoomBetweenThemAreBothRigid) {
  Outcome const r = morph_between_walls(3, 3);
  Zone const& zone = r.mesh.zones[0];
  for (int i : {0, 1, 2, 3}) EXPECT_EQ(r.u(zone.node({i, 1, 2})), (Vec3{0, 0.25, 0.5}));
  for (int i : {5, 6, 7, 8}) EXPECT_EQ(r.u(zone.node({i, 1, 2})), Vec3{});
  EXPECT_FALSE(notes_mention(r, "touches"));
}

TEST(NearField, WhereTwoTouchTheLaterOneIsInterpolatedAndTheNotesSaySo) {
  Outcome const r = morph_between_walls(4, 4);
  Zone const& zone = r.mesh.zones[0];
  EXPECT_TRUE(notes_mention(r, "touches"));
  for (int k = 0; k < 5; ++k)
    for (int j = 0; j < 4; ++j) {
      for (int i = 0; i <= 4; ++i) EXPECT_EQ(r.u(zone.node({i, j, k})), (Vec3{0, 0.25, 0.5}));
      EXPECT_EQ(r.u(zone.node({8, j, k})), Vec3{});
      double const length =
          distance(r.mesh.coordinates[zone.node({4, j, k})], r.mesh.coordinates[zone.node({8, j, k})]);
      for (int i = 5; i < 8; ++i) {
        double const left =
            distance(r.mesh.coordinates[zone.node({i, j, k})], r.mesh.coordinates[zone.node({8, j, k})]) / length;
        EXPECT_LE(distance(r.u(zone.node({i, j, k})), left * Vec3{0, 0.25, 0.5}), 1e-14) << i << " " << j << " " << k;
      }
    }
}

}  // namespace
}  // namespace gridmorph::test
