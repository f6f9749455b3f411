// From a mesh of elements and rules to coordinates in one call: the same bits as step by step.
#include "support/made_bodies.hpp"
#include "support/unstructured_case.hpp"

#include <gridmorph/morph/morph.hpp>

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
}

}  // namespace
}  // namespace gridmorph::test
