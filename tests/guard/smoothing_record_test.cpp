// A guard frozen into a plan of blocks: it gives back what was recorded, is linear, and keeps what smoothing keeps; on
// one mesh of each kind of topology.
#include "invariants/cases.hpp"
#include "support/morph_run.hpp"
#include "support/transpose_check.hpp"
#include "support/with_and_without.hpp"

#include <gridmorph/boundary/link_nodes.hpp>
#include <gridmorph/guard/guard.hpp>
#include <gridmorph/guard/shape_smoothing.hpp>
#include <gridmorph/morph/plan_access.hpp>
#include <gridmorph/plan/smoothing_map.hpp>
#include <gridmorph/quality/quality.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace gridmorph::test {

namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;

/// A case's motion, enlarged until corners lose their shape, with what smoothing made of it.
struct Recorded {
  Outcome run;
  Coordinates smoothed;
  Frozen map;
};

/// Emptied after the suite: arrays may not outlive Kokkos.
std::map<std::string, Recorded> known;

Recorded const& recorded(Case const& c) {
  if (auto const found = known.find(c.name); found != known.end()) return found->second;
  double factor = 1;
  for (int n = 0; n < 10; ++n, factor *= 1.5) {
    Outcome run = morph(c.mesh(), c.motion(factor), c.options);
    IndexedMesh const mesh(run.mesh);
    FrozenSmoothing const lost = lost_shapes({}, mesh, run.morphed.position);
    if (lost.cells.empty()) continue;
    Coordinates smoothed = copy_of(run.morphed.position);
    MorphPlan const plan = PlanAccess::of(prepare(c.mesh(), c.motion(factor), c.options));
    (void)smooth_frozen({}, mesh, plan, smoothed, lost);
    if (largest_distance(smoothed, run.morphed.position) == 0) continue;
    SmoothingRecord record(plan);
    record.add(run.boundary, run.morphed.position, smoothed);
    Frozen const map = record.map();
    return known.try_emplace(c.name, Recorded{std::move(run), std::move(smoothed), map}).first->second;
  }
  throw std::runtime_error(c.name + " has nothing to smooth, however far it is moved");
}

class FrozenGuard : public testing::TestWithParam<Case> {
 protected:
  static void TearDownTestSuite() { known.clear(); }
};

TEST_P(FrozenGuard, GivesBackWhatWasRecordedAndIsLinear) {
  auto const& [run, smoothed, map] = recorded(GetParam());
  double const size = run.plan().mesh_size;
  Mesh const& mesh = run.mesh;
  ASSERT_EQ(map->n_modes, 1);
  EXPECT_LT(map->misfit, 1e-13 * size);
  Both<> const both(run.plan(), mesh.coordinates, map);
  EXPECT_LT(largest_distance(both.positions(both.frozen, run.boundary), smoothed), 1e-12 * size);
  EXPECT_EQ(different_bits(both.positions(both.frozen, Vectors(run.boundary.size())),
                           both.positions(both.plain, Vectors(run.boundary.size()))),
            0)
      << "nothing moves";
  // In place: the baseline is gone when shifts are added.
  Coordinates in_place = copy_of(mesh.coordinates);
  MorpherAccess::of(Exec(), run.plan(), in_place, {1, false, map})
      .positions(Exec(), Both<>::view(run.boundary), in_place);
  Exec().fence();
  EXPECT_EQ(different_bits(in_place, both.positions(both.frozen, run.boundary)), 0);
  // Points that move in space: a scaled displacement has the scaled shift, and its rate that of it.
  Vectors const part = scaled(-0.4, run.boundary);
  Coordinates const whole = both.shifts(run.boundary), share = both.shifts(part);
  for (Index const n : map->node) ASSERT_LT(norm(share[n] + 0.4 * whole[n]), 1e-12 * size) << n;
  double const h = 1e-5;
  Coordinates const v = both.velocities(part, run.boundary),
                    before = both.displacements(both.frozen, scaled(-0.4 - h, run.boundary)),
                    after = both.displacements(both.frozen, scaled(-0.4 + h, run.boundary));
  double fastest = 0, error = 0;
  for (Index n = 0; n < v.size(); ++n) {
    fastest = std::max(fastest, norm(v[n]));
    error = std::max(error, norm(v[n] - (0.5 / h) * (after[n] - before[n])));
  }
  EXPECT_LT(error, 1e-5 * fastest);
  for (Vectors const& at : {run.boundary, part, Vectors(part.size())})
    EXPECT_LE(product_error(LinearisedMorph<Exec>(run.plan(), mesh.coordinates, at, map), 1), 1e-13) << "its transpose";
}

TEST_P(FrozenGuard, KeepsPeriodicPairsSlipSurfacesAndWhatStays) {
  auto const& [run, smoothed, map] = recorded(GetParam());
  double const size = run.plan().mesh_size;
  Mesh const& mesh = run.mesh;
  Both<> const both(run.plan(), mesh.coordinates, map);
  for (double const factor : {0.5, 1.0}) {
    Vectors const boundary = scaled(factor, run.boundary);
    Coordinates const plain = both.positions(both.plain, boundary), x = both.positions(both.frozen, boundary);
    for (Index const n : run.plan().boundary_nodes) {
      if (same_bits(smoothed[n], run.morphed.position[n])) {
        ASSERT_TRUE(same_bits(x[n], plain[n])) << n;
      }
    }
    for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
      SlipSurface const* const surface = run.prepared.surface.slip_surface(int(p));
      if (surface == nullptr) continue;
      IndexRange const& r = mesh.patches[p].range;
      Zone const& zone = mesh.zones[mesh.patches[p].zone];
      for (int k = r.begin[2]; k < r.end[2]; ++k)
        for (int j = r.begin[1]; j < r.end[1]; ++j)
          for (int i = r.begin[0]; i < r.end[0]; ++i) {
            Index const n = zone.node({i, j, k});
            if (same_bits(x[n], plain[n])) continue;
            Vec3 const u = x[n] - mesh.coordinates[n];
            ASSERT_LE(distance(surface->view().constrain(mesh.coordinates[n], u), u), 1e-11 * size) << n;
          }
    }
    for (Link const& link : run.prepared.links.all)
      for_each_pair(mesh, link, [&](Index own, Index donor) {
        double const before = distance(link.transform(mesh.coordinates[own]), mesh.coordinates[donor]);
        ASSERT_LE(distance(link.transform(x[own]), x[donor]), before + 1e-12 * size);
        if (!link.periodic && same_bits(mesh.coordinates[own], mesh.coordinates[donor])) {
          ASSERT_LE(distance(x[own], x[donor]), 1e-15 * size);
        }
      });
  }
}

#ifdef KOKKOS_ENABLE_SERIAL
TEST_P(FrozenGuard, GivesTheSameBitsForAnyNumberOfThreads) {
  auto const& [run, smoothed, map] = recorded(GetParam());
  Both<> const both(run.plan(), run.mesh.coordinates, map);
  Both<Kokkos::Serial> const serial(run.plan(), run.mesh.coordinates, map);
  EXPECT_EQ(different_bits(both.positions(both.frozen, run.boundary), serial.positions(serial.frozen, run.boundary)),
            0);
}
#endif

INSTANTIATE_TEST_SUITE_P(Cases, FrozenGuard, testing::ValuesIn(make_cases()),
                         [](auto const& info) { return info.param.name; });

}  // namespace
}  // namespace gridmorph::test
