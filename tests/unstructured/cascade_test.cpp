// A real cascade of elements: its blade and those behind its periodic sides.
#include "io/io_support.hpp"
#include "support/transpose_check.hpp"
#include "support/unstructured_case.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/io/mesh_io.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gridmorph::test {
namespace {

TEST(Cascade, ItsBladeTurnsBetweenNeighboursThatTurnWithIt) {
  // When the sides stood still, 0.17 of 0.22 was left of the smallest scaled Jacobian after 5 degrees.
  constexpr double degrees = std::numbers::pi / 180;
  UnstructuredCase const c(read_mesh(shared_mesh("mesh_vki_turbine.su2")));
  PlanOptions options;
  options.boundary_layers.push_back(
      {.walls = {"airfoil"}, .extent = BoundaryLayer::Extent::thickness, .thickness = 1e-3});
  double const before = c.quality(c.mesh.coordinates)[Measure::minimum_angle_deg].min;
  for (double const angle : {5.0, -5.0, 10.0}) {
    auto const turned = rotation_about({0.018, -0.02, 0}, {0, 0, 1}, angle * degrees);
    auto const m = c.morph(motion_of({rule_for({"airfoil"}, rotation({0.018, -0.02, 0}, {0, 0, 1}, angle * degrees)),
                                      rule_for({"periodic_*"}, FreeRule{})}),
                           options);
    auto const& bodies = m.prepared.plan.turns_of_bodies;
    ASSERT_EQ(bodies.size(), 1);
    ASSERT_EQ(bodies.images.size(), 7u) << "three passages on each side";
    EXPECT_EQ(c.inverted(m.x), 0);
    EXPECT_GT(c.quality(m.x)[Measure::minimum_angle_deg].min, (angle < 10 ? 0.9 : 0.6) * before) << angle;
    for (Index32 const n : m.prepared.plan.columns.node)
      EXPECT_LT(distance(m.x[n], turned(c.mesh.coordinates[n])), 1e-12);
    auto const& images = m.prepared.boundary.images;
    ASSERT_GT(images.size(), 50u);
    double moves = 0, apart = 0;
    auto const n_nodes = std::size_t(c.mesh.n_nodes());
    for (auto const& image : images) {
      Vec3 const u = m.x[image.node] - c.mesh.coordinates[image.node];
      EXPECT_LT(distance(u, m.x[image.owner] - c.mesh.coordinates[image.owner]), 1e-15);
      moves = std::max(moves, norm(u));
      double sums[2] = {0, 0};
      for (std::size_t k = 0; k < bodies.images.size(); ++k) {
        sums[0] += bodies.share[k * n_nodes + std::size_t(image.node)];
        sums[1] += bodies.share[k * n_nodes + std::size_t(image.owner)];
      }
      apart = std::max(apart, std::abs(sums[0] - sums[1]));
    }
    EXPECT_GT(moves, 1e-4) << "the sides of the passage turn too";
    EXPECT_LT(apart, 0.02) << "shares are those of the infinite row, nearly";
  }
}

TEST(Cascade, ItsVelocitiesAreThoseOfDifferences) {
  using Exec = UnstructuredCase::Host;
  UnstructuredCase const c(read_mesh(shared_mesh("mesh_vki_turbine.su2")));
  auto const prepared =
      prepare(c.mesh, c.topology, c.face_patches,
              motion_of({rule_for({"airfoil"}, rotation({0.018, -0.02, 0}, {0, 0, 1}, std::numbers::pi / 18)),
                         rule_for({"periodic_*"}, FreeRule{})}),
              PlanOptions{});
  ASSERT_EQ(prepared.plan.turns_of_bodies.images.size(), 7u);
  auto const morpher = MorpherAccess::of(Exec(), prepared.plan, c.mesh.coordinates, {1, true});
  auto const view = [](std::vector<Vec3> const& v) {
    return Kokkos::View<Vec3 const*, Kokkos::HostSpace>(v.data(), v.size());
  };
  std::vector<Vec3> const at = prepared.boundary_displacement();
  std::vector<Vec3> rate, sides[2];
  constexpr double h = 1e-5;
  for (std::size_t k = 0; k < at.size(); ++k) {
    Vec3 const x = c.mesh.coordinates[prepared.plan.known[k]];
    // Turns on, shifts and bends; inlet and outlet stand.
    bool const stands = norm(at[k]) == 0;
    rate.push_back(stands ? Vec3{} : Vec3{-x.y + 0.01, x.x + 5 * x.x * x.x, 0});
    sides[0].push_back(at[k] - h * rate[k]);
    sides[1].push_back(at[k] + h * rate[k]);
  }
  Coordinates v(c.mesh.n_nodes()), u[2]{Coordinates(c.mesh.n_nodes()), Coordinates(c.mesh.n_nodes())};
  morpher.velocities(Exec(), view(at), view(rate), v);
  for (int s = 0; s < 2; ++s) morpher.displacements(Exec(), view(sides[s]), u[s]);
  Exec().fence();
  double error = 0, size = 0;
  for (Index n = 0; n < v.size(); ++n) {
    error = std::max(error, distance(v[n], (0.5 / h) * (u[1][n] - u[0][n])));
    size = std::max(size, norm(v[n]));
  }
  EXPECT_GT(size, 0.01);
  EXPECT_LT(error, 1e-7 * size);
}

TEST(Cascade, ItsTransposeHasTheProductsOfItsVelocities) {
  UnstructuredCase const c(read_mesh(shared_mesh("mesh_vki_turbine.su2")));
  PlanOptions options;
  options.boundary_layers.push_back(
      {.walls = {"airfoil"}, .extent = BoundaryLayer::Extent::thickness, .thickness = 1e-3});
  auto const prepared =
      prepare(c.mesh, c.topology, c.face_patches,
              motion_of({rule_for({"airfoil"}, rotation({0.018, -0.02, 0}, {0, 0, 1}, std::numbers::pi / 18)),
                         rule_for({"periodic_*"}, FreeRule{})}),
              options);
  LinearisedMorph<UnstructuredCase::Host> const at(prepared.plan, c.mesh.coordinates, prepared.boundary_displacement());
  EXPECT_LE(product_error(at, 1), 1e-13);
}

}  // namespace
}  // namespace gridmorph::test
