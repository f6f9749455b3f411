// Blocks cut where the user says.
#include <gridmorph/core/error.hpp>
#include <gridmorph/plan/block_graph.hpp>

#include "support/expect_error.hpp"
#include "support/morph_run.hpp"
#include "support/motions.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace gridmorph::test {
namespace {

/// A box whose faces bend, planned with cuts.
PreparedMorph planned(std::vector<BlockCut> cuts) {
  PlanOptions options = without_near_field();
  options.volume.cuts = std::move(cuts);
  return prepare(HostInstance(), box({9, 7, 5}, Shape::curved, 1),
                 motion({rule({"u_*", "v_*", "w_*"}, function_rule(waves(0.02)))}), options);
}

TEST(Cuts, DivideBlocksWhereTheySay) {
  EXPECT_EQ(block_graph(planned({})).blocks.size(), 1U);
  std::string const zone = planned({}).mesh.zones.front().name;
  EXPECT_EQ(block_graph(planned({{zone, 0, 4}})).blocks.size(), 2U);
  EXPECT_EQ(block_graph(planned({{zone, 0, 4}, {zone, 0, 4}, {zone, 2, 2}})).blocks.size(), 4U);
}

TEST(Cuts, LeaveTheBoundaryAsItIsAndMoveEveryNode) {
  std::string const zone = planned({}).mesh.zones.front().name;
  PreparedMorph const whole = planned({}), cut = planned({{zone, 1, 3}});
  auto const run = [](PreparedMorph const& p) {
    return run_plan(Kokkos::DefaultHostExecutionSpace(), p.mesh, p.plan(), p.boundary_displacement()).position;
  };
  Coordinates const a = run(whole), b = run(cut);
  Zone const& z = whole.mesh.zones.front();
  for (Index n = 0; n < a.size(); ++n) ASSERT_TRUE(std::isfinite(b[n].x + b[n].y + b[n].z)) << n;
  for (int k = 0; k < z.extent[2]; ++k)
    for (int j = 0; j < z.extent[1]; ++j)
      for (int const i : {0, z.extent[0] - 1}) {
        Index const n = z.node({i, j, k});
        EXPECT_LE(distance(a[n], whole.mesh.coordinates[n] + waves(0.02)(whole.mesh.coordinates[n])), 1e-15);
        EXPECT_EQ(a[n], b[n]);
      }
}

TEST(Cuts, ThatAreNotInsideAZoneAreAllNamed) {
  std::string const zone = planned({}).mesh.zones.front().name;
  expect_all_in(message_of<PlanError>([&] {
                  planned({{"wing", 0, 3, "case.toml:4"}, {zone, 0, 8}, {zone, 1, 0}});
                }),
                {"cut at i = 4 of zone 'wing' (case.toml:4)", "there is no such zone", "cut at i = 9", "2 to 8",
                 "cut at j = 1", "2 to 6"});
}

}  // namespace
}  // namespace gridmorph::test
