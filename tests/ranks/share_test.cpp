// Each rank plans the whole mesh and moves the nodes of its own parts: together they have what one process moves.
#include <gridmorph/mesh/fetch_nodes.hpp>
#include <gridmorph/morph/morph.hpp>
#include <gridmorph/morph/morpher.hpp>

#include "ranks/drawn_parts.hpp"
#include "ranks/world.hpp"
#include "support/morph_run.hpp"
#include "support/motions.hpp"

#include <gtest/gtest.h>

namespace gridmorph::test {
namespace {

/// Where a plan, or a share of it, moves its nodes.
Coordinates moved_by(MorphPlan const& plan, Coordinates const& baseline) {
  Kokkos::DefaultHostExecutionSpace const exec;
  Coordinates out(baseline.size());
  Morpher<Kokkos::DefaultHostExecutionSpace> const morpher(exec, plan, baseline);
  morpher.positions(exec, upload<Kokkos::HostSpace>(plan.boundary_displacement()), out);
  exec.fence();
  return out;
}

std::vector<NodeBox> boxes_of(std::span<Part const> parts) {
  std::vector<NodeBox> out;
  for (Part const& part : parts) out.push_back({part.zone, part.nodes});
  return out;
}

Coordinates baseline_of(Mesh const& mesh, Distribution const& distribution) {
  Coordinates out(distribution.n_nodes());
  for (Part const& part : distribution.own())
    for_indices(part.nodes,
                [&](Index3 const& p) { out.set(part.node(p), mesh.coordinates[mesh.zones[part.zone].node(p)]); });
  return out;
}

TEST(RanksWithShares, MoveTheirPartsToTheBitsOfOneProcess) {
  auto const ranks = world();
  Random random(8);
  Mesh const mesh = around_a_box(2);
  MorphPlan const plan(mesh, motion({rule({"step"}, function_rule(turn_about_z({1.2, 0.6, 0}, 0.1))),
                                     rule({"u_*", "v_*"}, FixedRule{}), rule({"w_*"}, FreeRule{})}));
  Coordinates const expected = moved_by(plan, mesh.coordinates);
  std::vector<NodeBox> everything;
  for (int z = 0; z < int(mesh.zones.size()); ++z) everything.push_back({z, whole(mesh.zones[z])});
  for (Joint const joint : {Joint::none, Joint::plane, Joint::layers}) {
    Distribution const distribution(ranks, mesh, drawn_parts(mesh, ranks->size(), joint, random));
    MorphPlan const share = plan.share({}, mesh, boxes_of(distribution.own()));
    Coordinates const own = moved_by(share, baseline_of(mesh, distribution));
    EXPECT_EQ(different_bits(fetch_nodes(distribution, own, everything), expected), 0);
  }
}

}  // namespace
}  // namespace gridmorph::test
