// Gradients of the parameters of rules, on blocks and on elements: against differences of whole morphs.
#include "support/functional_of_morph.hpp"
#include "support/made_bodies.hpp"
#include "support/mesh_builders.hpp"
#include "support/motions.hpp"
#include "support/transpose_check.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/geometry/rigid_transform.hpp>
#include <gridmorph/morph/parameter_gradient.hpp>

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace gridmorph::test {
namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;
using Parameters = std::array<double, 3>;

/// A wall turned by p0 about z, shifted by p1 along x, swollen by p2^2; whatever else stands.
ParametricMotion shaped(std::string const& wall, Vec3 const& centre, std::vector<std::string> const& fixed) {
  return [=](std::span<double const> p) {
    std::vector<double> const q(p.begin(), p.end());
    Motion m = motion({rule({wall}, function_rule([=](Vec3 const& x) {
                              RigidTransform const turn = rotation_about(centre, {0, 0, 1}, q[0]);
                              return turn(x) - x + Vec3{q[1], 0, 0} + (q[2] * q[2]) * (x - centre);
                            }))});
    m.rules.push_back(rule(fixed, FixedRule{}));
    return m;
  };
}

/// Nodes of the wall that leave the planes at the ends of its span are trimmed to them after the wall has turned.
TEST(Transpose, OfWallsWhoseNodesAreTrimmedToSlipSurfacesIsExact) {
  PlanOptions options;
  options.boundary_layers.push_back({.walls = {"body"}, .extent = BoundaryLayer::Extent::layers, .layers = 2});
  auto const motion_of = shaped("body", {0.1, 0, 0}, {"far"});
  Mesh const mesh = o_grid(0.8, 12);
  MorphPlan const plan(mesh, motion_of(Parameters{0.1, 0, 0.2}), options);
  LinearisedMorph<Exec> const at(plan, mesh.coordinates, plan.boundary_displacement());
  EXPECT_LE(product_error(at), 1e-13);
}

void expect_slopes_of_differences(Mesh const& mesh, ParametricMotion const& motion_of, PlanOptions const& options) {
  Parameters const p{0.1, 0.05, 0.2}, steps{1e-4, 1e-4, 1e-4};
  MorphPlan const plan(mesh, motion_of(p), options);
  FunctionalOfMorph<Exec> const functional(plan, mesh.coordinates);
  std::vector<double> const slopes = parameter_gradient(plan, motion_of, p, steps, functional.gradient());
  ASSERT_EQ(slopes.size(), p.size());
  for (std::size_t k = 0; k < p.size(); ++k) {
    Parameters up = p, down = p;
    up[k] += steps[k];
    down[k] -= steps[k];
    double const difference = (functional.of(motion_of(up)) - functional.of(motion_of(down))) / (2 * steps[k]);
    EXPECT_NE(difference, 0) << k;
    EXPECT_NEAR(slopes[k], difference, 1e-6 * std::abs(difference)) << k;
  }
}

TEST(ParameterGradient, OfBlocksIsThatOfWholeMorphs) {
  PlanOptions options;
  options.boundary_layers.push_back({.walls = {"body"}, .extent = BoundaryLayer::Extent::layers, .layers = 2});
  expect_slopes_of_differences(o_grid(0.8, 12), shaped("body", {0.1, 0, 0}, {"far"}), options);
}

TEST(ParameterGradient, OfElementsIsThatOfWholeMorphs) {
  expect_slopes_of_differences(airfoil(32, 2, 0.03, 1.4, 4), shaped("airfoil", {0.3, 0, 0}, {"farfield"}), {});
}

TEST(ParameterGradient, RefusesWhatDoesNotFit) {
  Mesh const mesh = o_grid(0.8, 12);
  auto const motion_of = shaped("body", {0.1, 0, 0}, {"far"});
  Parameters const p{}, steps{1e-4, 1e-4, 1e-4}, wrong{1e-4, 0, 1e-4};
  MorphPlan const plan(mesh, motion_of(p));
  std::vector<Vec3> const gradient(plan.boundary_nodes().size());
  EXPECT_THROW((void)parameter_gradient(plan, motion_of, p, std::span(steps).first(2), gradient), ConfigError);
  EXPECT_THROW((void)parameter_gradient(plan, motion_of, p, wrong, gradient), ConfigError);
  EXPECT_THROW((void)parameter_gradient(plan, motion_of, p, steps, std::span(gradient).first(3)), ConfigError);
}

}  // namespace
}  // namespace gridmorph::test
