// The guard on elements of second order that are broken by the nodes between their corners alone: walls that curve
// within thin elements, boundaries that nodes slide on, curved edges inside, and what must not happen.
#include "support/made_bodies.hpp"
#include "support/morph_run.hpp"
#include "support/unstructured_case.hpp"
#include "support/unstructured_meshes.hpp"
#include "support/with_and_without.hpp"

#include <gridmorph/guard/guard.hpp>
#include <gridmorph/kernels/curved_margin.hpp>
#include <gridmorph/morph/morph.hpp>
#include <gridmorph/quality/validity.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

namespace gridmorph::test {
namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;

struct Form {
  std::string name;
  Mesh mesh;
};

/// Boxes of 3 x 2 x 5 cells (6 x 5 in 2-D) on a wall, layers from 0.04 on, each half as thick again as the one below.
std::vector<Form> layered() {
  auto const height = [](double k) { return 0.08 * (std::pow(1.5, k) - 1); };
  auto const solid = [&](Vec3 const& p) { return Vec3{p.x, p.y, height(p.z)}; };
  Mesh const box = unit_box({3, 2, 5});
  return {{"hexahedra of 20 nodes", second_order(to_hexahedra(box), false, solid)},
          {"hexahedra of 27 nodes", second_order(to_hexahedra(box), true, solid)},
          {"prisms of 15 nodes, tetrahedra", second_order(to_prisms_and_tetrahedra(box, 3), false, solid)},
          {"prisms of 18 nodes, tetrahedra", second_order(to_prisms_and_tetrahedra(box, 3), true, solid)},
          {"tetrahedra", second_order(to_prisms_and_tetrahedra(box, 0), false, solid)},
          {"quadrilaterals and triangles", second_order(flat_box(6, 5, 3), true, [&](Vec3 const& p) {
             return Vec3{p.x, height(p.y), 0};
           })}};
}

std::vector<Form> some_of(std::vector<Form> const& all, std::vector<std::size_t> const& which) {
  std::vector<Form> out;
  for (std::size_t const n : which) out.push_back(all[n]);
  return out;
}

std::string wall_of(Mesh const& mesh) { return mesh.dimension == 3 ? "k_min" : "j_min"; }

/// Bumps between the corners of the wall, which stay.
Motion bumps(Mesh const& mesh, double size) {
  bool const solid = mesh.dimension == 3;
  auto const up = [=](std::span<Vec3 const> x, std::span<Vec3> u) {
    auto const wave = [](double t) { return std::pow(std::sin(std::numbers::pi * t), 2); };
    for (std::size_t n = 0; n < x.size(); ++n) {
      double const h = size * std::max(wave(x[n].x), solid ? wave(x[n].y) : 0.0);
      u[n] = solid ? Vec3{0, 0, h} : Vec3{0, h, 0};
    }
  };
  Motion motion = motion_of({rule_for({wall_of(mesh)}, FunctionRule{"bumps", up})});
  motion.rules.push_back(rule_for({solid ? "k_max" : "j_max"}, FixedRule{}));
  motion.rules.push_back(rule_for({"i_min", "i_max"}, SlipRule{}));
  if (solid) motion.rules.push_back(rule_for({"j_min", "j_max"}, SlipRule{}));
  return motion;
}

std::set<Index32> corners_of(Mesh const& mesh) {
  std::set<Index32> out;
  for (Index e = 0; e < mesh.n_elements(); ++e)
    for (Index32 const n : mesh.elements.corners(e)) out.insert(n);
  return out;
}

bool certified(UnstructuredCase const& c, Coordinates const& x) {
  return certify(Exec(), c.mesh, c.topology, {views(x), views(c.mesh.coordinates), {}, {}}).holds();
}

TEST(MiddleNodes, FollowWallsThatCurveWithinThinElements) {
  for (Form const& form : layered()) {
    SCOPED_TRACE(form.name);
    UnstructuredCase const c(form.mesh);
    auto m = c.morph(bumps(c.mesh, 0.15));
    ASSERT_GT(c.inverted(m.x), 0);
    ASSERT_FALSE(certified(c, m.x));
    Coordinates const before = copy_of(m.x);
    auto const report = relax_bad_elements(c.mesh, c.topology, m.prepared, m.x);
    EXPECT_GT(report.inverted_before, 0);
    EXPECT_EQ(report.inverted_after, 0);
    EXPECT_GT(report.middles, 0);
    EXPECT_EQ(c.inverted(m.x), 0);
    EXPECT_TRUE(certified(c, m.x));
    EXPECT_EQ(c.largest_miss(m), 0);  // the wall is where its rule says
    for (Index32 const n : corners_of(c.mesh)) ASSERT_EQ(m.x[n], before[n]) << "corners need not move";
    Index moved = 0;
    for (Index n = 0; n < c.mesh.n_nodes(); ++n) {
      moved += m.x[n] == before[n] ? 0 : 1;
      Vec3 const p = c.mesh.coordinates[n];
      if (p.x == 0 || p.x == (c.mesh.dimension == 3 ? 3 : 6)) {
        ASSERT_NEAR(m.x[n].x, p.x, 1e-15) << "sides are slid on";
      }
    }
    EXPECT_EQ(moved, report.middles);
  }
}

TEST(MiddleNodes, MoveNoFartherThanTheyNeedTo) {
  // Larger bumps, more of the layers: those beyond what is broken stay bit for bit.
  UnstructuredCase const c(layered()[1].mesh);
  double reach = 0;
  for (double const size : {0.04, 0.15}) {
    auto m = c.morph(bumps(c.mesh, size));
    Coordinates const before = copy_of(m.x);
    (void)relax_bad_elements(c.mesh, c.topology, m.prepared, m.x);
    EXPECT_TRUE(certified(c, m.x)) << size;
    double highest = 0;
    for (Index n = 0; n < c.mesh.n_nodes(); ++n)
      if (!(m.x[n] == before[n])) highest = std::max(highest, c.mesh.coordinates[n].z);
    EXPECT_GE(highest, reach) << size;
    EXPECT_LT(highest, 0.5) << size;
    reach = highest;
  }
  EXPECT_GT(reach, 0);
}

TEST(MiddleNodes, CurvedEdgesInsideAreStraightened) {
  // An inner edge bent through the next one, whatever bent it.
  for (Form const& form : some_of(layered(), {0, 2, 5})) {
    SCOPED_TRACE(form.name);
    UnstructuredCase const c(form.mesh);
    auto m = c.morph(bumps(c.mesh, 0));
    auto const& boundary = m.prepared.plan.middle_boundary.node;
    Index32 bent = -1;
    Vec3 const aim = c.mesh.dimension == 3 ? Vec3{1.5, 1, 0.3} : Vec3{2.5, 0.3, 0};
    for (Index32 const n : m.prepared.plan.middle.target)
      if (std::find(boundary.begin(), boundary.end(), n) == boundary.end() &&
          (bent < 0 || distance(c.mesh.coordinates[n], aim) < distance(c.mesh.coordinates[bent], aim)))
        bent = n;
    ASSERT_GE(bent, 0);
    m.x.set(bent, m.x[bent] + (c.mesh.dimension == 3 ? Vec3{0.2, 0.1, 0.8} : Vec3{0.2, 0.8, 0}));
    ASSERT_GT(c.inverted(m.x), 0);
    auto const report = relax_bad_elements(c.mesh, c.topology, m.prepared, m.x);
    EXPECT_EQ(report.inverted_after, 0);
    EXPECT_TRUE(certified(c, m.x));
    EXPECT_EQ(c.largest_miss(m), 0);
  }
}

TEST(MiddleNodes, NoMotionLeavesEveryBit) {
  for (Form const& form : some_of(layered(), {1, 3, 5})) {
    SCOPED_TRACE(form.name);
    UnstructuredCase const c(form.mesh);
    auto m = c.morph(bumps(c.mesh, 0));
    auto const report = relax_bad_elements(c.mesh, c.topology, m.prepared, m.x);
    EXPECT_EQ(report.before, 0);
    EXPECT_EQ(report.middles, 0);
    for (Index n = 0; n < c.mesh.n_nodes(); ++n) ASSERT_EQ(m.x[n], c.mesh.coordinates[n]) << n;
  }
}

TEST(MiddleNodes, WhatPullsThemIsFrozenIntoPlans) {
  UnstructuredCase const c(layered()[0].mesh);
  Motion const motion = bumps(c.mesh, 0.15);
  MorphPlan const plan(c.mesh, motion);
  Vectors const given[]{plan.boundary_displacement()};
  MorphPlan const frozen = freeze_guard({}, IndexedMesh(c.mesh), plan, given);
  ASSERT_NE(frozen.smoothing(), nullptr);
  Coordinates x(c.mesh.n_nodes());
  Morpher<Exec> const morpher(Exec(), frozen, c.mesh.coordinates);
  apply_on_host(morpher, given[0], x);
  EXPECT_TRUE(certified(c, x));
  auto const guarded = c.guarded_morph(motion);
  for (Index n = 0; n < x.size(); ++n) ASSERT_LT(distance(x[n], guarded.x[n]), 1e-12) << n;
  apply_on_host(morpher, Vectors(given[0].size()), x);
  for (Index n = 0; n < x.size(); ++n) ASSERT_EQ(x[n], c.mesh.coordinates[n]) << n;
}

TEST(CurvedMargin, BoundsTheJacobianFromBelow) {
  // Of parallelepipeds 1, whatever the type; of others no larger than what dense samples say.
  for (Form const& form : layered()) {
    SCOPED_TRACE(form.name);
    Mesh const straight =
        second_order(form.name.starts_with("quad") ? flat_box(6, 5, 3) : to_hexahedra(unit_box({2, 2, 2})), true);
    auto const of = [](Mesh const& mesh, Coordinates const& x, Index e) {
      kernels::CurvedElement out{mesh.elements.type[e], {}};
      auto const nodes = mesh.elements.nodes[e];
      for (std::size_t k = 0; k < nodes.size(); ++k) out.at[k] = x[nodes[k]];
      if (int(nodes.size()) < kernels::n_curved_nodes(out.type)) kernels::curved::complete(out);
      return out;
    };
    EXPECT_NEAR(kernels::curved_margin(of(straight, straight.coordinates, 0), 1, {0, 0, 1}), 1, 1e-10);
    UnstructuredCase const c(form.mesh);
    auto const m = c.morph(bumps(c.mesh, 0.03));
    bool const flat = c.mesh.dimension == 2;
    for (Index e = 0; e < c.mesh.n_elements(); e += 7) {
      auto const element = of(c.mesh, m.x, e);
      double least = HUGE_VAL, largest = 0;
      constexpr int n = 8;
      for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j)
          for (int k = 0; k <= (flat ? 0 : n); ++k) {
            double const value =
                kernels::curved::jacobian(element, {double(i) / n, double(j) / n, double(k) / n}, {0, 0, 1});
            least = std::min(least, value);
            largest = std::max(largest, std::abs(value));
          }
      double const margin = kernels::curved_margin(element, 1, {0, 0, 1});
      EXPECT_LE(margin, least / largest + 1e-9) << e;
      EXPECT_GE(margin, -1);
    }
  }
}

}  // namespace
}  // namespace gridmorph::test
