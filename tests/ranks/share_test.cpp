// Ranks move the nodes of their own parts by shares of one plan: together they have what one process moves.
#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/deal_zones.hpp>
#include <gridmorph/mesh/fetch_nodes.hpp>
#include <gridmorph/mesh/gather_coordinates.hpp>
#include <gridmorph/morph/morpher.hpp>
#include <gridmorph/morph/plan_share.hpp>

#include "ranks/drawn_parts.hpp"
#include "ranks/world.hpp"
#include "support/expect_error.hpp"
#include "support/morph_run.hpp"
#include "support/motions.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <optional>

namespace gridmorph::test {
namespace {

/// Where a plan, or a share of it, moves its nodes.
template <class PlanOrShare>
Coordinates moved_by(PlanOrShare const& plan, Coordinates const& baseline) {
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

std::vector<NodeBox> all_zones(Mesh const& mesh) {
  std::vector<NodeBox> out;
  for (int z = 0; z < int(mesh.zones.size()); ++z) out.push_back({z, whole(mesh.zones[z])});
  return out;
}

Coordinates baseline_of(Mesh const& mesh, std::vector<NodeBox> const& boxes) {
  Index n = 0;
  for (NodeBox const& box : boxes) n += box.nodes.size();
  Coordinates out(n);
  n = 0;
  for (NodeBox const& box : boxes)
    for_indices(box.nodes, [&](Index3 const& p) { out.set(n++, mesh.coordinates[mesh.zones[box.zone].node(p)]); });
  return out;
}

struct Moving {
  Mesh mesh;
  Motion rules;
};
/// Near fields that turn, slip surfaces with the redistribution between them, a sector whose parts have a motion in
/// common: all tables that a share has.
std::vector<Moving> moving() {
  std::vector<Moving> out;
  out.push_back({around_a_box(2), motion({rule({"step"}, function_rule(turn_about_z({1.2, 0.6, 0}, 0.1))),
                                          rule({"u_*", "v_*"}, FixedRule{}), rule({"w_*"}, FreeRule{})})});
  Sector const sector;
  Motion turning = motion({rule({"inlet"}, function_rule(turning_waves(sector, 0.02))), rule({"outlet"}, FixedRule{}),
                           rule({"hub", "case"}, SlipRule{SlipRule::Surface::revolution})});
  turning.axis = {sector.origin, sector.axis};
  out.push_back({annulus_sector(sector, 4), turning});
  out.push_back({bricks_with_t_junctions(3), motion({rule({"*"}, function_rule([](Vec3 const& p) {
                                                            return Vec3{-0.1 * p.y, 0.1 * p.x, 0};
                                                          }))})});
  return out;
}

TEST(RanksWithShares, MoveTheirPartsToTheBitsOfOneProcess) {
  auto const ranks = world();
  Random random(8);
  for (auto const& [mesh, rules] : moving()) {
    MorphPlan const plan(mesh, rules);
    Coordinates const expected = moved_by(plan, mesh.coordinates);
    for (Joint const joint : {Joint::none, Joint::plane, Joint::layers}) {
      Distribution const distribution(ranks, mesh, drawn_parts(mesh, ranks->size(), joint, random));
      auto const boxes = boxes_of(distribution.own());
      PlanShare const own = share({}, plan, mesh, boxes);
      Coordinates const moved = moved_by(own, baseline_of(mesh, boxes));
      EXPECT_EQ(different_bits(fetch_nodes(distribution, moved, all_zones(mesh)), expected), 0) << mesh.source;
    }
  }
}

TEST(RanksWithShares, TakeThemFromTheOneThatPlans) {
  auto const ranks = world();
  for (auto const& [lists, rules] : moving()) {
    auto const boxes = deal_zones(lists, ranks->size())[std::size_t(ranks->rank())];
    Coordinates const baseline = baseline_of(lists, boxes);
    // Rank 0 alone has the coordinates of others, and makes the plan.
    Mesh mesh = lists;
    mesh.coordinates = gather_coordinates(ranks, lists, boxes, baseline);
    ASSERT_EQ(mesh.coordinates.size(), ranks->rank() == 0 ? lists.n_nodes() : 0);
    std::optional<MorphPlan> plan;
    if (ranks->rank() == 0) plan.emplace(mesh, rules);
    PlanShare const own = share_out(*ranks, {}, plan ? &*plan : nullptr, plan ? &mesh : nullptr, boxes);
    MorphPlan const everywhere(lists, rules);
    EXPECT_EQ(own.boundary_nodes(), everywhere.boundary_nodes());
    EXPECT_EQ(own.boundary_displacement(), everywhere.boundary_displacement());
    ASSERT_EQ(own.boundary_places().size(), everywhere.boundary_places().size());
    Coordinates const expected = moved_by(everywhere, lists.coordinates), moved = moved_by(own, baseline);
    Index n = 0, others = 0;
    for (NodeBox const& box : boxes)
      for_indices(box.nodes, [&](Index3 const& p) {
        others += same_bits(moved[n++], expected[lists.zones[box.zone].node(p)]) ? 0 : 1;
      });
    EXPECT_EQ(others, 0) << lists.source;
  }
}

TEST(RanksWithShares, RefuseTogether) {
  auto const ranks = world();
  Moving const m = moving().front();
  std::optional<MorphPlan> plan;
  if (ranks->rank() == 0) plan.emplace(m.mesh, m.rules);
  auto const out = [&](std::vector<NodeBox> const& boxes, bool with_mesh = true) {
    (void)share_out(*ranks, {}, plan ? &*plan : nullptr, plan && with_mesh ? &m.mesh : nullptr, boxes);
  };
  auto own = all_zones(m.mesh);
  expect_all_in(message_of<ConfigError>([&] { out(own, false); }), {"rank 0", "null"});
  if (ranks->rank() == ranks->size() - 1) own.front().nodes.end[1] += 3;
  expect_all_in(message_of<ConfigError>([&] { out(own); }), {m.mesh.zones.front().name, "within the zone"});
  auto const missing = [&] {
    std::vector<NodeBox> none;
    (void)gather_coordinates(ranks, m.mesh, none, Coordinates(0));
  };
  expect_all_in(message_of<MeshError>(missing), {m.mesh.zones.front().name});
}

}  // namespace
}  // namespace gridmorph::test
