// From mesh and rules to coordinates in one call: the same bits as step by step.
#include "support/mesh_builders.hpp"
#include "support/morph_run.hpp"
#include "support/motions.hpp"

#include <gridmorph/morph/morph.hpp>

#include <gtest/gtest.h>

namespace gridmorph::test {
namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;

TEST(OneCall, MorphsABlockMeshAsStepByStep) {
  Sector const shape;
  Motion m = motion({rule({"inlet", "outlet"}, function_rule(turning_waves(shape, 0.05))),
                     rule({"hub", "case"}, SlipRule{SlipRule::Surface::revolution})});
  m.axis = {shape.origin, shape.axis};
  Mesh const mesh = annulus_sector({}, 1);
  std::size_t const n_patches = mesh.patches.size();
  Outcome const expected = morph(annulus_sector({}, 1), m);
  Coordinates const moved = gridmorph::morph(Exec(), mesh, m);
  EXPECT_EQ(different_bits(moved, expected.morphed.position), 0);
  EXPECT_EQ(different_bits(mesh.coordinates, expected.mesh.coordinates), 0) << "the baseline is left alone";
  EXPECT_EQ(mesh.patches.size(), n_patches);

  MorphPlan const plan(mesh, m);
  EXPECT_EQ(plan.n_nodes(), mesh.n_nodes());
  EXPECT_EQ(plan.boundary_nodes(), expected.plan().boundary_nodes);
  EXPECT_EQ(plan.boundary_displacement().size(), expected.boundary.size());
  Coordinates const again(mesh.n_nodes());
  Morpher<Exec>(Exec(), plan, mesh.coordinates).positions(Exec(), upload<Kokkos::HostSpace>(expected.boundary), again);
  Exec().fence();
  EXPECT_EQ(different_bits(again, moved), 0);
}

// A solver moves the inlet; hub and case are turned by a rule that would contradict any value of a rule beside it.
TEST(OneCall, ACallerPrescribesTheDisplacementOfAPatch) {
  Sector const shape;
  Mesh const mesh = annulus_sector({}, 1);
  RigidTransform const about = rotation_about(shape.origin, shape.axis, 0.02);
  RigidRule const turn{about.rotation, about.translation};
  Motion m = motion({rule({"inlet"}, PrescribedRule{}), rule({"outlet", "hub", "case"}, turn)});
  m.axis = {shape.origin, shape.axis};
  MorphPlan const plan(mesh, m);
  std::vector<Index> const nodes = plan.boundary_nodes();
  std::vector<Vec3> given = plan.boundary_displacement();
  auto const push = [&](Vec3 const& x) { return (0.01 * (1 + norm(x - shape.origin))) * shape.axis; };
  std::size_t on_inlet = 0, alone = 0;
  auto const places = plan.boundary_places();
  auto const is_inlet = [&](BoundaryPlace const& place) {
    return mesh.patches[place.patch].name.find("inlet") != std::string::npos;
  };
  std::vector<char> has_rule(nodes.size(), 0);
  for (BoundaryPlace const& place : places)
    if (!is_inlet(place)) has_rule[place.boundary_node] = 1;
  for (BoundaryPlace const& place : places) {
    Zone const& zone = mesh.zones[place.zone];
    auto const n = std::size_t(place.boundary_node);
    Vec3 const x = mesh.coordinates[zone.node(place.index)];
    if (place.rotation * Vec3{1, 2, 3} == Vec3{1, 2, 3}) {
      EXPECT_LT(distance(x, mesh.coordinates[nodes[n]]), 1e-12);
    }
    if (!is_inlet(place)) continue;
    EXPECT_TRUE(mesh.patches[place.patch].range.contains(place.index));
    ++on_inlet;
    if (has_rule[n] == 0) {
      ++alone;
      EXPECT_EQ(plan.boundary_displacement()[n], Vec3{}) << "left to the caller";
    } else {
      EXPECT_FALSE(plan.boundary_displacement()[n] == Vec3{}) << "the rule beside it";
    }
    given[n] = transpose(place.rotation) * push(x);
  }
  EXPECT_GT(alone, 0u);
  EXPECT_GT(on_inlet, alone);
  Coordinates const moved(mesh.n_nodes());
  Morpher<Exec>(Exec(), plan, mesh.coordinates).positions(Exec(), upload<Kokkos::HostSpace>(given), moved);
  Exec().fence();
  for (std::size_t n = 0; n < nodes.size(); ++n)
    EXPECT_EQ(moved[nodes[n]], mesh.coordinates[nodes[n]] + given[n]) << describe_node(mesh, nodes[n]);
  for (BoundaryPlace const& place : places) {
    if (!is_inlet(place)) continue;
    Index const node = mesh.zones[place.zone].node(place.index);
    EXPECT_LT(distance(moved[node], mesh.coordinates[node] + push(mesh.coordinates[node])), 1e-12);
  }
}

}  // namespace
}  // namespace gridmorph::test
