// Grid velocity and several fields at once: against differences of displacements, and one by one.
#include "support/made_bodies.hpp"
#include "support/unstructured_case.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/core/error.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace gridmorph::test {
namespace {

using Case = UnstructuredCase;
using Exec = Case::Host;
using Vectors = std::vector<Vec3>;

Kokkos::View<Vec3 const*, Kokkos::HostSpace> view(Vectors const& v) {
  return Kokkos::View<Vec3 const*, Kokkos::HostSpace>(v.data(), v.size());
}

/// A case, planned for a motion, with its displacements and velocities on the host.
struct Planned {
  Case const& c;
  PreparedUnstructured prepared;
  Morpher<Exec> morpher;

  Planned(Case const& of, Motion const& motion, PlanOptions const& options = {})
      : c(of),
        prepared(prepare(c.mesh, c.topology, c.face_patches, motion, options)),
        morpher(MorpherAccess::of(Exec(), prepared.plan, c.mesh.coordinates, {1, true})) {}

  [[nodiscard]] Coordinates displacement(Vectors const& boundary) const {
    Coordinates u(c.mesh.n_nodes());
    morpher.displacements(Exec(), view(boundary), u);
    Exec().fence();
    return u;
  }
  [[nodiscard]] Coordinates velocity(Vectors const& boundary, Vectors const& rate) const {
    Coordinates v(c.mesh.n_nodes());
    morpher.velocities(Exec(), view(boundary), view(rate), v);
    Exec().fence();
    return v;
  }

  /// Largest difference from (u(b + h r) - u(b - h r)) / 2h, over the largest velocity.
  [[nodiscard]] double largest_error(Vectors const& b, Vectors const& rate, double h) const {
    Vectors before = b, after = b;
    for (std::size_t k = 0; k < b.size(); ++k) {
      before[k] = b[k] - h * rate[k];
      after[k] = b[k] + h * rate[k];
    }
    Coordinates const v = velocity(b, rate), u0 = displacement(before), u1 = displacement(after);
    double error = 0, size = 0;
    for (Index n = 0; n < v.size(); ++n) {
      error = std::max(error, norm(v[n] - (0.5 / h) * (u1[n] - u0[n])));
      size = std::max(size, norm(v[n]));
    }
    EXPECT_GT(size, 0.1);
    return error / size;
  }
};

/// A box of 9^3 cells whose inner third is the wall "body", with one layer of columns on it.
PlanOptions one_layer(BoundaryLayer::Mode mode = BoundaryLayer::Mode::rotate) {
  PlanOptions options;
  options.elements.cells = 1;  // a coarse background: the stages are the same
  options.boundary_layers.push_back(
      {.walls = {"body"}, .extent = BoundaryLayer::Extent::layers, .layers = 1, .mode = mode});
  return options;
}
Case box() {
  return Case(box_around({12, 12, 12},
                         [](Vec3 const& p) { return p.x > 4 && p.x < 8 && p.y > 4 && p.y < 8 && p.z > 4 && p.z < 8; }));
}

/// What the nodes of "body" do that turns by `angle` per unit of time, and bends.
Vectors bending(Planned const& p, Vec3 const& spin) {
  Vectors rate;
  auto const& plan = p.prepared.plan;
  for (std::size_t k = 0; k < plan.known.size(); ++k) {
    Vec3 const x = p.c.mesh.coordinates[plan.known[k]] - Vec3{4.5, 4.5, 4.5};
    bool const moves = std::binary_search(plan.driving.begin(), plan.driving.end(), plan.known[k]);
    rate.push_back(moves ? cross(spin, x) + Vec3{0.3 + 0.1 * x.y * x.y, 0.2 * std::sin(x.z), 0.1 * x.x * x.y} : Vec3{});
  }
  return rate;
}

TEST(UnstructuredVelocity, IsTheDerivativeOfTheDisplacementWhereWallsTurnAndBend) {
  Case const c = box();
  for (auto const mode : {BoundaryLayer::Mode::translate, BoundaryLayer::Mode::rotate, BoundaryLayer::Mode::blend}) {
    Planned const p(c, motion_of({rule_for({"body"}, translation({0.5, 0, 0})), rule_for({"k_min"}, SlipRule{})}),
                    one_layer(mode));
    Vectors const rate = bending(p, {0.5, 0.2, -0.4});
    Vectors turned = rate;
    for (Vec3& u : turned) u = 0.6 * u;
    EXPECT_LT(p.largest_error(turned, rate, 1e-5), 1e-8) << "turned already";
    if (mode != BoundaryLayer::Mode::rotate) continue;
    EXPECT_LT(p.largest_error(Vectors(rate.size()), rate, 1e-5), 1e-8) << "from rest";
    EXPECT_LT(p.largest_error(turned, bending(p, {-0.1, 0.7, 0.3}), 1e-5), 1e-8) << "about another axis";
  }
}

TEST(UnstructuredVelocity, HoldsInThePlaneToo) {
  Case const c(airfoil(48, 3, 0.02, 1.3, 4));
  PlanOptions options;
  options.boundary_layers.push_back({.walls = {"airfoil"}, .extent = BoundaryLayer::Extent::layers, .layers = 2});
  Planned const p(c, motion_of({rule_for({"airfoil"}, translation({0.1, 0, 0}))}), options);
  auto const& plan = p.prepared.plan;
  Vectors rate, now;
  for (Index32 const n : plan.known) {
    Vec3 const x = c.mesh.coordinates[n];
    bool const moves = std::binary_search(plan.driving.begin(), plan.driving.end(), n);
    rate.push_back(moves ? Vec3{-0.5 * x.y, 0.5 * x.x + 0.1 * x.x * x.x, 0} : Vec3{});
    now.push_back(0.3 * rate.back());
  }
  EXPECT_LT(p.largest_error(now, rate, 1e-5), 1e-8);
}

TEST(UnstructuredVelocity, OfNodesThatSlideOnASurfaceOfRevolutionIsAlongIt) {
  // Half an annulus along x, whose case bulges; the hub shifts and twists, all ends slip.
  auto const radius = [](double x) { return 2 + 0.3 * std::pow(std::sin(x), 2); };
  Mesh mesh = to_hexahedra(unit_box({10, 5, 8}));
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    Vec3 const q = mesh.coordinates[n];
    double const x = q.x * std::numbers::pi / 10, angle = q.z * std::numbers::pi / 8;
    double const r = 1 + (radius(x) - 1) * q.y / 5;
    mesh.coordinates.set(n, {x, r * std::cos(angle), r * std::sin(angle)});
  }
  std::vector<std::pair<double, double>> profile;
  for (int k = 0; k <= 64; ++k) profile.emplace_back(k * std::numbers::pi / 64, radius(k * std::numbers::pi / 64));
  Case const c(mesh);
  Motion motion =
      motion_of({rule_for({"j_min"}, translation({0.15, 0, 0})),
                 rule_for({"j_max"}, SlipRule{.surface = SlipRule::Surface::revolution, .profile = profile}),
                 rule_for({"i_min", "i_max", "k_min", "k_max"}, FreeRule{})});
  Planned const p(c, motion);
  Vectors rate, now;
  for (Index32 const n : p.prepared.plan.known) {
    Vec3 const x = c.mesh.coordinates[n];
    rate.push_back(Vec3{0.3, 0, 0} + cross({0.4 * std::sin(x.x), 0, 0}, x));
    now.push_back(0.4 * rate.back());
  }
  EXPECT_LT(p.largest_error(now, rate, 1e-5), 1e-7);
}

TEST(UnstructuredVelocity, OfPeriodicNodesIsOne) {
  Mesh mesh = periodic_flat_box(8, 5, 2);
  Connection const pair = mesh.connections.front();
  Case const c(std::move(mesh));
  Planned const p(c, motion_of({rule_for({"j_min"}, translation({0, 0.3, 0}))}));
  Vectors rate, now;
  for (Index32 const n : p.prepared.plan.known) {
    Vec3 const x = c.mesh.coordinates[n];
    rate.push_back(x.y == 0 ? Vec3{0.2, 0.3 * std::cos(x.x * std::numbers::pi / 4), 0} : Vec3{});
    now.push_back(0.5 * rate.back());
  }
  EXPECT_LT(p.largest_error(now, rate, 1e-5), 1e-8);
  Coordinates const v = p.velocity(now, rate);
  for (std::size_t k = 0; k < pair.nodes.size(); ++k) EXPECT_EQ(v[pair.nodes[k]], v[pair.donor_nodes[k]]);
}

TEST(UnstructuredVelocity, NeedsItsRoom) {
  Case const c = box();
  Planned const p(c, motion_of({rule_for({"body"}, translation({0.5, 0, 0}))}));
  auto const without = MorpherAccess::of(Exec(), p.prepared.plan, c.mesh.coordinates);
  Vectors const rest(p.prepared.plan.known.size());
  Coordinates const v(c.mesh.n_nodes());
  EXPECT_THROW(without.velocities(Exec(), view(rest), view(rest), v), ConfigError);
}

TEST(UnstructuredBatches, AreTheFieldsOneByOneBitForBit) {
  Case const c = box();
  Planned const p(c, motion_of({rule_for({"body"}, translation({0.5, 0, 0}))}), one_layer());
  Vectors const unit = bending(p, {0.5, 0.2, -0.4});
  std::vector<Vectors> given(3, unit);
  std::vector<Coordinates> u;
  std::vector<Morpher<Exec>::In> in;
  std::vector<Morpher<Exec>::Out> out;
  for (std::size_t f = 0; f < given.size(); ++f) {
    for (Vec3& v : given[f]) v = (0.2 * double(f)) * v;
    u.emplace_back(c.mesh.n_nodes());
    in.emplace_back(view(given[f]));
    out.emplace_back(u[f]);
  }
  p.morpher.displacements(Exec(), in, out);
  Exec().fence();
  for (std::size_t f = 0; f < given.size(); ++f) {
    Coordinates const expected = p.displacement(given[f]);
    for (Index n = 0; n < u[f].size(); ++n) ASSERT_EQ(u[f][n], expected[n]) << f << " " << n;
  }
}

/// Coordinates and displacements in single precision, interleaved: what comes out is the field in double, rounded.
TEST(UnstructuredBatches, OtherLayoutsGiveTheSameField) {
  Case c = box();
  for (Index n = 0; n < c.mesh.n_nodes(); ++n) c.mesh.coordinates.set(n, 0.5 * c.mesh.coordinates[n]);
  Planned const p(c, motion_of({rule_for({"body"}, translation({0.25, 0, 0}))}), one_layer());
  Vectors const given(p.prepared.plan.known.size(), Vec3{0.25, 0.5, 0});
  Kokkos::View<float*[3], Kokkos::LayoutRight, Kokkos::HostSpace> const x("x", std::size_t(c.mesh.n_nodes())),
      u("u", std::size_t(c.mesh.n_nodes()));
  for (Index n = 0; n < c.mesh.n_nodes(); ++n) {
    Vec3 const at = c.mesh.coordinates[n];
    x(n, 0) = float(at.x), x(n, 1) = float(at.y), x(n, 2) = float(at.z);
  }
  auto const single = MorpherAccess::of(Exec(), p.prepared.plan, x);
  single.displacements(Exec(), view(given), u);
  Exec().fence();
  Coordinates const expected = p.displacement(given);
  for (Index n = 0; n < c.mesh.n_nodes(); ++n) {
    ASSERT_EQ(u(n, 0), float(expected[n].x)) << n;
    ASSERT_EQ(u(n, 1), float(expected[n].y)) << n;
  }
}

}  // namespace
}  // namespace gridmorph::test
