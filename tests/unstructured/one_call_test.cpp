// From a mesh of elements and rules to coordinates in one call: the same bits as step by step.
#include "support/made_bodies.hpp"
#include "support/unstructured_case.hpp"

#include <gridmorph/morph/morph.hpp>
#include <gridmorph/morph/prediction.hpp>
#include <gridmorph/motion/rigid_motion.hpp>

#include <gtest/gtest.h>

namespace gridmorph::test {
namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;

TEST(OneCall, MorphsAsStepByStep) {
  UnstructuredCase const c(box_around(
      {12, 12, 12}, [](Vec3 const& x) { return x.x > 4 && x.x < 8 && x.y > 4 && x.y < 8 && x.z > 4 && x.z < 8; }));
  Motion const m = motion_of({rule_for({"body"}, RigidRule{{}, {1, 0.5, 0}})});
  auto const expected = c.morph(m);
  Coordinates const moved = morph(Exec(), c.mesh, m);
  Index different = 0;
  for (Index n = 0; n < c.mesh.n_nodes(); ++n) different += moved[n] == expected.x[n] ? 0 : 1;
  EXPECT_EQ(different, 0);
  MorphPlan const plan(c.mesh, m);
  auto const& known = expected.prepared.plan.known;
  EXPECT_EQ(plan.boundary_nodes(), std::vector<Index>(known.begin(), known.end()));
  EXPECT_EQ(plan.n_nodes(), c.mesh.n_nodes());
  EXPECT_EQ(predict(HostInstance(), IndexedMesh(c.mesh), plan, plan.boundary_displacement(), {1}).all.cells,
            c.mesh.n_elements());
}

TEST(OneCall, ACallerPrescribesTheDisplacementOfAWall) {
  UnstructuredCase const c(box_around(
      {12, 12, 12}, [](Vec3 const& x) { return x.x > 4 && x.x < 8 && x.y > 4 && x.y < 8 && x.z > 4 && x.z < 8; }));
  MorphPlan const plan(c.mesh, motion_of({rule_for({"body"}, PrescribedRule{})}));
  RigidTransform const about = rotation_about({6, 6, 6}, {0, 0, 1}, 0.1);
  RigidRule const turn{about.rotation, about.translation};
  std::vector<Vec3> given = plan.boundary_displacement();
  auto const nodes = plan.boundary_nodes();
  Index prescribed = 0;
  for (BoundaryPlace const& place : plan.boundary_places()) {
    auto const n = std::size_t(place.boundary_node);
    EXPECT_EQ(c.mesh.zones[place.zone].first_node + place.index[0], nodes[n]);
    EXPECT_EQ(given[n], Vec3{});
    if (c.mesh.patches[place.patch].name != "body") continue;
    ++prescribed;
    given[n] = displacement(turn, c.mesh.coordinates[nodes[n]]);
  }
  EXPECT_GT(prescribed, 0);
  Coordinates const expected = morph(Exec(), c.mesh, motion_of({rule_for({"body"}, turn)}));
  Coordinates const moved(c.mesh.n_nodes());
  Kokkos::View<Vec3*, Kokkos::HostSpace> const boundary(given.data(), given.size());
  Morpher<Exec>(Exec(), plan, c.mesh.coordinates).positions(Exec(), boundary, moved);
  Exec().fence();
  for (std::size_t n = 0; n < nodes.size(); ++n) EXPECT_EQ(moved[nodes[n]], expected[nodes[n]]);
  EXPECT_EQ(c.inverted(moved), 0);
}

}  // namespace
}  // namespace gridmorph::test
