// Modes of a box of parameters: their sums are the meshes, or it is said that they are not.
#include "support/made_bodies.hpp"
#include "support/mesh_builders.hpp"
#include "support/motions.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/geometry/rigid_transform.hpp>
#include <gridmorph/morph/apply_on_host.hpp>
#include <gridmorph/morph/design_modes.hpp>

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace gridmorph::test {
namespace {

/// The body shifts by p0 along x, is bent up by p1 (x - 0.1)^2 and turns by p2 about z; the outer boundary stands.
Motion shaped(std::span<double const> p) {
  std::vector<double> const q(p.begin(), p.end());
  Motion m = motion({rule({"body"}, function_rule([=](Vec3 const& x) {
                            Vec3 u = {q[0], q[1] * (x.x - 0.1) * (x.x - 0.1), 0};
                            if (q.size() > 2) u += rotation_about({0.1, 0, 0}, {0, 0, 1}, q[2])(x) - x;
                            return u;
                          }))});
  m.rules.push_back(rule({"far"}, FixedRule{}));
  return m;
}

PlanOptions translating() {
  PlanOptions options;
  options.boundary_layers.push_back({.walls = {"body"},
                                     .extent = BoundaryLayer::Extent::layers,
                                     .layers = 2,
                                     .mode = BoundaryLayer::Mode::translate});
  return options;
}

TEST(DesignModes, AddUpToTheMeshesOfAllDesigns) {
  Mesh const mesh = o_grid(0.8, 12);
  std::array<double, 2> const low{-0.02, -0.3}, high{0.06, 0.1};
  MorphPlan const plan(mesh, shaped(std::array{0.02, -0.1}), translating());
  DesignModes const modes = design_modes(plan, mesh.coordinates, shaped, low, high);
  ASSERT_EQ(modes.modes.size(), 2U);
  EXPECT_LT(modes.deviation, 1e-13);
  Morpher<Kokkos::DefaultHostExecutionSpace> const morpher({}, plan, mesh.coordinates);
  for (auto const& t : {std::array{0.3, -0.8}, std::array{-1.0, 1.0}, std::array{0.0, 0.0}}) {
    std::array<double, 2> p{};
    for (int i = 0; i < 2; ++i) p[i] = 0.5 * (low[i] + high[i]) + 0.5 * t[i] * (high[i] - low[i]);
    Coordinates x(mesh.n_nodes());
    apply_on_host(morpher, plan.boundary_displacement(shaped(p)), x);
    double moved = 0;
    for (Index n = 0; n < x.size(); ++n) {
      ASSERT_LT(distance(modes.centre[n] + t[0] * modes.modes[0][n] + t[1] * modes.modes[1][n], x[n]), 1e-13);
      moved = std::max(moved, distance(x[n], mesh.coordinates[n]));
    }
    EXPECT_GT(moved, 1e-3);
  }
}

TEST(DesignModes, RefuseWhatIsNotLinear) {
  Mesh const mesh = o_grid(0.8, 12);
  auto const modes = [&](std::vector<double> const& low, std::vector<double> const& high, PlanOptions const& options) {
    MorphPlan const plan(mesh, shaped(high), options);
    try {
      (void)design_modes(plan, mesh.coordinates, shaped, low, high);
      return std::string();
    } catch (ConfigError const& e) {
      return std::string(e.what());
    }
  };
  // A turn, by its angle.
  EXPECT_NE(modes({0, 0, 0}, {0.1, 0.1, 0.2}, translating()).find("not linear in parameter 3"), std::string::npos);
  // Near fields that turn with a wall that bends.
  PlanOptions turning = translating();
  turning.boundary_layers.front().mode = BoundaryLayer::Mode::rotate;
  EXPECT_NE(modes({0, 0}, {0.1, 0.3}, turning).find("not linear in parameter 2"), std::string::npos);
  EXPECT_EQ(modes({0, 0}, {0.1, 0.3}, translating()), "");
  EXPECT_NE(modes({0}, {0.1, 0.3}, translating()).find("one of each"), std::string::npos);
  EXPECT_NE(modes({0, 0.4}, {0.1, 0.3}, translating()).find("parameter 2 goes from 0.4 to 0.3"), std::string::npos);
}

}  // namespace
}  // namespace gridmorph::test
