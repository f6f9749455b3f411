// Near fields that turn with their walls, and what they hand on to the chains that leave them.
#include "support/mesh_builders.hpp"
#include "support/morph_run.hpp"
#include "support/motions.hpp"
#include "support/random.hpp"

#include <gridmorph/geometry/rigid_transform.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace gridmorph::test {
namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;
using Mode = BoundaryLayer::Mode;

PlanOptions turning(int layers, Mode mode, std::optional<double> turn = std::nullopt,
                    std::vector<std::string> walls = {}) {
  PlanOptions options;
  options.boundary_layers = {{std::move(walls), BoundaryLayer::Extent::layers, layers, 0, mode}};
  options.volume.turn = turn;
  return options;
}

RigidTransform const about_z = rotation_about({0.1, -0.2, 0}, {0, 0, 1}, 0.7);

Outcome turned_o_grid(int layers, Mode mode, std::optional<double> turn = std::nullopt) {
  return morph(
      o_grid(0.8, 12),
      motion({rule({"body"}, function_rule([](Vec3 const& p) { return about_z(p) - p; })), rule({"far"}, FixedRule{})}),
      turning(layers, mode, turn));
}

TEST(TurnedNearField, IsRigidRoundABodyThatTurns) {
  for (int const layers : {1, 2, 3}) {
    Outcome const r = turned_o_grid(layers, Mode::rotate, 1.0);
    Zone const& zone = r.mesh.zones[0];
    for (int k = 0; k < zone.extent[2]; ++k)
      for (int j = 0; j <= layers; ++j)
        for (int i = 0; i < zone.extent[0]; ++i) {
          Index const n = zone.node({i, j, k});
          Vec3 const x = r.mesh.coordinates[n];
          EXPECT_LT(distance(x + r.u(n), about_z(x)), 1e-12) << i << " " << j << " " << k << " of " << layers;
        }
  }
}

// x' = x + (1 - t) u0 + (1 - c1(t)) (R - I)(x - p0), recomputed from the nodes of each line.
TEST(TurnedNearField, HandsItsTurnOnAlongTheLines) {
  int const layers = 2;
  Outcome const r = turned_o_grid(layers, Mode::rotate, 1.0);
  Zone const& zone = r.mesh.zones[0];
  int const last = zone.extent[1] - 1;
  for (int k = 0; k < zone.extent[2]; ++k)
    for (int i = 0; i < zone.extent[0]; ++i) {
      std::vector<double> length{0};
      for (int j = layers; j < last; ++j)
        length.push_back(length.back() + distance(r.mesh.coordinates[zone.node({i, j, k})],
                                                  r.mesh.coordinates[zone.node({i, j + 1, k})]));
      Vec3 const p0 = r.mesh.coordinates[zone.node({i, layers, k})];
      for (int j = layers; j <= last; ++j) {
        Index const n = zone.node({i, j, k});
        Vec3 const x = r.mesh.coordinates[n], arm = x - p0;
        double const t = length[std::size_t(j - layers)] / length.back(), c1 = t * t * (3 - 2 * t);
        Vec3 const u = (1 - t) * (about_z(p0) - p0) + (1 - c1) * (about_z.rotation * arm - arm);
        EXPECT_LT(distance(r.u(n), u), 1e-12) << i << " " << j << " " << k;
      }
    }
}

TEST(TurnedNearField, BlendsToNoTurnAtItsOuterEdge) {
  int const layers = 3;
  Outcome const blend = turned_o_grid(layers, Mode::blend), none = turned_o_grid(layers, Mode::rotate, 0.0);
  Outcome const plain = turned_o_grid(layers, Mode::translate);
  Zone const& zone = blend.mesh.zones[0];
  for (Index n = 0; n < blend.mesh.n_nodes(); ++n) EXPECT_EQ(blend.u(n), none.u(n));
  for (int k = 0; k < zone.extent[2]; ++k)
    for (int j = layers; j < zone.extent[1]; ++j)
      for (int i = 0; i < zone.extent[0]; ++i) {
        Index const n = zone.node({i, j, k});
        EXPECT_LT(distance(blend.u(n), plain.u(n)), 1e-13);
      }
}

double handed_on(Rule const& of_body, Rule const& of_far) {
  Outcome const r =
      morph(o_grid(0.8, 12), motion({rule({"body"}, of_body), rule({"far"}, of_far)}), turning(2, Mode::rotate));
  double most = 0;
  for (kernels::Root const& root : r.plan().turns.roots) most = std::max(most, root.turn);
  return most;
}

TEST(TurnedNearField, ChoosesWhatItHandsOnByWhatMovesAndWhereLinesEnd) {
  RigidRule const turn{about_z.rotation, about_z.translation};
  Rule const bend = function_rule(waves(0.05));
  EXPECT_EQ(handed_on(turn, FixedRule{}), 1);
  EXPECT_EQ(handed_on(bend, FixedRule{}), 0);
  EXPECT_EQ(handed_on(bend, bend), 0.25);
}

/// Height of the first node above the plane of its wall node's neighbours in centred differences.
double first_height(Outcome const& r, int i, int k, Coordinates const& x) {
  Zone const& zone = r.mesh.zones[0];
  auto const at = [&](int di, int j, int dk) { return x[zone.node({i + di, j, k + dk})]; };
  Vec3 const normal = cross(at(1, 0, 0) - at(-1, 0, 0), at(0, 0, 1) - at(0, 0, -1));
  return std::abs(dot(normal, at(0, 1, 0) - at(0, 0, 0))) / norm(normal);
}

TEST(TurnedNearField, KeepsFirstHeightsOfWallsThatBendAndStretch) {
  for (double const turn : {0.0, 0.3, 1.0}) {
    Outcome const r = morph(o_grid(0.8, 12),
                            motion({rule({"body"}, function_rule(waves(0.2))), rule({"far"}, FixedRule{}),
                                    rule({"w_min", "w_max"}, FreeRule{})}),
                            turning(3, Mode::rotate, turn));
    Zone const& zone = r.mesh.zones[0];
    for (int k = 1; k + 1 < zone.extent[2]; ++k)
      for (int i = 1; i + 1 < zone.extent[0]; ++i) {
        double const before = first_height(r, i, k, r.mesh.coordinates);
        EXPECT_NEAR(first_height(r, i, k, r.morphed.position), before, 1e-12 * before) << i << " " << k;
      }
  }
}

struct TurningSector {
  Sector const shape;
  Mesh mesh = annulus_sector(shape, 5);
  PreparedMorph prepared;
  TurningSector()
      : prepared([&] {
          Motion m = motion({rule({"hub"}, function_rule(turning_waves(shape, 0.05))), rule({"case"}, FixedRule{}),
                             rule({"inlet", "outlet"}, SlipRule{})});
          m.axis = {shape.origin, shape.axis};
          return prepare(mesh, m, turning(2, Mode::rotate, std::nullopt, {"hub"}));
        }()) {}
};

TEST(TurnedNearField, HasTheVelocityOfItsDisplacement) {
  Exec const exec;
  TurningSector s;
  std::vector<Vec3> const given = s.prepared.boundary_displacement();
  Random random(3);
  std::vector<Vec3> rate(given.size());
  for (std::size_t n = 0; n < given.size(); ++n) {
    Vec3 const p = s.mesh.coordinates[s.prepared.plan().boundary_nodes[n]];
    rate[n] = norm(given[n]) > 0 ? Vec3{0.3 * p.y, -0.2 * p.z, 0.5 * p.x * p.y} : Vec3{};
  }
  Coordinates const written(s.mesh.n_nodes());
  DeviceField<Exec::memory_space> const x(s.mesh.coordinates), out(written);
  Morpher<Exec>(exec, s.prepared.plan(), x, {1, true})
      .velocities(exec, upload<Exec::memory_space>(given), upload<Exec::memory_space>(rate), out);
  exec.fence();
  Coordinates const velocity = out.host_copy();
  double const dt = 1e-5;
  auto const at = [&](double time) {
    std::vector<Vec3> boundary = given;
    for (std::size_t n = 0; n < given.size(); ++n) boundary[n] += time * rate[n];
    return run_plan(exec, s.mesh, s.prepared.plan(), boundary).displacement;
  };
  Coordinates const before = at(-dt), after = at(dt);
  double worst = 0, largest = 0;
  for (Index n = 0; n < s.mesh.n_nodes(); ++n) {
    worst = std::max(worst, distance(velocity[n], (0.5 / dt) * (after[n] - before[n])));
    largest = std::max(largest, norm(velocity[n]));
  }
  EXPECT_GT(largest, 0.1);
  EXPECT_LT(worst, 1e-7 * largest);
}

TEST(TurnedNearField, TakesSeveralFieldsAtOnceWithTheSameBits) {
  Exec const exec;
  TurningSector s;
  std::vector<Vec3> const given = s.prepared.boundary_displacement();
  std::vector<Vec3> other = given;
  for (Vec3& v : other) v = -0.5 * v;
  using Memory = Exec::memory_space;
  Coordinates const first(s.mesh.n_nodes()), second(s.mesh.n_nodes());
  DeviceField<Memory> const x(s.mesh.coordinates), u0(first), u1(second);
  auto const one = upload<Memory>(given), two = upload<Memory>(other);
  std::vector<Morpher<Exec>::In> const in{one, two};
  std::vector<Morpher<Exec>::Out> const out{u0, u1};
  Morpher<Exec>(exec, s.prepared.plan(), x, {2, false}).displacements(exec, in, out);
  exec.fence();
  EXPECT_EQ(different_bits(u0.host_copy(), run_plan(exec, s.mesh, s.prepared.plan(), given).displacement), 0);
  EXPECT_EQ(different_bits(u1.host_copy(), run_plan(exec, s.mesh, s.prepared.plan(), other).displacement), 0);
}

}  // namespace
}  // namespace gridmorph::test
