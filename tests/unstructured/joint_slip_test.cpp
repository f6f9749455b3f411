// Nodes that several things hold at once: given displacements on slip surfaces, periodic images on surfaces, periodic
// sides that meet in their axis.
#include "support/made_bodies.hpp"
#include "support/sector.hpp"
#include "support/unstructured_case.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/guard/guard.hpp>
#include <gridmorph/guard/relaxation.hpp>
#include <gridmorph/kernels/transposed_slip.hpp>
#include <gridmorph/morph/plan_access.hpp>
#include <gridmorph/plan/trim_note.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace gridmorph::test {
namespace {

using Case = UnstructuredCase;
using Exec = Case::Host;

Rule function(std::function<Vec3(Vec3 const&)> const& of) {
  return FunctionRule{"function", [of](std::span<Vec3 const> x, std::span<Vec3> u) {
                        std::transform(x.begin(), x.end(), u.begin(), of);
                      }};
}

/// A coarse background: what holds nodes is the same.
PlanOptions coarse() {
  PlanOptions options;
  options.elements.cells = 1;
  return options;
}

/// Largest change of a quantity over the nodes of a patch.
double largest_change(Case const& c, Coordinates const& x, std::string const& patch,
                      std::function<double(Vec3 const&)> const& of) {
  double largest = 0;
  for (Index32 const n : c.nodes_of(patch)) largest = std::max(largest, std::abs(of(x[n]) - of(c.mesh.coordinates[n])));
  return largest;
}
std::function<double(Vec3 const&)> component(int axis) {
  return [axis](Vec3 const& p) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; };
}

/// The elements of a sector with a node in the middle of each edge, those on the periodic sides paired.
Mesh of_second_order(Sector const& s) {
  Mesh mesh = second_order(s.mesh());
  Connection pair = s.mesh().connections.front();
  pair.nodes.clear();
  pair.donor_nodes.clear();
  RigidTransform const turn = rotation_about(s.axis().origin, s.axis().direction, s.angle);
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    Vec3 const p = s.local(mesh.coordinates[n]);
    if (std::abs(p.y) > 1e-9 || p.x < -1e-9) continue;
    for (Index d = 0; d < mesh.n_nodes(); ++d)
      if (distance(turn(mesh.coordinates[n]), mesh.coordinates[d]) < 1e-9) {
        pair.nodes.push_back(Index32(n));
        pair.donor_nodes.push_back(Index32(d));
      }
  }
  mesh.connections = {pair};
  return mesh;
}

/// A floor k_min that moves across two planes and the corner of a third.
Motion floor_across(Rule rule) {
  return motion_of({rule_for({"k_min"}, std::move(rule)), rule_for({"i_min", "j_min", "j_max"}, SlipRule{}),
                    rule_for({"i_max", "k_max"}, FixedRule{})});
}
Rule across() {
  return function([](Vec3 const& p) { return ((6 - p.x) / 6) * Vec3{0.1, 0.05 + 0.02 * p.y, 0.3}; });
}

TEST(GivenSlip, PutsNodesBackOnPlanesEdgesAndCorners) {
  std::vector<Mesh> const meshes{
      to_hexahedra(unit_box({6, 5, 4})), to_prisms_and_tetrahedra(unit_box({6, 5, 4}), 2),
      second_order(to_hexahedra(unit_box({6, 5, 2})), true),
      in_two_zones(to_hexahedra(unit_box({6, 5, 4})), [](Vec3 const& p) { return p.y < 2; })};
  for (Mesh const& mesh : meshes) {
    Case const c(mesh);
    auto const m = c.morph(floor_across(across()), coarse());
    EXPECT_LT(largest_change(c, m.x, "i_min", component(0)), 1e-14) << mesh.source;
    EXPECT_LT(largest_change(c, m.x, "j_min", component(1)), 1e-14) << mesh.source;
    EXPECT_LT(largest_change(c, m.x, "j_max", component(1)), 1e-14) << mesh.source;
    // All else that is given holds, and so does the part along the planes.
    Index held = 0;
    for (std::size_t k = 0; k < m.prepared.plan.known.size(); ++k) {
      Index32 const n = m.prepared.plan.known[k];
      Vec3 const p = c.mesh.coordinates[n], u = m.x[n] - p, asked = m.boundary[k];
      EXPECT_NEAR(u.x, p.x == 0 ? 0 : asked.x, 1e-15) << n;
      EXPECT_NEAR(u.y, p.y == 0 || p.y == 5 ? 0 : asked.y, 1e-15) << n;
      EXPECT_NEAR(u.z, asked.z, 1e-15) << n;
      held += p.y > 0 && p.y < 5 ? 1 : 0;
    }
    EXPECT_GT(held, 20);
    auto const said = trims(m.prepared.boundary, m.boundary);
    EXPECT_GE(said.size(), 3u) << mesh.source;  // patches of both zones are named
    for (Trim const& trim : said) EXPECT_NE(describe(trim).find("they are put back"), std::string::npos);
  }
}

TEST(GivenSlip, PutsNodesBackOnLinesOfAPlaneMesh) {
  Case const c(flat_box(6, 4, 2));
  auto const m = c.morph(motion_of({rule_for({"j_min"}, translation({0.1, 0.05, 0})), rule_for({"i_min"}, SlipRule{}),
                                    rule_for({"i_max"}, FreeRule{}), rule_for({"j_max"}, FixedRule{})}),
                         coarse());
  EXPECT_LT(largest_change(c, m.x, "i_min", component(0)), 1e-14);
  EXPECT_EQ(trims(m.prepared.boundary, m.boundary).size(), 1u);
}

TEST(GivenSlip, LeavesAloneWhatStaysOnItsSurfaces) {
  Case const c(to_hexahedra(unit_box({6, 5, 4})));
  auto const m = c.morph(floor_across(function([](Vec3 const& p) { return Vec3{0, 0, 0.02 * p.x * (6 - p.x)}; })));
  EXPECT_EQ(c.largest_miss(m), 0);
  EXPECT_TRUE(trims(m.prepared.boundary, m.boundary).empty());
}

TEST(GivenSlip, PutsNodesBackOnSurfacesOfRevolution) {
  for (RigidTransform const& frame : {RigidTransform{}, askew()}) {
    Sector const s{
        .inner = 1, .outer = 1.5, .length = 2, .angle = 0.5, .cells = {4, 5, 6}, .frame = frame, .cone = 0.2};
    Case const c(s.mesh());
    // The inlet turns and bulges; its rim is on the shroud.
    Motion motion = motion_of({rule_for({"inlet"}, s.by([](Vec3 const& p) {
                                 return Vec3{0.1 * p.x, 0.05, 0.1};
                               })),
                               rule_for({"shroud"}, SlipRule{SlipRule::Surface::revolution}),
                               rule_for({"hub"}, SlipRule{SlipRule::Surface::revolution}),
                               rule_for({"outlet"}, FixedRule{}), rule_for({"type:periodic"}, FreeRule{})});
    motion.axis = s.axis();
    PlanOptions options = coarse();
    options.elements.walls = {"inlet"};
    auto const m = c.morph(motion, options);
    auto const off = [&](Vec3 const& x) {
      Vec3 const p = s.local(x);
      return std::hypot(p.x, p.y) - s.outer_at(p.z);
    };
    EXPECT_LT(largest_change(c, m.x, "shroud", off), 1e-13);
    EXPECT_FALSE(trims(m.prepared.boundary, m.boundary).empty());
  }
}

TEST(GivenSlip, HoldsInSeveralStepsToo) {
  Case const c(to_hexahedra(unit_box({6, 5, 4})));
  auto m = c.morph(floor_across(across()), coarse());
  MorphPlan const plan = PlanAccess::of(std::move(m.prepared));
  StepOptions options;
  options.plan = coarse();
  options.steps = 2;
  Coordinates const x = morph_in_steps(c.mesh, c.topology, c.face_patches, plan, m.boundary, options);
  EXPECT_LT(largest_change(c, x, "i_min", component(0)), 1e-14);
  EXPECT_LT(largest_change(c, x, "j_max", component(1)), 1e-14);
  for (Index32 const n : c.nodes_of("k_min")) EXPECT_LT(distance(x[n], m.x[n]), 1e-14) << n;
}

TEST(PeriodicAxis, StaysWhereSidesMeetInIt) {
  for (RigidTransform const& frame : {RigidTransform{}, askew()})
    for (double const angle : {std::numbers::pi / 6, std::numbers::pi}) {
      Sector const s{.angle = angle, .cells = {3, 4, 5}, .frame = frame};
      for (bool const twice : {false, angle > 3 && frame.translation.x > 0}) {
        Case const c(twice ? of_second_order(s) : s.mesh());
        // One that is not the same at all angles.
        Motion motion = motion_of(
            {rule_for({"shroud"}, s.by([&](Vec3 const& p) {
               double const bump = std::pow(std::sin(std::numbers::pi * p.z), 2);
               return Vec3{-0.3 * bump * (1 + 0.4 * std::sin(2 * std::numbers::pi * p.y / angle)), 0.1 * bump, 0};
             })),
             rule_for({"inlet", "outlet"}, FixedRule{})});
        motion.axis = s.axis();
        auto const m = c.morph(motion, coarse());
        double off = 0, moved = 0;
        for (Index n = 0; n < c.mesh.n_nodes(); ++n) {
          Vec3 const before = s.local(c.mesh.coordinates[n]), after = s.local(m.x[n]);
          if (std::hypot(before.x, before.y) < 1e-12) off = std::max(off, std::hypot(after.x, after.y));
          moved = std::max(moved, distance(before, after));
        }
        EXPECT_LT(off, 1e-13) << angle << twice;
        EXPECT_LT(s.largest_gap(c.mesh, m.x), 2e-13) << angle << twice;
        EXPECT_GT(moved, 0.3);
        EXPECT_EQ(c.inverted(m.x), 0) << angle << twice;
      }
    }
}

TEST(PeriodicAxis, StaysOnAWallAcrossIt) {
  for (RigidTransform const& frame : {RigidTransform{}, askew()}) {
    Sector const s{.cells = {3, 3, 5}, .frame = frame};
    Case const c(s.mesh());
    Motion motion =
        motion_of({rule_for({"shroud"}, s.by([](Vec3 const& p) {
                     return Vec3{-0.1 * p.z, 0, 0.2 * p.z + 0.05};
                   })),
                   rule_for({"inlet"}, SlipRule{SlipRule::Surface::revolution}), rule_for({"outlet"}, FreeRule{})});
    motion.axis = s.axis();
    auto const m = c.morph(motion, coarse());
    EXPECT_LT(largest_change(c, m.x, "inlet", [&](Vec3 const& x) { return s.local(x).z; }), 1e-13);
    double off = 0;
    for (Index n = 0; n < c.mesh.n_nodes(); ++n) {
      Vec3 const before = s.local(c.mesh.coordinates[n]), after = s.local(m.x[n]);
      if (std::hypot(before.x, before.y) < 1e-12) off = std::max(off, std::hypot(after.x, after.y));
    }
    EXPECT_LT(off, 1e-13);
  }
  // A node on the axis comes back along it, and so do rates and gradients.
  TurnedProfile const profile = TurnedProfile::from_points({{0, 0}, {0, 0.25}, {0, 0.5}, {0, 0.75}, {0, 1}});
  SlipSurface wall;
  wall.kind = SlipKind::meridional;
  wall.direction = {0, 0, 1};
  wall.profile = profile.profile;
  wall.frame = profile.frame;
  wall.size = 1;
  auto const view = wall.view();
  Vec3 const u{0, 0, 0.3}, g{1, 2, 3}, along{1, 2, 0};
  EXPECT_LT(norm(view.constrain({}, u)), 1e-15);
  EXPECT_LT(norm(view.project(u)), 1e-15);
  EXPECT_LT(distance(view.constrain_rate({}, 0, u, g), along), 1e-15);
  EXPECT_LT(distance(kernels::slip_gradient(view, {}, 0, u, g), along), 1e-15);
}

TEST(PeriodicAxis, IsNotHeldWhereARuleMovesItsNodes) {
  Sector const s{.frame = askew()};
  Case const c(s.mesh());
  Motion motion = motion_of({rule_for({"shroud", "inlet", "outlet", "type:periodic"}, translation({0.1, 0.2, 0.3}))});
  motion.axis = s.axis();
  // All of the boundary goes along, and so does the mesh: but sides that turn into one another are no copies after
  // that.
  EXPECT_THROW((void)c.morph(motion), MotionError);
  motion.rules[0].rule = translation(0.3 * s.axis().direction);
  auto const m = c.morph(motion, coarse());
  for (Index n = 0; n < c.mesh.n_nodes(); ++n)
    EXPECT_LT(distance(m.x[n] - c.mesh.coordinates[n], 0.3 * s.axis().direction), 1e-14) << n;
}

TEST(PeriodicSlip, KeepsCopiesAndTheirSurface) {
  for (RigidTransform const& frame : {RigidTransform{}, askew()})
    for (double const cone : {0.0, 0.3}) {
      Sector const s{
          .inner = 1, .outer = 1.5, .angle = std::numbers::pi / 9, .cells = {4, 5, 8}, .frame = frame, .cone = cone};
      Case const c(s.mesh());
      Motion motion = motion_of({rule_for({"hub"}, s.by([](Vec3 const& p) {
                                   double const bump = std::pow(std::sin(std::numbers::pi * p.z), 2);
                                   return Vec3{0.15 * bump * (1 + 0.5 * std::cos(18 * p.y)), 0.17 * bump, 0.05 * bump};
                                 })),
                                 rule_for({"shroud"}, SlipRule{SlipRule::Surface::revolution}),
                                 rule_for({"inlet", "outlet"}, FixedRule{})});
      motion.axis = s.axis();
      auto const m = c.morph(motion, coarse());
      auto const off = [&](Vec3 const& x) {
        Vec3 const p = s.local(x);
        return std::hypot(p.x, p.y) - s.outer_at(p.z);
      };
      EXPECT_LT(largest_change(c, m.x, "shroud", off), 1e-13) << cone;
      EXPECT_LT(s.largest_gap(c.mesh, m.x), 1e-13) << cone;
      double slid = 0;
      for (Index32 const n : c.nodes_of("shroud")) slid = std::max(slid, distance(m.x[n], c.mesh.coordinates[n]));
      EXPECT_GT(slid, 0.003);
    }
}

TEST(PeriodicSlip, HoldsWhereOneSideAloneSlips) {
  // The images of nodes on a plane are on none: they keep to it all the same.
  Mesh mesh = to_hexahedra(unit_box({6, 4, 4}));
  Connection pair;
  pair.name = "pair";
  pair.zone = pair.donor_zone = 0;
  pair.periodic = periodic_translation({0, 4, 0});
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    for (Index d = 0; d < mesh.n_nodes() && mesh.coordinates[n].y == 0; ++d)
      if (mesh.coordinates[d] == mesh.coordinates[n] + Vec3{0, 4, 0}) {
        pair.nodes.push_back(Index32(n));
        pair.donor_nodes.push_back(Index32(d));
      }
  mesh.connections.push_back(pair);
  // The plane i_max is a patch of the lower half alone.
  for (Patch& patch : mesh.patches)
    if (patch.name == "i_max") {
      CsrGraph kept, rest;
      for (Index f = 0; f < patch.faces.size(); ++f) {
        double y = 0;
        for (Index32 const v : patch.faces[f]) y = std::max(y, mesh.coordinates[v].y);
        (y < 3 ? kept : rest).add(patch.faces[f]);
      }
      patch.faces = kept;
      Patch other = patch;
      other.name = "rest";
      other.faces = rest;
      mesh.patches.push_back(other);
      break;
    }
  Case const c(mesh);
  auto const m = c.morph(motion_of({rule_for({"k_min"}, translation({0.2, 0, 0.4})), rule_for({"i_max"}, SlipRule{}),
                                    rule_for({"i_min", "rest", "k_max"}, FreeRule{})}));
  EXPECT_LT(largest_change(c, m.x, "i_max", component(0)), 1e-14);
  for (std::size_t n = 0; n < pair.nodes.size(); ++n)
    EXPECT_LT(distance(m.x[pair.nodes[n]] + Vec3{0, 4, 0}, m.x[pair.donor_nodes[n]]), 1e-14) << n;
  double free = 0;
  for (Index32 const n : c.nodes_of("rest")) free = std::max(free, std::abs(m.x[n].x - 6));
  EXPECT_GT(free, 0.01) << "nodes beside the plane are not held";
}

TEST(JointSlip, HasExactRates) {
  Sector const axis{.cells = {4, 3, 6}, .frame = askew()};
  Sector const ring{.inner = 1, .outer = 1.5, .angle = 0.4, .cells = {3, 3, 6}, .frame = askew(), .cone = 0.2};
  for (Sector const& s : {axis, ring}) {
    Case const c(s.mesh());
    std::string const wall = s.meets() ? "shroud" : "hub";
    std::vector<MotionRule> rules{rule_for({wall}, translation({0.01, 0, 0})),
                                  rule_for({"inlet", "outlet"}, FixedRule{})};
    if (!s.meets()) rules.push_back(rule_for({"shroud"}, SlipRule{SlipRule::Surface::revolution}));
    Motion motion = motion_of(rules);
    motion.axis = s.axis();
    motion.rules[0].rule = s.by([](Vec3 const& p) { return Vec3{0.01 * p.z, 0, 0}; });
    PlanOptions options = coarse();
    options.elements.motion = 0.2;
    auto const prepared = prepare(c.mesh, c.topology, c.face_patches, motion, options);
    // Inlet and outlet too, which end on the shroud.
    auto const now = [&](double t) {
      std::vector<Vec3> u;
      for (Index32 const n : prepared.plan.known) {
        Vec3 const p = s.local(c.mesh.coordinates[n]);
        u.push_back((0.5 + t) *
                    (0.1 * std::sin(3 * p.z) * ((s.frame.rotation * Vec3{p.x, p.y, 0}) + 0.3 * s.axis().direction)));
      }
      return u;
    };
    auto const rate = rate_error(c, prepared.plan, now);
    EXPECT_GT(rate.largest, 0.03) << wall;
    EXPECT_LT(rate.error, 1e-8 * rate.largest) << wall;
  }
}

}  // namespace
}  // namespace gridmorph::test
