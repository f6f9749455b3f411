// What every morph must hold, whatever the mesh (design: invariants of the volume morph).
#include "invariants/cases.hpp"
#include "invariants/checks.hpp"

#include <gridmorph/quality/quality.hpp>

#include "support/every_space.hpp"
#include "support/random.hpp"
#include "support/reduced.hpp"
#include "support/scramble.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>

namespace gridmorph::test {
namespace {

class Invariants : public ::testing::TestWithParam<Case> {
 protected:
  /// Before Kokkos is closed.
  static void TearDownTestSuite() { outcomes.clear(); }

  /// The case as it stands, morphed once for all tests.
  static Outcome const& plain() {
    Case const& c = GetParam();
    auto found = outcomes.find(c.name);
    if (found == outcomes.end()) found = outcomes.emplace(c.name, morph(c.mesh(), c.motion(1), c.options)).first;
    return found->second;
  }

 private:
  static inline std::map<std::string, Outcome> outcomes;
};

TEST_P(Invariants, EveryNodeGetsAFiniteDisplacementAndSomeMove) {
  Outcome const& r = plain();
  EXPECT_EQ(not_finite(r), 0);
  double largest = 0;
  for (Index n = 0; n < r.mesh.n_nodes(); ++n) largest = std::max(largest, norm(r.u(n)));
  EXPECT_GT(largest, 1e-4 * r.plan().mesh_size);
}

TEST_P(Invariants, ZeroMotionLeavesEveryCoordinateBitIdentical) {
  Mesh mesh = GetParam().mesh();
  // Zeros of either sign, as files hold them.
  Random random(3);
  for (auto const& c : {mesh.coordinates.x, mesh.coordinates.y, mesh.coordinates.z})
    for (Index n = 0; n < mesh.n_nodes(); ++n)
      if (c(n) == 0 && random.coin()) c(n) = -0.0;
  Outcome const r = morph(std::move(mesh), GetParam().motion(0), GetParam().options);
  EXPECT_EQ(different_bits(r.morphed.position, r.mesh.coordinates), 0);
}

TEST_P(Invariants, CommonTranslationTranslatesEveryNode) {
  Vec3 const t = GetParam().translation;
  Outcome const r =
      morph(GetParam().mesh(), motion({rule(GetParam().all_patches, function_rule([t](Vec3 const&) { return t; }))}));
  double worst = 0;
  for (Index n = 0; n < r.mesh.n_nodes(); ++n) worst = std::max(worst, distance(r.u(n), t));
  EXPECT_LE(worst, 1e-15 * 16 * norm(t));
}

TEST_P(Invariants, NoCellIsTurnedInsideOut) {
  Outcome const& r = plain();
  Kokkos::DefaultHostExecutionSpace const exec;
  auto const baseline = views(r.mesh.coordinates);
  auto const handedness = zone_handedness(exec, r.mesh, baseline);
  std::vector<CellBox> all;
  for (int z = 0; z < int(r.mesh.zones.size()); ++z) {
    Index3 const n = r.mesh.zones[z].extent;
    all.push_back({z, {{0, 0, 0}, {n[0] - 1, n[1] - 1, n[2] - 1}}});
  }
  ASSERT_GT(min_determinant(exec, r.mesh, baseline, handedness, all).value, 0);
  EXPECT_GT(min_determinant(exec, r.mesh, views(r.morphed.position), handedness, all).value, 0);
}

TEST_P(Invariants, TwoRunsAreBitIdentical) {
  Outcome const& a = plain();
  Outcome const b = morph(GetParam().mesh(), GetParam().motion(1), GetParam().options);
  EXPECT_EQ(different_bits(a.morphed.position, b.morphed.position), 0);
}

TEST_P(Invariants, AllExecutionSpacesAgree) {
  Outcome const& reference = plain();
  on_every_space([&]<class Exec>(Exec const& exec, char const*) {
    Morphed const other = run_plan(exec, reference.mesh, reference.plan(), reference.boundary);
    double const rounding = 1e-13 * reference.plan().mesh_size;
    expect_same_on(exec, other.displacement, reference.morphed.displacement, rounding);
    expect_same_on(exec, other.position, reference.morphed.position, rounding);
    if constexpr (!on_host<Exec>) {
      // What holds to the bit on the host holds so on a device.
      Outcome const there = morph(GetParam().mesh(), GetParam().motion(1), GetParam().options, exec);
      EXPECT_EQ(interface_nodes_that_differ(there), "");
      EXPECT_EQ(boundary_values_changed(there), 0);
      Outcome const still = morph(GetParam().mesh(), GetParam().motion(0), GetParam().options, exec);
      EXPECT_EQ(different_bits(still.morphed.position, still.mesh.coordinates), 0);
    }
  });
}

TEST_P(Invariants, CoincidentNodesMoveBitIdentically) {
  Outcome const& r = plain();
  EXPECT_EQ(interface_nodes_that_differ(r), "");
}

TEST_P(Invariants, PeriodicCopiesMatch) {
  Outcome const& r = plain();
  EXPECT_LE(periodic_mismatch(r), 1e-12 * r.plan().mesh_size);
}

TEST_P(Invariants, SlipNodesStayOnTheirSurface) {
  Outcome const& r = plain();
  EXPECT_LE(off_slip_surface(r), 1e-10);
}

TEST_P(Invariants, KnownDisplacementsAreHonoured) {
  Outcome const& r = plain();
  EXPECT_EQ(boundary_values_changed(r), 0);
  // Coincident nodes of different zones differ by round-off, and so does what the rule asks of them.
  EXPECT_LE(known_displacement_error(r), 1e-14 * r.plan().mesh_size);
}

TEST_P(Invariants, ThePlanBeforeItsProjectionIsLinear) {
  Mesh const& mesh = plain().mesh;
  Plan plan = plain().plan();
  plan.spreads.clear();
  if (!plan.turns.roots.empty()) GTEST_SKIP() << "rotations are not linear in the displacement";
  Random random(8);
  std::vector<Vec3> v(plan.boundary_nodes.size()), w(v.size()), sum(v.size());
  double const a = 1.7, b = -0.6;
  for (std::size_t n = 0; n < v.size(); ++n) {
    v[n] = random.vector(1);
    w[n] = random.vector(1);
    sum[n] = a * v[n] + b * w[n];
  }
  Kokkos::DefaultHostExecutionSpace const exec;
  Coordinates const uv = run_plan(exec, mesh, plan, v).displacement, uw = run_plan(exec, mesh, plan, w).displacement;
  Coordinates const us = run_plan(exec, mesh, plan, sum).displacement;
  double worst = 0;
  for (Index n = 0; n < mesh.n_nodes(); ++n) worst = std::max(worst, distance(us[n], a * uv[n] + b * uw[n]));
  EXPECT_LE(worst, 1e-13);
}

/// Ways to store a mesh that are tried: fewer where it is large.
unsigned n_seeds(Case const& c) { return reduced() ? 1 : (c.file.empty() ? 4 : 2); }

/// The displacement of no node changes by more than 1e-12 of the mesh size when the mesh is stored otherwise.
void expect_same_when_scrambled(Case const& c, Outcome const& plain, Scramble const& what) {
  Mesh mesh = plain.mesh;  // regions are added by its motion
  std::erase_if(mesh.patches, [](Patch const& p) { return p.kind == PatchKind::region; });
  ScrambledMesh scrambled = scramble(mesh, what);
  SCOPED_TRACE("seed " + std::to_string(what.seed));
  Outcome const other = morph(std::move(scrambled.mesh), c.motion(1), c.options);
  double worst = 0;
  Index at = 0;
  for (Index n = 0; n < other.mesh.n_nodes(); ++n) {
    double const d = distance(other.u(n), plain.u(scrambled.old_node[n]));
    if (!(d <= worst)) {
      worst = d;
      at = n;
    }
  }
  // Where the cut of a closed ring becomes its seam, the blocks are others, and so may the blending be.
  double const tolerance = what.cuts > 0 && c.seam_matters ? 1e-2 : 1e-12;
  EXPECT_LE(worst, tolerance * plain.plan().mesh_size)
      << describe_node(other.mesh, at) << ", before " << describe_node(plain.mesh, scrambled.old_node[at]) << '\n'
      << describe(plain.plan()) << describe(other.plan());
  EXPECT_EQ(interface_nodes_that_differ(other), "") << describe(other.plan());
  EXPECT_LE(periodic_mismatch(other), 1e-12 * plain.plan().mesh_size);
}

TEST_P(Invariants, TurningMirroringAndRenumberingZonesChangesNothing) {
  for (unsigned seed = 1; seed <= n_seeds(GetParam()); ++seed)
    expect_same_when_scrambled(GetParam(), plain(), {seed, 0, true, true, true});
}

TEST_P(Invariants, CuttingZonesAtRandomChangesNothing) {
  for (unsigned seed = 1; seed <= n_seeds(GetParam()); ++seed)
    expect_same_when_scrambled(GetParam(), plain(), {seed, int(seed), true, true, true});
}

INSTANTIATE_TEST_SUITE_P(Of, Invariants, ::testing::ValuesIn(make_cases()),
                         [](auto const& info) { return info.param.name; });

}  // namespace
}  // namespace gridmorph::test
