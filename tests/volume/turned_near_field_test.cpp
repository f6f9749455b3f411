// Near fields that turn with their walls, and what they hand on to the chains that leave them.
#include "support/mesh_builders.hpp"
#include "support/morph_run.hpp"
#include "support/motions.hpp"
#include "support/random.hpp"

#include <gridmorph/geometry/rigid_transform.hpp>
#include <gridmorph/quality/quality.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

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

/// How the turn of a body goes on to the far boundary: about which point, and over how many sizes of the body.
struct FarTurn {
  Vec3 centre;
  double reach = 0;
};
FarTurn far_turn(Plan const& plan) {
  for (Stage const& stage : plan.stages)
    for (kernels::Chain const& chain : stage.lines.chains)
      if (chain.turn == kernels::TurnLaw::far) return {stage.lines.end_pivots[chain.first_end_value], chain.turn_reach};
  throw std::logic_error("no chain takes the turn on");
}

// The body's centre moves on along a straight line and fades linearly, the turn about it like the logarithm; recomputed
// from the nodes of each line.
TEST(TurnedNearField, HandsItsTurnOnAboutTheCentreOfTheBody) {
  int const layers = 2;
  Outcome const r = turned_o_grid(layers, Mode::rotate, 1.0);
  Zone const& zone = r.mesh.zones[0];
  int const last = zone.extent[1] - 1;
  auto const [centre, reach] = far_turn(r.plan());
  double const turn = 0.7;
  EXPECT_GE(reach, 1);
  EXPECT_LT(distance(centre, {0.1, 0, 0.5}), 0.1);  // of the undistorted ellipse, which leans by 0.2 along x
  auto const growth = [](double s) { return std::pow(1 + s * s / (1 + s), 0.125); };
  for (int k = 0; k < zone.extent[2]; ++k)
    for (int i = 0; i < zone.extent[0]; ++i) {
      std::vector<double> length{0};
      for (int j = layers; j < last; ++j)
        length.push_back(length.back() + distance(r.mesh.coordinates[zone.node({i, j, k})],
                                                  r.mesh.coordinates[zone.node({i, j + 1, k})]));
      for (int j = layers; j <= last; ++j) {
        Index const n = zone.node({i, j, k});
        Vec3 const x = r.mesh.coordinates[n];
        double const t = length[j - layers] / length.back();
        double const f = 1 - (growth(reach * t) - 1) / (growth(reach) - 1);
        double const angle = 2 * std::atan2(f * std::sin(turn / 2), 1 - f * (1 - std::cos(turn / 2)));
        Vec3 const u = (1 - t) * (about_z(centre) - centre) + rotation_about(centre, {0, 0, 1}, angle)(x) - x;
        EXPECT_LT(distance(r.u(n), u), 1e-12) << i << " " << j << " " << k;
      }
    }
}

/// Around an ellipse, to a circle ten chords away; cells grow as they go out.
Mesh ellipse_in_circle() {
  Bricks b;
  b.name = "ring";
  b.extent = {65, 33, 2};
  b.position = [](Vec3 const& q) {
    double const angle = 2 * std::numbers::pi * q.x, far = (std::pow(1.15, 32 * q.y) - 1) / (std::pow(1.15, 32) - 1);
    return Vec3{((1 - far) + 20 * far) * std::cos(angle), (0.2 * (1 - far) + 20 * far) * std::sin(angle), 0.2 * q.z};
  };
  b.ends[0].kind = Ends::Kind::closed;
  b.family = {"", "", "body", "far", "sides", "sides"};
  b.kind = {PatchKind::other,    PatchKind::other,    PatchKind::wall,
            PatchKind::farfield, PatchKind::symmetry, PatchKind::symmetry};
  return make(b);
}

/// Smallest determinant after the body has turned; RigidRule or the same as a function.
double smallest_determinant(Mesh const& ring, double degrees, bool as_function) {
  RigidTransform const turn = rotation_about({0.4, 0, 0}, {0, 0, 1}, degrees * std::numbers::pi / 180);
  Rule const body = as_function ? Rule(function_rule([=](Vec3 const& p) { return turn(p) - p; }))
                                : Rule(RigidRule{turn.rotation, turn.translation});
  Outcome const r = morph(ring, motion({rule({"body"}, body), rule({"far"}, FixedRule{})}),
                          turning(4, Mode::rotate, as_function ? std::optional(1.0) : std::nullopt));
  Exec const exec;
  Index3 const n = ring.zones[0].extent;
  std::vector<CellBox> const all{{0, {{0, 0, 0}, {n[0] - 1, n[1] - 1, n[2] - 1}}}};
  return min_determinant(exec, ring, views(r.morphed.position), zone_handedness(exec, ring, views(ring.coordinates)),
                         all)
      .value;
}

// The shear of a turn that fades like the logarithm is the same everywhere: half a turn of a body leaves all cells
// sound.
TEST(TurnedNearField, TurnsABodyByHalfATurn) {
  Mesh const ring = ellipse_in_circle();
  double before = smallest_determinant(ring, 0, false);
  for (double const degrees : {30, 60, 90, 120, 150, 180}) {
    double const left = smallest_determinant(ring, degrees, false);
    EXPECT_GT(left, 0.4) << degrees;
    EXPECT_LT(left, before + 1e-9) << degrees;
    EXPECT_NEAR(smallest_determinant(ring, -degrees, true), left, 1e-9) << degrees;
    before = left;
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
  Rule const given = function_rule([](Vec3 const& p) { return about_z(p) - p; });
  EXPECT_EQ(handed_on(turn, FixedRule{}), 1);
  EXPECT_EQ(handed_on(given, FixedRule{}), 1) << "rigid by what it does, not by its name";
  EXPECT_EQ(handed_on(bend, FixedRule{}), 0);
  EXPECT_EQ(handed_on(turn, bend), 0);
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
  MorpherAccess::of(exec, s.prepared.plan(), x, {1, true})
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
  MorpherAccess::of(exec, s.prepared.plan(), x, {2, false}).displacements(exec, in, out);
  exec.fence();
  EXPECT_EQ(different_bits(u0.host_copy(), run_plan(exec, s.mesh, s.prepared.plan(), given).displacement), 0);
  EXPECT_EQ(different_bits(u1.host_copy(), run_plan(exec, s.mesh, s.prepared.plan(), other).displacement), 0);
}

}  // namespace
}  // namespace gridmorph::test
