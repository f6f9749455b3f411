// A guard frozen into a plan of elements: it gives back what was recorded, is linear, and mends a turn that inverts.
#include "support/made_bodies.hpp"
#include "support/morph_run.hpp"
#include "support/random.hpp"
#include "support/transpose_check.hpp"
#include "support/unstructured_case.hpp"
#include "support/with_and_without.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/guard/guard.hpp>
#include <gridmorph/morph/plan_access.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph::test {
namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;

/// Tetrahedra round a bar in a box.
struct Bar {
  UnstructuredCase c{box_around(
      {8, 8, 4}, [](Vec3 const& p) { return std::abs(p.x - 4) < 1 && std::abs(p.y - 4) < 2; }, true)};
  Motion motion(double angle) const {
    std::vector<std::string> const rest{"i_min", "i_max", "j_min", "j_max"};
    return motion_of({rule_for({"body"}, rotation({4, 4, 0}, {0, 0, 1}, angle)), rule_for(rest, FixedRule{}),
                      rule_for({"k_min", "k_max"}, SlipRule{})});
  }
};

TEST(FrozenGuardOfElements, SeveralDisplacementsComeBackAndAddUp) {
  Bar const bar;
  UnstructuredMorphed run = bar.c.morph(bar.motion(0.1));
  MorphPlan const whole = PlanAccess::of(std::move(run.prepared));
  auto const& plan = PlanAccess::elements(whole)->plan;
  Mesh const& mesh = bar.c.mesh;
  // Two displacements that differ, and shifts of nodes that no rule moves, whatever made them.
  Vectors const one = run.boundary;
  Vectors other;
  for (std::size_t b = 0; b < one.size(); ++b)
    other.push_back(norm(one[b]) > 0 ? Vec3{0.2, 0.1 * mesh.coordinates[plan.known[b]].z, 0} : Vec3{});
  Both<> const bare(plan, mesh.coordinates, nullptr);
  std::vector<char> fixed(mesh.n_nodes(), 0);
  for (Index32 const n : plan.known) fixed[n] = 1;
  Random random(3);
  SmoothingRecord record(whole);
  std::vector<Coordinates> wanted;
  for (Vectors const& boundary : {one, other}) {
    Coordinates const plain = bare.positions(bare.plain, boundary);
    Coordinates guarded = copy_of(plain);
    for (Index n = 0; n < guarded.size(); ++n)
      if (fixed[n] == 0 && random.below(3) == 0) guarded.set(n, plain[n] + random.vector(0.1));
    record.add(boundary, plain, guarded);
    wanted.push_back(guarded);
  }
  Frozen const map = record.map();
  ASSERT_EQ(map->n_modes, 2);
  Both<> const both(plan, mesh.coordinates, map);
  EXPECT_LT(largest_distance(both.positions(both.frozen, one), wanted[0]), 1e-12);
  EXPECT_LT(largest_distance(both.positions(both.frozen, other), wanted[1]), 1e-12);
  Coordinates const a = both.shifts(one), b = both.shifts(other),
                    c = both.shifts(sum(scaled(2, one), scaled(-3, other)));
  for (Index n = 0; n < a.size(); ++n) ASSERT_LT(norm(c[n] - (2 * a[n] - 3 * b[n])), 1e-11);
  Coordinates const v = both.velocities(one, other);
  Coordinates const bare_v = bare.velocities(one, other);
  for (Index n = 0; n < v.size(); ++n) ASSERT_LT(norm(v[n] - bare_v[n] - b[n]), 1e-11) << "the rate of a linear map";
  EXPECT_LE(product_error(LinearisedMorph<Exec>(plan, mesh.coordinates, one, map)), 1e-13);
  // A third one between them adds no direction; what it asks for is met as well as the other two let it.
  record.add(sum(scaled(0.5, one), scaled(0.5, other)),
             bare.positions(bare.plain, sum(scaled(0.5, one), scaled(0.5, other))),
             bare.positions(bare.plain, sum(scaled(0.5, one), scaled(0.5, other))));
  Frozen const three = record.map();
  EXPECT_EQ(three->n_modes, 2);
  EXPECT_GT(three->misfit, 1e-3);
  EXPECT_LT(three->misfit, three->largest_shift);
}

TEST(FrozenGuardOfElements, ATurnThatInvertsIsMendedAsTheGuardMendsIt) {
  Bar const bar;
  Mesh const& mesh = bar.c.mesh;
  double angle = 0.4;
  while (bar.c.inverted(bar.c.morph(bar.motion(angle)).x) == 0) {
    angle *= 1.1;
    ASSERT_LT(angle, 2) << "nothing is inverted";
  }
  MorphPlan const plan(mesh, bar.motion(angle));
  Vectors const given[]{plan.boundary_displacement()};
  MorphPlan const mended = freeze_guard({}, IndexedMesh(mesh), plan, given);
  ASSERT_NE(mended.smoothing(), nullptr);
  EXPECT_EQ(plan.smoothing(), nullptr) << "the other plan stays as it is";
  auto const inverted = [&](MorphPlan const& by, double share) {
    Coordinates x(mesh.n_nodes());
    apply_on_host(Morpher<Exec>(Exec(), by, mesh.coordinates), scaled(share, given[0]), x);
    return bar.c.inverted(x);
  };
  Index const guarded = bar.c.inverted(bar.c.guarded_morph(bar.motion(angle)).x);
  EXPECT_LT(guarded, inverted(plan, 1));
  EXPECT_EQ(inverted(mended, 1), guarded);
  for (double const share : {0.75, 0.5, 0.25}) EXPECT_LE(inverted(mended, share), inverted(plan, share)) << share;
}

TEST(FrozenGuardOfElements, RefusesWhatItIsNotOf) {
  Bar const bar;
  UnstructuredMorphed run = bar.c.morph(bar.motion(0.1));
  MorphPlan const whole = PlanAccess::of(std::move(run.prepared));
  SmoothingRecord record(whole);
  EXPECT_THROW(record.add(Vectors(3), run.x, run.x), ConfigError);
  EXPECT_THROW(record.add(run.boundary, run.x, Coordinates(4)), ConfigError);
  record.add(run.boundary, run.x, run.x);
  EXPECT_EQ(record.map()->n_modes, 0) << "nothing was moved";
  for (int n = 1; n < SmoothingRecord::most; ++n) record.add(run.boundary, run.x, run.x);
  EXPECT_THROW(record.add(run.boundary, run.x, run.x), ConfigError);
  SmoothingMap other;
  other.n_modes = 1;
  other.n_nodes = run.x.size();
  other.n_boundary = Index(run.boundary.size()) + 1;
  auto const map = std::make_shared<SmoothingMap const>(other);
  EXPECT_THROW(Morpher<Exec>(Exec(), whole, bar.c.mesh.coordinates, {1, false, map}), ConfigError);
}

}  // namespace
}  // namespace gridmorph::test
