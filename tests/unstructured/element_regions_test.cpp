// Regions inside meshes of elements: what rules name by zones, subsets and places moves as they say, nothing else is
// held.
#include "support/expect_error.hpp"
#include "support/made_bodies.hpp"
#include "support/unstructured_case.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/morph/morph.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace gridmorph::test {
namespace {

bool amid(Vec3 const& p) { return std::abs(p.x - 5) < 1 && std::abs(p.y - 5) < 1; }

/// A bar in a box; the two rings of elements around the bar are the subset "rotor", faces above them at x = 2 the
/// subset "cut".
UnstructuredCase made(bool tetrahedra) {
  Mesh mesh = box_around({10, 10, 4}, amid, tetrahedra);
  Subset rotor{"rotor", {}}, cut{"cut", {}};
  std::array<Index32, max_face_corners> room{};
  for (Index e = 0; e < mesh.n_elements(); ++e) {
    Vec3 centre;
    auto const corners = mesh.elements.corners(e);
    for (Index32 const n : corners) centre += (1 / double(corners.size())) * mesh.coordinates[n];
    if (std::abs(centre.x - 5) < 3 && std::abs(centre.y - 5) < 3) rotor.elements.push_back(Index32(e));
    for (int s = 0; s < n_sides(mesh, e); ++s) {
      auto const side = side_nodes(mesh, e, s, room);
      if (std::ranges::all_of(side, [&](Index32 n) { return mesh.coordinates[n].x == 1; })) cut.faces.add(side);
    }
  }
  mesh.subsets = {std::move(rotor), std::move(cut)};
  return UnstructuredCase(std::move(mesh));
}

InnerRegion region(std::string name, std::vector<std::string> zones, std::function<bool(Vec3 const&)> holds = {}) {
  InnerRegion out;
  out.name = std::move(name);
  out.zones = std::move(zones);
  out.holds = std::move(holds);
  return out;
}

Motion turning(double angle, std::vector<InnerRegion> regions) {
  Motion motion = motion_of({rule_for({"body"}, rotation({5, 5, 0}, {0, 0, 1}, angle)),
                             rule_for({"i_min", "i_max", "j_min", "j_max"}, FixedRule{}),
                             rule_for({"k_min", "k_max"}, SlipRule{})});
  motion.regions = std::move(regions);
  return motion;
}

std::set<Index32> nodes_of(Mesh const& mesh, std::vector<Index32> const& elements) {
  std::set<Index32> out;
  for (Index32 const e : elements)
    for (Index32 const n : mesh.elements.nodes[e]) out.insert(n);
  return out;
}

TEST(ElementRegions, ASubsetMovesAsItsRuleSays) {
  for (bool const tetrahedra : {false, true}) {
    UnstructuredCase const c = made(tetrahedra);
    double const angle = 0.3;
    Motion motion = turning(angle, {region("rotor zone", {"rot*"})});
    motion.rules.push_back(rule_for({"rotor zone"}, rotation({5, 5, 0}, {0, 0, 1}, angle)));
    auto const m = c.morph(motion);
    EXPECT_EQ(c.largest_miss(m), 0);
    EXPECT_TRUE(std::ranges::any_of(m.prepared.notes, [&](std::string const& note) {
      return note.find("region 'rotor zone': " + std::to_string(c.mesh.subsets[0].elements.size())) !=
             std::string::npos;
    }));
    RigidTransform const turn = rotation_about({5, 5, 0}, {0, 0, 1}, angle);
    auto const inside = nodes_of(c.mesh, c.mesh.subsets[0].elements);
    Index moved = 0;
    for (Index n = 0; n < c.mesh.n_nodes(); ++n) {
      Vec3 const x = c.mesh.coordinates[n];
      if (inside.contains(Index32(n))) {
        ASSERT_LT(distance(m.x[n], turn(x)), 1e-12) << n;
      } else {
        moved += distance(m.x[n], x) > 1e-6 ? 1 : 0;
      }
    }
    EXPECT_GT(moved, 0) << "what is around goes along";
    EXPECT_EQ(c.inverted(m.x), 0);
    // The library's own call takes the same road.
    MorphPlan const plan(c.mesh, motion);
    EXPECT_EQ(plan.boundary_displacement().size(), m.boundary.size());
  }
}

TEST(ElementRegions, PlacesAndZonesTogetherAndRegionsThatNoRuleNames) {
  UnstructuredCase const c = made(false);
  // Half of the subset, and by default regions are held.
  auto const half = [](Vec3 const& p) { return p.x > 7; };
  auto const m = c.morph(turning(0.1, {region("half", {"rotor"}, half), region("sheet", {"cut"})}));
  Index held = 0;
  for (Index n = 0; n < c.mesh.n_nodes(); ++n) {
    Vec3 const x = c.mesh.coordinates[n];
    bool const in_half = x.x >= 7 && x.x <= 8 && x.y >= 2 && x.y <= 8, in_sheet = x.x == 1;
    if (!in_half && !in_sheet) continue;
    ASSERT_EQ(m.x[n], x) << n;
    ++held;
  }
  EXPECT_EQ(held, (2 * 7 + 11) * 5);
  EXPECT_EQ(c.inverted(m.x), 0);
}

TEST(ElementRegions, NoMotionLeavesEveryBit) {
  UnstructuredCase const c = made(true);
  Motion motion = turning(0, {region("rotor zone", {"rotor"})});
  motion.rules.push_back(rule_for({"rotor zone"}, rotation({5, 5, 0}, {0, 0, 1}, 0)));
  auto const m = c.morph(motion);
  for (Index n = 0; n < c.mesh.n_nodes(); ++n) ASSERT_EQ(m.x[n], c.mesh.coordinates[n]) << n;
}

TEST(ElementRegions, WhatIsWrongIsSaidTogether) {
  UnstructuredCase const c = made(false);
  InnerRegion nodes = region("box", {});
  nodes.nodes = IndexRange{{0, 0, 0}, {2, 2, 2}};
  std::string const text = message_of<MotionError>([&] {
    (void)c.morph(turning(0.1, {region("a", {"rotr"}), region("body", {"rotor"}), nodes,
                                region("far", {"rotor"}, [](Vec3 const&) { return false; })}));
  });
  expect_all_in(text, {"'rotr'", "'rotor'", "'cut'", "region 'body'", "the name is that of a patch", "region 'box'",
                       "region 'far'", "holds no element"});
  Motion slipping = turning(0.1, {region("rotor zone", {"rotor"})});
  slipping.rules.push_back(rule_for({"rotor zone"}, SlipRule{}));
  expect_all_in(message_of<MotionError>([&] { (void)c.morph(slipping); }), {"rotor zone", "fixed, rigid, formula"});
}

}  // namespace
}  // namespace gridmorph::test
