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

}  // namespace
}  // namespace gridmorph::test
