// Files that list a periodic boundary twice, as a patch and as a connection: the patch does not hold what the
// connection lets go.
#include "support/morph_run.hpp"
#include "support/sector.hpp"
#include "support/unstructured_case.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/motion/boundary_conditions.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace gridmorph::test {
namespace {

/// A channel, periodic from i_min to i_max, whose lid j_max moves along.
struct PeriodicChannel {
  Mesh mesh = flat_box(6, 4, 2);
  Motion motion;

  PeriodicChannel() {
    Connection c;
    c.name = "pair";
    c.zone = c.donor_zone = 0;
    c.periodic.emplace();
    c.periodic->translation = {6, 0, 0};
    for (double y = 0; y <= 4; ++y) {
      c.nodes.push_back(at(0, y));
      c.donor_nodes.push_back(at(6, y));
    }
    mesh.connections.push_back(c);
    motion.rules.push_back({{"j_max"}, RigidRule{{}, {0.3, 0, 0}}, 0, "test"});
  }
  [[nodiscard]] Index32 at(double x, double y) const {
    for (Index32 n = 0; n < mesh.n_nodes(); ++n)
      if (mesh.coordinates[n].x == x && mesh.coordinates[n].y == y) return n;
    return -1;
  }
  [[nodiscard]] BoundaryConditions conditions() const {
    auto const topology = make_topology(mesh);
    return boundary_conditions(mesh, topology, find_face_patches(mesh, topology),
                               make_node_graph(mesh, topology.elements_of_nodes), motion, {});
  }
  [[nodiscard]] bool holds(BoundaryConditions const& b, double x, double y) const {
    return std::binary_search(b.known.begin(), b.known.end(), at(x, y));
  }
};

TEST(PeriodicPatches, AreFreeWhereNoRuleNamesThem) {
  PeriodicChannel const c;
  auto const b = c.conditions();
  for (double const x : {0., 6.}) EXPECT_FALSE(c.holds(b, x, 2)) << x;
  EXPECT_TRUE(c.holds(b, 3, 0));
  EXPECT_TRUE(c.holds(b, 0, 4));
  EXPECT_EQ(b.images.size(), 3u);  // at the ends both nodes are held
  EXPECT_TRUE(std::any_of(b.notes.begin(), b.notes.end(), [](std::string const& note) {
    return note.find("'i_min', 'i_max'") != std::string::npos && note.find("free") != std::string::npos;
  }));
}

TEST(PeriodicPatches, ObeyARuleThatNamesThem) {
  PeriodicChannel c;
  c.motion.rules.push_back({{"i_*"}, FixedRule{}, 1, "test"});
  auto const b = c.conditions();
  for (double const x : {0., 6.}) EXPECT_TRUE(c.holds(b, x, 2)) << x;
}

TEST(PeriodicPatches, HaveTheRuleOfEitherSideOrOfTheirConnection) {
  Sector const s{.inner = 1, .outer = 1.5, .angle = 0.4, .cells = {2, 3, 4}};
  auto const hub = [](Vec3 const& p) { return Vec3{std::pow(p.z * (1 - p.z), 2), 0.1 * p.z, 0}; };
  auto const sides = [&](Vec3 const& p) { return Vec3{2 * std::pow(p.z * (1 - p.z), 2) * (1.5 - p.x), 0.1 * p.z, 0}; };
  auto const turned = [](Vec3 const& p) { return Vec3{0, 0.1 * p.z, 0}; };
  for (Rule const& rule : {s.by(sides), Rule(FixedRule{})}) {
    bool const fixed = std::holds_alternative<FixedRule>(rule);
    std::vector<Coordinates> moved;
    std::vector<std::vector<Index32>> known;
    for (auto const& names : std::vector<std::vector<std::string>>{
             {"type:periodic"}, {"pair"}, {"per1"}, {"per2"}, {"per1", "per2"}, {"per?"}}) {
      UnstructuredCase const c(s.mesh());
      PlanOptions coarse;
      coarse.elements.cells = 1;
      Rule const moves = fixed ? s.by([&](Vec3 const& p) { return Vec3{hub(p).x, 0, 0}; }) : s.by(hub);
      Rule const ends = fixed ? Rule(FixedRule{}) : s.by(turned);
      auto const m = c.morph(
          motion_of(
              {rule_for({"hub"}, moves), {names, rule, 1, "test"}, {{"shroud", "inlet", "outlet"}, ends, 1, "test"}}),
          coarse);
      moved.push_back(m.x);
      known.push_back(m.prepared.plan.known);
      EXPECT_EQ(known.back(), known.front()) << names.front();
      EXPECT_EQ(different_bits(moved.back(), moved.front()), 0) << names.front();
      EXPECT_TRUE(m.prepared.plan.images.empty()) << names.front();
      for (std::string const& note : m.prepared.notes) EXPECT_EQ(note.find("move freely as one"), std::string::npos);
      EXPECT_LT(s.largest_gap(c.mesh, m.x), 1e-14);
    }
  }
}

TEST(PeriodicPatches, HaveTheirRuleOfHalosToo) {
  // Cells 6 to 7 are copies of those from 0 to 1, as SU2's own files have them.
  Mesh mesh = flat_box(7, 4, 2);
  auto const at = [&](double x, double y) {
    for (Index32 n = 0; n < mesh.n_nodes(); ++n)
      if (mesh.coordinates[n].x == x && mesh.coordinates[n].y == y) return n;
    return Index32(-1);
  };
  for (double const x : {0., 1.}) {
    Connection c;
    c.name = x == 0 ? "sides" : "halo";
    c.zone = c.donor_zone = 0;
    c.periodic = periodic_translation({6, 0, 0});
    for (double y = 0; y <= 4; ++y) {
      c.nodes.push_back(at(x, y));
      c.donor_nodes.push_back(at(x + 6, y));
    }
    mesh.connections.push_back(c);
  }
  for (Patch& patch : mesh.patches)
    if (patch.name == "i_max") {
      patch.faces = {};
      for (double y = 0; y < 4; ++y) patch.faces.add(std::vector<Index32>{at(6, y), at(6, y + 1)});
    }
  UnstructuredCase const c(mesh);
  for (std::string const name : {"type:periodic", "i_min", "i_max", "i_*"}) {
    Motion const motion = motion_of({rule_for({"j_max"}, translation({0.3, 0, 0})), {{name}, FixedRule{}, 1, "test"}});
    auto const b = boundary_conditions(c.mesh, c.topology, c.face_patches,
                                       make_node_graph(c.mesh, c.topology.elements_of_nodes), motion, {});
    for (double const x : {0., 1., 6., 7.})
      EXPECT_TRUE(std::binary_search(b.known.begin(), b.known.end(), at(x, 2))) << name << x;
    EXPECT_FALSE(std::binary_search(b.known.begin(), b.known.end(), at(3, 2)));
  }
}

TEST(PeriodicPatches, KeepDifferentRulesOnTheirSides) {
  PeriodicChannel c;
  c.motion.rules.push_back({{"i_min"}, FixedRule{}, 1, "one"});
  c.motion.rules.push_back({{"i_max"}, RigidRule{{}, {0, 0, 0}}, 1, "another"});
  auto const b = c.conditions();
  for (double const x : {0., 6.}) EXPECT_TRUE(c.holds(b, x, 2)) << x;
  EXPECT_EQ(b.motion->motion().interface[0].rule, -1);
}

TEST(PeriodicPatches, RefuseARuleThatTearsTheirCopiesWhicheverSideHasIt) {
  for (std::string const name : {"i_min", "i_max", "i_*", "pair", "type:periodic"}) {
    PeriodicChannel c;
    c.motion.rules.push_back({{name},
                              FunctionRule{"by place",
                                           [](std::span<Vec3 const> x, std::span<Vec3> u) {
                                             for (std::size_t n = 0; n < x.size(); ++n) u[n] = {0.01 * x[n].x, 0, 0};
                                           }},
                              1,
                              "test"});
    auto const b = c.conditions();
    EXPECT_THROW((void)evaluate(b), MotionError) << name;
  }
}

TEST(PeriodicPatches, TakeCopiesInSinglePrecisionForEqual) {
  Sector const s{.inner = 1, .outer = 1.5, .angle = 0.4, .cells = {3, 4, 6}};
  Mesh mesh = s.mesh();
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    Vec3 const p = mesh.coordinates[n];
    mesh.coordinates.set(n, {double(float(p.x)), double(float(p.y)), double(float(p.z))});
  }
  // Unlike by a thousandth of a degree is more than rounding.
  for (double const unlike : {0.0, 1e-5}) {
    Motion const motion = motion_of({rule_for({"hub"}, s.by([&](Vec3 const& p) {
                                       return Vec3{0.1 * std::sin(3 * p.z), 0.1 + unlike * p.y, 0};
                                     })),
                                     rule_for({"shroud", "inlet", "outlet"}, FreeRule{})});
    UnstructuredCase const c(mesh);
    auto const b = boundary_conditions(c.mesh, c.topology, c.face_patches,
                                       make_node_graph(c.mesh, c.topology.elements_of_nodes), motion, {});
    if (unlike == 0)
      EXPECT_NO_THROW((void)evaluate(b));
    else
      EXPECT_THROW((void)evaluate(b), MotionError);
  }
}

TEST(PeriodicPatches, ThatAreOnlyPartlyPairedStayFixed) {
  PeriodicChannel c;
  auto& pair = c.mesh.connections.front();
  pair.nodes.pop_back();
  pair.donor_nodes.pop_back();
  auto const b = c.conditions();
  for (double const x : {0., 6.}) EXPECT_TRUE(c.holds(b, x, 2)) << x;
}

}  // namespace
}  // namespace gridmorph::test
