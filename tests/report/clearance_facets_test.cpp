// Walls as the meshes of either kind have them: their facets know the side which the mesh is on.
#include "support/plane_cascade.hpp"
#include "support/unstructured_case.hpp"

#include <gridmorph/boundary/inward_facets.hpp>
#include <gridmorph/boundary/periodic_copies.hpp>
#include <gridmorph/mesh/as_hexahedra.hpp>
#include <gridmorph/report/tip_clearance.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace gridmorph::test {
namespace {

/// Distance in the plane from the sides of the blades above and below the passage, at many places.
double from_blades(Vec3 const& p) {
  double best = std::numeric_limits<double>::infinity();
  constexpr int n = 20'000;
  for (int k = 0; k <= n; ++k) {
    double const x = double(k) / n, camber = 0.3 * std::sin(1.5 * x), half = 0.2 * x * (1 - x);
    for (double const y : {camber + half, camber + plane_cascade_pitch - half})
      best = std::min(best, std::hypot(p.x - x, p.y - y));
  }
  return best;
}

SurfaceWall blade_of(Boundary const& boundary, Coordinates const& at) {
  return SurfaceWall(InwardFacets(boundary, boundary.select_patches({"blade"})).at(at));
}

void expect_distances(SurfaceWall const& wall) {
  for (double const x : {0.3, 0.5, 0.7})
    for (double const w : {0.05, 0.4, 0.8}) {
      double const camber = 0.3 * std::sin(1.5 * x), half = 0.2 * x * (1 - x);
      Vec3 const inside{x, camber + half + w * (plane_cascade_pitch - 2 * half), 0};
      EXPECT_NEAR(wall.distance(inside), from_blades(inside), 1e-5) << x << " " << w;
      Vec3 const in_the_blade{x, camber + half - 0.01, 0},
          in_the_next{x, camber + plane_cascade_pitch - half + 0.01, 0};
      EXPECT_NEAR(wall.distance(in_the_blade), -from_blades(in_the_blade), 1e-5) << x;
      EXPECT_NEAR(wall.distance(in_the_next), -from_blades(in_the_next), 1e-5) << x;
    }
}

TEST(ClearanceFacets, OfBlocksAndElementsLookIntoTheMesh) {
  Periodic const sides = periodic_translation({0, plane_cascade_pitch, 0});
  Mesh const blocks = cascade_between_planes(straight_section(), sides, 0.3);
  expect_distances(blade_of(Boundary(blocks), blocks.coordinates));
  UnstructuredCase const elements(as_hexahedra(blocks));
  expect_distances(
      blade_of(Boundary(elements.mesh, elements.topology, elements.face_patches), elements.mesh.coordinates));
}

TEST(ClearanceFacets, OfAPlaneMeshAreStripsAcrossIt) {
  UnstructuredCase const plane(plane_cascade(straight_section(), periodic_translation({0, plane_cascade_pitch, 0})));
  Boundary const boundary(plane.mesh, plane.topology, plane.face_patches);
  expect_distances(blade_of(boundary, plane.mesh.coordinates));
}

TEST(ClearanceFacets, GoWhereTheMeshGoes) {
  Mesh const mesh = cascade_between_planes(straight_section(), periodic_translation({0, plane_cascade_pitch, 0}), 0.3);
  auto const turn = rotation_about({0.2, 0.1, 0}, {1, -1, 3}, 0.4);
  Coordinates moved(mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) moved.set(n, turn(mesh.coordinates[n]));
  Boundary const boundary(mesh);
  SurfaceWall const before = blade_of(boundary, mesh.coordinates), after = blade_of(boundary, moved);
  for (Vec3 const p : {Vec3{0.3, 0.4, 0.1}, Vec3{0.6, 0.28, 0.2}})
    EXPECT_NEAR(after.distance(turn(p)), before.distance(p), 1e-12);
}

// The two rows of a stage have pitches of their own: the wall of the one has no copy where only the other repeats.
TEST(ClearanceFacets, OfTwoRowsAreRepeatedByThePitchOfTheirOwn) {
  Mesh const one = cascade_between_planes(straight_section(), periodic_translation({0, plane_cascade_pitch, 0}), 0.3);
  Mesh both = one;
  both.add_zone("second", one.n_nodes());
  both.zones[1].extent = one.zones[0].extent;
  both.coordinates = Coordinates(2 * one.n_nodes());
  for (Index n = 0; n < one.n_nodes(); ++n) {
    both.coordinates.set(n, one.coordinates[n]);
    both.coordinates.set(one.n_nodes() + n, one.coordinates[n] + Vec3{10, 0, 0});
  }
  for (Patch patch : one.patches) {
    patch.zone = 1;
    both.patches.push_back(patch);
  }
  for (Interface1to1 side : one.interfaces) {
    side.zone = side.donor_zone = 1;
    both.interfaces.push_back(side);
  }
  Boundary const boundary(both);
  auto const rows = patches_by_row(boundary, select_patches(both, {"case"}));
  ASSERT_EQ(rows.size(), 2U);
  for (PatchesOfRow const& row : rows) {
    EXPECT_EQ(row.patches.size(), 1U);
    ASSERT_EQ(row.copies.size(), 2U) << "the same pitch up and down, though there are two sides, each stored twice";
    EXPECT_NEAR(std::abs(row.copies[0].translation.y), plane_cascade_pitch, 1e-12);
    EXPECT_NEAR(row.copies[0].translation.y + row.copies[1].translation.y, 0, 1e-12);
  }
}

}  // namespace
}  // namespace gridmorph::test
