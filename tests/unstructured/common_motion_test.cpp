// Motions that all boundaries have in common, and parts that nothing connects.
#include "support/made_bodies.hpp"
#include "support/reduced.hpp"
#include "support/unstructured_case.hpp"
#include "support/unstructured_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <numbers>
#include <ostream>
#include <string>
#include <vector>

namespace gridmorph::test {
namespace {

using Case = UnstructuredCase;
using Map = std::function<Vec3(Vec3 const&)>;

bool in_the_middle(Vec3 const& p) { return norm(p - Vec3{3.5, 3.6, 3.2}) < 1.3; }

Mesh sheared(Mesh mesh) {
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    Vec3 const p = mesh.coordinates[n];
    mesh.coordinates.set(n, {p.x + 0.3 * p.y + 0.02 * p.z * p.z, 0.9 * p.y + 0.05 * p.x, p.z + 0.1 * std::sin(p.x)});
  }
  return mesh;
}

/// One mesh after another: zones with nodes of their own. The names of its patches get `suffix`.
void append(Mesh& to, Mesh const& from, std::string const& suffix, Vec3 const& shift) {
  Coordinates const before = to.coordinates;
  for (Zone const& zone : from.zones) {
    int const z = to.add_zone(zone.name + suffix, zone.size());
    auto const moved = [&](std::span<Index32 const> nodes) {
      std::vector<Index32> out;
      for (Index32 const n : nodes) out.push_back(Index32(n - zone.first_node + to.zones[z].first_node));
      return out;
    };
    for (Index e = zone.first_element; e < zone.first_element + zone.n_elements; ++e)
      to.add_element(from.elements.type[e], moved(from.elements.nodes[e]));
    for (Patch const& patch : from.patches) {
      if (&from.zones[patch.zone] != &zone) continue;
      Patch own = patch;
      own.name += suffix;
      own.zone = z;
      own.faces = {};
      for (Index f = 0; f < patch.faces.size(); ++f) own.faces.add(moved(patch.faces[f]));
      own.nodes = moved(patch.nodes);
      to.patches.push_back(std::move(own));
    }
  }
  to.coordinates = Coordinates(to.n_nodes());
  for (Index n = 0; n < before.size(); ++n) to.coordinates.set(n, before[n]);
  for (Index n = 0; n < from.n_nodes(); ++n) to.coordinates.set(before.size() + n, from.coordinates[n] + shift);
}

struct Kind {
  std::string name;
  std::function<Mesh()> mesh;
  friend std::ostream& operator<<(std::ostream& out, Kind const& k) { return out << k.name; }
};

std::vector<Kind> kinds() {
  auto const box = [] { return sheared(box_around({7, 7, 7}, in_the_middle)); };
  return {{"hexahedra", box},
          {"tetrahedra",
           [] {
             return sheared(box_around({7, 7, 7}, in_the_middle, true));
           }},
          {"second_order",
           [=] {
             return second_order(box(), true, [](Vec3 const& p) { return Vec3{p.x + 0.01 * p.y * p.y, p.y, p.z}; });
           }},
          {"polyhedra", [=] { return as_polyhedra(box()); }},
          {"two_zones", [=] { return in_two_zones(box(), [](Vec3 const& p) { return p.x < 4; }); }},
          {"airfoil", [] { return airfoil(48, 3, 0.002, 1.3, 4); }},
          {"two_bodies",
           [] {
             return box_around({9, 6, 5}, [](Vec3 const& p) {
               return p.y > 2 && p.y < 4 && p.z > 2 && p.z < 3 && ((p.x > 2 && p.x < 4) || (p.x > 6 && p.x < 7));
             });
           }},
          {"periodic", [] { return periodic_flat_box(8, 5, 2); }}};
}

Rule moves_as(Map const& map) {
  return FunctionRule{"map", [map](std::span<Vec3 const> x, std::span<Vec3> u) {
                        for (std::size_t n = 0; n < x.size(); ++n) u[n] = map(x[n]) - x[n];
                      }};
}

/// Within the planes z = constant, so that the same serve in 2-D.
std::vector<std::pair<std::string, Map>> motions(bool in_space) {
  std::vector<std::pair<std::string, Map>> out;
  for (double const degrees : {5., 180.}) {
    RigidTransform const r =
        rotation_about({3, -2, 0}, in_space ? Vec3{1, 2, 3} : Vec3{0, 0, 1}, degrees * std::numbers::pi / 180);
    out.emplace_back("turned by " + std::to_string(degrees), [r](Vec3 const& p) { return r(p); });
  }
  for (double const s : {1e-3, 1000.})
    out.emplace_back("scaled by " + std::to_string(s), [s](Vec3 const& p) { return Vec3{s * p.x, s * p.y, s * p.z}; });
  out.emplace_back("sheared", [](Vec3 const& p) { return Vec3{p.x + 0.7 * p.y, p.y - 0.2 * p.x, p.z}; });
  out.emplace_back("sheared along x", [](Vec3 const& p) { return Vec3{p.x + 0.7 * p.y, 1.3 * p.y, p.z}; });
  return out;
}

double size_of(Coordinates const& x) {
  Vec3 low = x[0], high = x[0];
  for (Index n = 0; n < x.size(); ++n) {
    low = {std::min(low.x, x[n].x), std::min(low.y, x[n].y), std::min(low.z, x[n].z)};
    high = {std::max(high.x, x[n].x), std::max(high.y, x[n].y), std::max(high.z, x[n].z)};
  }
  return distance(low, high);
}

/// How far nodes are from where a map takes them, in sizes of the mesh that it makes.
double distance_from(Coordinates const& x, Coordinates const& baseline, Map const& map) {
  double largest = 0;
  for (Index n = 0; n < x.size(); ++n) largest = std::max(largest, distance(x[n], map(baseline[n])));
  return largest / size_of(x);
}

/// A coarse background: the stages are the same.
PlanOptions coarse() {
  PlanOptions options;
  options.elements.cells = 1;
  return options;
}

class CommonMotionOf : public ::testing::TestWithParam<Kind> {};

TEST_P(CommonMotionOf, AllBoundariesIsThatOfTheMesh) {
  Case const c(GetParam().mesh());
  bool const in_space = c.mesh.dimension == 3;
  QualityRegion const before = c.quality(c.mesh.coordinates);
  for (auto const& [name, map] : motions(in_space)) {
    if (reduced() && (name.starts_with("scaled") || name == "sheared")) continue;
    bool const periodic = !c.mesh.connections.empty() && c.mesh.connections.front().periodic;
    if (periodic != (name == "sheared along x")) continue;  // other maps would tear copies a pitch apart along x
    std::vector<std::string> patches{"*"};
    if (periodic) patches.emplace_back("type:periodic");
    auto const m = c.morph(motion_of({rule_for(patches, moves_as(map))}), coarse());
    EXPECT_LE(distance_from(m.x, c.mesh.coordinates, map), 1e-12) << name;
    EXPECT_EQ(c.largest_miss(m), 0) << name;
    if (name.starts_with("sheared")) continue;
    QualityRegion const after = c.quality(m.x);
    EXPECT_NEAR(after[Measure::determinant_3x3x3].min, before[Measure::determinant_3x3x3].min, 1e-10) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Of, CommonMotionOf, ::testing::ValuesIn(kinds()),
                         [](auto const& info) { return info.param.name; });

TEST(CommonMotion, KeepsPlanesThatNodesSlideOn) {
  Case const c(box_around({7, 7, 7}, in_the_middle));
  RigidTransform const r = rotation_about({3, -2, 0}, {0, 0, 1}, 1.2);
  Map const map = [&](Vec3 const& p) { return r(Vec3{1.5 * p.x, 1.5 * p.y, p.z}); };
  auto const m = c.morph(
      motion_of({rule_for({"body", "i_*", "j_*"}, moves_as(map)), rule_for({"k_min", "k_max"}, SlipRule{})}), coarse());
  EXPECT_LE(distance_from(m.x, c.mesh.coordinates, map), 1e-12);
}

TEST(CommonMotion, TurnsAboutTheAxisOfASurfaceOfRevolutionAndOfPeriodicSides) {
  Mesh mesh = periodic_flat_box(8, 5, 2);
  EXPECT_EQ(mesh.dimension, 2);
  // A fan: the sides of the box, a pair by translation, become one by rotation about the origin.
  double const pitch = 0.6, step = pitch / 8;
  auto const fan = [&](Vec3 const& p) {
    return Vec3{(3 + p.y) * std::cos(step * p.x), (3 + p.y) * std::sin(step * p.x), p.z};
  };
  for (Index n = 0; n < mesh.n_nodes(); ++n) mesh.coordinates.set(n, fan(mesh.coordinates[n]));
  for (auto& connection : mesh.connections) {
    Vec3 const a = mesh.coordinates[connection.nodes.front()], b = mesh.coordinates[connection.donor_nodes.front()];
    connection.periodic = periodic_rotation({0, 0, 0}, {0, 0, 1}, std::atan2(b.y, b.x) - std::atan2(a.y, a.x));
  }
  Case const c(mesh);
  for (double const degrees : {5., 90., 180.}) {
    RigidTransform const r = rotation_about({0, 0, 0}, {0, 0, 1}, degrees * std::numbers::pi / 180);
    Map const map = [&](Vec3 const& p) { return r(p); };
    auto const m = c.morph(motion_of({rule_for({"j_min", "j_max"}, moves_as(map))}));
    EXPECT_LE(distance_from(m.x, c.mesh.coordinates, map), 1e-12) << degrees;
  }
}

TEST(CommonMotion, IsThatOfColumnsOnWallsThatSlideToo) {
  // Walls of no kind, on which nodes slide, have columns that go along with them.
  Mesh mesh = box_around({7, 7, 7}, in_the_middle);
  for (Patch& patch : mesh.patches)
    if (patch.name.starts_with("k_")) patch.kind = PatchKind::wall;
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    Vec3 const p = mesh.coordinates[n];
    mesh.coordinates.set(n, {p.x, p.y, p.z < 2 ? 0.1 * p.z : p.z});
  }
  Case const c(mesh);
  RigidTransform const r = rotation_about({3, -2, 0}, {0, 0, 1}, 1.2);
  Map const map = [&](Vec3 const& p) { return r(Vec3{p.x, p.y, 0.5 * p.z}); };
  auto const scaled = c.morph(
      motion_of({rule_for({"body", "i_*", "j_*", "k_max"}, moves_as(map)), rule_for({"k_min"}, SlipRule{})}), coarse());
  ASSERT_FALSE(scaled.prepared.plan.parts.front().plan->sliding.empty());
  EXPECT_LE(distance_from(scaled.x, c.mesh.coordinates, map), 1e-12);
}

TEST(CommonMotion, IsTakenOffWhereWallsMoveBesideIt) {
  // Turned as a whole, and the body by a little besides: as the little turn alone, seen from the frame that turns, but
  // for what is small of second order.
  Case const c(box_around({7, 7, 7}, in_the_middle));
  RigidTransform const whole = rotation_about({4, 4, 4}, {1, 2, 3}, 1.3),
                       little = rotation_about({3.5, 3.6, 3.2}, {0, 1, 1}, 0.01);
  auto const both =
      c.morph(motion_of({rule_for({"body"}, moves_as([&](Vec3 const& p) { return whole(little(p)); })),
                         rule_for({"?_min", "?_max"}, moves_as([&](Vec3 const& p) { return whole(p); }))}),
              coarse());
  auto const alone =
      c.morph(motion_of({rule_for({"body"}, moves_as([&](Vec3 const& p) { return little(p); }))}), coarse());
  double largest = 0, moved = 0;
  for (Index n = 0; n < c.mesh.n_nodes(); ++n) {
    largest = std::max(largest, distance(both.x[n], whole(alone.x[n])));
    moved = std::max(moved, distance(alone.x[n], c.mesh.coordinates[n]));
  }
  EXPECT_GT(moved, 0.01);
  EXPECT_LT(largest, 0.02 * moved);
  EXPECT_EQ(c.largest_miss(both), 0);
}

TEST(CommonMotion, IsNoneWhereABoundaryStands) {
  Case const c(box_around({7, 7, 7}, in_the_middle));
  auto const prepared = prepare(
      c.mesh, c.topology, c.face_patches,
      motion_of({rule_for({"body"}, rotation({0, 0, 0}, {0, 0, 1}, 0.2)), rule_for({"?_min", "?_max"}, FixedRule{})}),
      coarse());
  EXPECT_TRUE(prepared.plan.parts.empty());
}

TEST(CommonMotion, OfOneSideOfAnInterfaceIsThatOfItsInside) {
  // A block of its own zone fills the hole of another one; what moves the interface moves the block as a whole.
  auto const hole = [](Vec3 const& p) { return p.x > 2 && p.x < 5 && p.y > 2 && p.y < 5 && p.z > 2 && p.z < 5; };
  Mesh mesh = sheared(box_around({7, 7, 7}, hole));
  append(mesh, sheared(box_around({7, 7, 7}, [&](Vec3 const& p) { return !hole(p); })), " inside", {});
  Case const c(mesh);
  RigidTransform const r = rotation_about({5, 5, 4}, {0.2, 0.1, 1}, std::numbers::pi / 2);
  Map const map = [&](Vec3 const& p) { return r(p); };
  auto const m = c.morph(motion_of({rule_for({"body", "body inside"}, moves_as(map))}), coarse());
  Index const first = c.mesh.zones[1].first_node;
  double inside = 0, outside = 0;
  for (Index n = 0; n < c.mesh.n_nodes(); ++n) {
    double const d = distance(m.x[n], map(c.mesh.coordinates[n]));
    (n < first ? outside : inside) = std::max(n < first ? outside : inside, d);
  }
  EXPECT_LE(inside, 1e-12 * c.mesh.size());
  EXPECT_GT(outside, 0.5);
}

bool equal_bits(Vec3 const& a, Vec3 const& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

TEST(MeshParts, DoNotMoveOneAnother) {
  Mesh const one = sheared(box_around({7, 7, 7}, in_the_middle));
  MotionRule const turns = rule_for({"body"}, rotation({3.5, 3.6, 3.2}, {1, 2, 3}, 0.5));
  Case const alone(one);
  auto const expected = alone.morph(motion_of({turns}), coarse());
  for (double const apart : {7.5, 100.}) {
    Mesh mesh = one;
    append(mesh, one, " 2", {apart * 1.5, 0, 0});
    Case const c(mesh);
    Index const first = one.n_nodes();
    auto const at_rest = c.morph(motion_of({turns}), coarse());
    for (Index n = 0; n < c.mesh.n_nodes(); ++n)
      ASSERT_TRUE(equal_bits(at_rest.x[n], n < first ? expected.x[n] : c.mesh.coordinates[n])) << n;
    // Each as if it were alone, whatever the other does.
    auto const both = c.morph(
        motion_of({turns, rule_for({"body 2", "?_min 2", "?_max 2"}, rotation({0, 0, 0}, {1, 0, 2}, 2))}), coarse());
    for (Index n = 0; n < first; ++n) ASSERT_TRUE(equal_bits(both.x[n], expected.x[n])) << n;
    RigidTransform const r = rotation_about({0, 0, 0}, {1, 0, 2}, 2);
    for (Index n = first; n < c.mesh.n_nodes(); ++n)
      ASSERT_LE(distance(both.x[n], r(c.mesh.coordinates[n])), 1e-12 * c.mesh.size()) << n;
    EXPECT_EQ(both.prepared.plan.parts.size(), 2U);
  }
}

TEST(MeshParts, OfWhichNoWallMovesFollowTheirOtherBoundaries) {
  Mesh const one = box_around({7, 7, 7}, in_the_middle);
  Mesh mesh = one;
  append(mesh, one, " 2", {30, 0, 0});
  Case const c(mesh);
  auto const m =
      c.morph(motion_of({rule_for({"body"}, translation({0.5, 0, 0})), rule_for({"i_min 2"}, translation({0, 0.3, 0})),
                         rule_for({"j_* 2", "k_* 2"}, FreeRule{})}),
              coarse());
  EXPECT_EQ(c.largest_miss(m), 0);
  EXPECT_EQ(c.inverted(m.x), 0);
  double between = 0;
  auto const moved = c.nodes_of("i_min 2");
  for (Index n = one.n_nodes(); n < c.mesh.n_nodes(); ++n)
    if (!std::binary_search(moved.begin(), moved.end(), Index32(n)))
      between = std::max(between, distance(m.x[n], c.mesh.coordinates[n]));
  EXPECT_GT(between, 0.05);
}

TEST(CommonMotion, HasExactRates) {
  Mesh mesh = sheared(box_around({7, 7, 7}, in_the_middle));
  append(mesh,
         sheared(box_around({6, 6, 6},
                            [](Vec3 const& p) {
                              return norm(p - Vec3{3, 3, 3}) < 1.2;
                            })),
         " 2", {30, 0, 0});
  Case const c(mesh);
  // The first part turns as a whole and bends a little besides; the body of the second one turns.
  auto const where = [&](Vec3 const& p, double t) {
    if (p.x > 20) return rotation_about({33, 3, 3}, {0, 1, 1}, 0.2 + 0.4 * t)(p);
    Vec3 const bent{p.x + (0.01 + 0.2 * t) * std::sin(p.y), p.y, p.z + 0.1 * t * p.x * p.x};
    return rotation_about({5, 4, 3}, {1, 2, 3}, 0.6 + 0.5 * t)(bent);
  };
  auto const rules =
      motion_of({rule_for({"body", "?_min", "?_max", "body 2"}, moves_as([&](Vec3 const& p) { return where(p, 0); }))});
  auto const prepared = prepare(c.mesh, c.topology, c.face_patches, rules, coarse());
  ASSERT_EQ(prepared.plan.parts.size(), 2U);
  EXPECT_TRUE(prepared.plan.parts.front().common);
  EXPECT_FALSE(prepared.plan.parts.back().common);
  std::vector<std::uint8_t> moves(c.mesh.n_nodes(), 0);
  for (auto const& patch : c.mesh.patches)
    if (patch.name.starts_with("body") || !patch.name.ends_with(" 2"))
      for (Index32 const n : patch_nodes(patch)) moves[n] = 1;
  auto const [error, largest] = rate_error(c, prepared.plan, [&](double t) {
    std::vector<Vec3> u;
    for (Index32 const n : prepared.plan.known) {
      Vec3 const x = c.mesh.coordinates[n];
      u.push_back(moves[n] != 0 ? where(x, t) - x : Vec3{});
    }
    return u;
  });
  EXPECT_GT(largest, 1);
  EXPECT_LT(error, 1e-7 * largest);
}

}  // namespace
}  // namespace gridmorph::test
