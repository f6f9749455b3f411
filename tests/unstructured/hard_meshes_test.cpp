// Meshes of kinds that users bring: viscous bodies, half models, bodies near or on other boundaries, several bodies and
// zones, wing sections, elements of second order, polyhedra.
#include "support/expect_error.hpp"
#include "support/made_bodies.hpp"
#include "support/reduced.hpp"
#include "support/unstructured_case.hpp"
#include "support/unstructured_meshes.hpp"

#include <generators/sphere.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace gridmorph::test {
namespace {

using Case = UnstructuredCase;

bool within(Vec3 const& c, Vec3 const& low, Vec3 const& high) {
  return c.x > low.x && c.x < high.x && c.y > low.y && c.y < high.y && c.z > low.z && c.z < high.z;
}

FunctionRule by(std::function<Vec3(Vec3 const&)> const& displacement) {
  return {"test", [=](std::span<Vec3 const> x, std::span<Vec3> u) {
            for (std::size_t n = 0; n < x.size(); ++n) u[n] = displacement(x[n]);
          }};
}

void expect_sound(Case const& c, UnstructuredMorphed const& m) {
  EXPECT_EQ(c.inverted(m.x), 0);
  EXPECT_EQ(c.largest_miss(m), 0);
}

// ---- a viscous sphere
// --------------------------------------------------------------------------------------------------

struct Outer {
  char const* name;
  SphereOptions::Outer shape;
  double distance;  ///< in diameters of the sphere, whose radius is 0.5
};

class ViscousSphere : public testing::TestWithParam<Outer> {
 protected:
  static SphereOptions options() {
    SphereOptions o;
    o.elements = 30'000;
    o.outer = GetParam().shape;
    o.distance = GetParam().distance;
    return o;
  }
  Case c{make_sphere(options())};

  void expect_rigid_columns(UnstructuredMorphed const& m, RigidTransform const& motion) const {
    auto const& columns = m.prepared.plan.columns.node;
    ASSERT_GT(columns.size(), 1000u);
    for (Index32 const n : columns) ASSERT_LT(distance(m.x[n], motion(c.mesh.coordinates[n])), 1e-9);
  }
};

INSTANTIATE_TEST_SUITE_P(Boundaries, ViscousSphere,
                         testing::Values(Outer{"sphere_4_diameters_away", SphereOptions::Outer::sphere, 4},
                                         Outer{"cube_4_diameters_away", SphereOptions::Outer::cube, 4},
                                         Outer{"cube_16_diameters_away", SphereOptions::Outer::cube, 16}),
                         [](auto const& info) { return std::string(info.param.name); });

TEST_P(ViscousSphere, MovedByItsRadiusAndByItsDiameterNeedsNoGuard) {
  double const s = 1 / std::sqrt(3.0);
  for (Vec3 const& t : {Vec3{0.5 * s, 0.5 * s, 0.5 * s}, Vec3{-1, 0, 0}, Vec3{0.5, 0, 0}, Vec3{0, 0, -0.5}}) {
    if (reduced() && t.x > 0.4) break;
    auto const m = c.morph(motion_of({rule_for({"sphere"}, translation(t))}));
    expect_sound(c, m);
    expect_rigid_columns(m, {{}, t});
    EXPECT_GT(c.quality(m.x)[Measure::determinant_3x3x3].min,
              0.6 * c.quality(c.mesh.coordinates)[Measure::determinant_3x3x3].min);
  }
}

TEST_P(ViscousSphere, TurnsAndMovesAtOnce) {
  for (double const degrees : {45.0, 20.0}) {
    if (reduced() && degrees < 45) break;
    RigidTransform motion = rotation_about({0, 0, 0}, {1, 2, 3}, degrees * std::numbers::pi / 180);
    motion.translation += Vec3{0.5, 0, 0};
    auto const m = c.guarded_morph(motion_of({rule_for({"sphere"}, RigidRule{motion.rotation, motion.translation})}));
    expect_sound(c, m);
    expect_rigid_columns(m, motion);
  }
}

TEST(SmallBodies, MoveByFourDiametersInABigBox) {
  SphereOptions o;
  o.elements = 40'000;
  o.outer = SphereOptions::Outer::cube;
  o.distance = 20;
  Case const c(make_sphere(o));
  auto const m = c.morph(motion_of({rule_for({"sphere"}, translation({4, 0, 0}))}));
  expect_sound(c, m);
}

// ---- far away
// ---------------------------------------------------------------------------------------------------------

// The size of the mesh is what tolerances go with: beside such a node all elements of the body were at one place, and
// looked through for each of its places.
TEST(FarAway, ANodeThatCannotBelongToTheMeshIsNamedWithEveryWrap) {
  Mesh const mesh = box_around(
      {8, 8, 8},
      [](Vec3 const& x) {
        return within(x, {3, 3, 3}, {5, 5, 5});
      },
      true);
  Index32 const on_wall = Case(mesh).nodes_of("body")[3];
  for (bool const tube : {false, true})
    for (Index32 const node : {on_wall, Index32(0), Index32(1 + 9 + 81)})
      for (double const far : {1e10, 1e16, -1e50}) {
        Mesh damaged = mesh;
        damaged.coordinates = Coordinates(mesh.n_nodes());
        for (Index n = 0; n < mesh.n_nodes(); ++n) damaged.coordinates.set(n, mesh.coordinates[n]);
        damaged.coordinates.z(node) = far;
        PlanOptions options;
        options.elements.tube = tube;
        auto const text = message_of<MeshError>([&] {
          (void)Case(damaged).morph(motion_of({rule_for({"body"}, translation({0.1, 0, 0}))}), options);
        });
        expect_all_in(text, {describe_node(damaged, node), "repair the mesh", "half of all nodes"});
      }
}

TEST(FarAway, AFarFieldOf1e5DiametersIsNone) {
  SphereOptions o;
  o.elements = 20'000;
  o.outer = SphereOptions::Outer::sphere;
  o.distance = 4;
  Mesh mesh = make_sphere(o);
  double largest = 0;
  for (Index n = 0; n < mesh.n_nodes(); ++n) largest = std::max(largest, norm(mesh.coordinates[n]));
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    Vec3 const p = mesh.coordinates[n];
    double const r = norm(p), begin = 0.7;
    if (r > begin) mesh.coordinates.set(n, (std::pow(1e5 / begin, (r - begin) / (largest - begin)) * begin / r) * p);
  }
  Case const c(mesh);
  for (bool const tube : {false, true}) {
    PlanOptions options;
    options.elements.tube = tube;
    expect_sound(c, c.morph(motion_of({rule_for({"sphere"}, translation({0.2, 0.1, 0}))}), options));
  }
}

// ---- symmetry planes
// ---------------------------------------------------------------------------------------------------

TEST(HalfModels, NodesOfTheSymmetryPlaneStayInItWhileABodyOnItMoves) {
  SphereOptions o;
  o.elements = 40'000;
  o.jitter = 0;  // so that the plane is one of faces
  auto const half = part_of(
      make_sphere(o), [](Vec3 const& x) { return x.z > 0; }, "symmetry", PatchKind::symmetry);
  Case const c(part_of(
      half, [](Vec3 const& x) { return x.y > 0; }, "symmetry y", PatchKind::symmetry));
  auto const plane = c.nodes_of("symmetry"), plane_y = c.nodes_of("symmetry y");
  ASSERT_GT(plane.size(), 300u);
  ASSERT_GT(plane_y.size(), 300u);
  // The defaults of the patches: symmetry planes slip.
  for (Rule const& rule : {translation({0.5, 0, 0}), Rule(by([](Vec3 const& x) { return 0.2 * x; }))}) {
    auto const m = c.morph(motion_of({rule_for({"sphere"}, rule)}));
    expect_sound(c, m);
    double slid = 0;
    for (Index32 const n : plane) {
      EXPECT_NEAR(m.x.z(n), 0, 1e-13);
      slid = std::max(slid, distance(m.x[n], c.mesh.coordinates[n]));
    }
    for (Index32 const n : plane_y) EXPECT_NEAR(m.x.y(n), 0, 1e-13);
    EXPECT_GT(slid, 0.05);
  }
}

// ---- boxes in boxes
// ----------------------------------------------------------------------------------------------------

class Boxes : public testing::TestWithParam<bool> {
 protected:
  static Case around(Index3 n, Vec3 const& low, Vec3 const& high) {
    return Case(box_around(
        n, [&](Vec3 const& x) { return within(x, low, high); }, GetParam()));
  }
};
INSTANTIATE_TEST_SUITE_P(Elements, Boxes, testing::Bool(),
                         [](auto const& info) { return info.param ? "tetrahedra" : "hexahedra"; });

TEST_P(Boxes, ABodyTwoCellsFromTheFarfieldMovesByHalfItsSize) {
  Case const c = around({18, 16, 16}, {12, 6, 6}, {16, 10, 10});
  for (Vec3 const& t : {Vec3{0, 2, 0}, Vec3{-2, 0, 0}, Vec3{0.8, 0, 0}})
    expect_sound(c, c.morph(motion_of({rule_for({"body"}, translation(t))})));
}

TEST_P(Boxes, ABodyRootedInAFixedWallBends) {
  Case const c = around({16, 16, 16}, {6, 6, -1}, {10, 10, 8});
  auto const bend = by([](Vec3 const& x) { return Vec3{2 * std::pow(x.z / 8, 2), 0, 0}; });
  expect_sound(c, c.morph(motion_of({rule_for({"body"}, bend), rule_for({"k_min"}, FixedRule{})})));
}

TEST_P(Boxes, ABodyRootedInASlidingPlaneTakesItAlong) {
  Case const c = around({16, 16, 16}, {6, 6, -1}, {10, 10, 8});
  for (Rule const& rule : {translation({2, 0, 0}), rotation({8, 8, 0}, {0, 0, 1}, 0.5)}) {
    auto const m = c.morph(motion_of({rule_for({"body"}, rule), rule_for({"k_min"}, SlipRule{})}));
    expect_sound(c, m);
    for (Index32 const n : c.nodes_of("k_min")) EXPECT_NEAR(m.x.z(n), 0, 1e-12);
  }
}

TEST_P(Boxes, BodiesMoveApartTogetherAndPastEachOther) {
  auto const one = around({22, 16, 16}, {4, 6, 6}, {8, 10, 10});
  Case const c(part_of(
      one.mesh,
      [](Vec3 const& x) {
        return !within(x, {14, 6, 6}, {18, 10, 10});
      },
      "second", PatchKind::wall));
  ASSERT_EQ(c.nodes_of("second").size(), c.nodes_of("body").size());
  struct Pair {
    Rule first, second;
  };
  for (auto const& [first, second] :
       {Pair{rotation({6, 8, 8}, {0, 0, 1}, 0.4), rotation({16, 8, 8}, {0, 0, 1}, -0.4)},
        Pair{translation({-1.4, 0, 0}), translation({1.4, 0, 0})},
        Pair{translation({0.8, 0, 0}), translation({-0.8, 0, 0})},
        Pair{translation({0, 1.4, 0}), translation({0, -1.4, 0})}, Pair{translation({0, 1.4, 0}), FixedRule{}}}) {
    expect_sound(c, c.guarded_morph(motion_of({rule_for({"body"}, first), rule_for({"second"}, second)})));
    if (reduced()) break;
  }
}

// ---- 2-D
// ---------------------------------------------------------------------------------------------------------------

TEST(WingSections, PitchAndPlungeInAFarField) {
  Case const c(airfoil(160, 25, 1e-5, 1.25, 20));
  ASSERT_EQ(c.inverted(c.mesh.coordinates), 0);
  for (Rule const& rule : {rotation({0.25, 0, 0}, {0, 0, 1}, -15 * std::numbers::pi / 180), translation({0, 0.5, 0})}) {
    auto const m = c.morph(motion_of({rule_for({"airfoil"}, rule)}));
    expect_sound(c, m);
    for (Index32 const n : c.nodes_of("farfield")) EXPECT_EQ(distance(m.x[n], c.mesh.coordinates[n]), 0);
    // First cells: the node above wall node i is i + 160.
    for (Index32 const n : c.nodes_of("airfoil"))
      EXPECT_NEAR(distance(m.x[n], m.x[n + 160]), distance(c.mesh.coordinates[n], c.mesh.coordinates[n + 160]),
                  1e-3 * 1e-5);
  }
}

// ---- the same mesh in other forms
// --------------------------------------------------------------------------------------

class SameMesh : public testing::Test {
 protected:
  Case c{box_around(
      {12, 12, 12},
      [](Vec3 const& x) {
        return within(x, {4, 4, 4}, {8, 8, 8});
      },
      true)};
  Motion motion = motion_of(
      {rule_for({"body"}, rotation({6, 6, 6}, {1, 1, 0}, 0.3, {1, 0, 0.5})), rule_for({"k_min"}, SlipRule{})});
  UnstructuredMorphed whole = c.morph(motion);
  /// Weights are kept in single precision, and depend on the order of nodes.
  double const single = 1e-6;
};

TEST_F(SameMesh, InTwoZonesMovesAlikeAndStaysClosedBitForBit) {
  // The body is cut through: each zone has a part of its wall.
  Case const two(in_two_zones(c.mesh, [](Vec3 const& x) { return x.x < 6; }));
  ASSERT_EQ(two.mesh.zones.size(), 2u);
  auto const m = two.morph(motion);
  expect_sound(two, m);
  for (auto const& connection : two.mesh.connections) {
    ASSERT_GT(connection.nodes.size(), 50u);
    for (std::size_t k = 0; k < connection.nodes.size(); ++k)
      EXPECT_EQ(distance(m.x[connection.nodes[k]], m.x[connection.donor_nodes[k]]), 0);
  }
  std::map<std::array<double, 3>, Vec3> expected;
  for (Index n = 0; n < c.mesh.n_nodes(); ++n) {
    Vec3 const x = c.mesh.coordinates[n];
    expected[{x.x, x.y, x.z}] = whole.x[n];
  }
  for (Index n = 0; n < two.mesh.n_nodes(); ++n) {
    Vec3 const x = two.mesh.coordinates[n];
    EXPECT_LT(distance(m.x[n], expected.at({x.x, x.y, x.z})), single) << describe_node(two.mesh, n);
  }
}

TEST_F(SameMesh, WithNodesInTheMiddleOfEdgesMovesAlikeAndKeepsThemThere) {
  Case const fine(second_order(c.mesh));
  auto const m = fine.morph(motion);
  EXPECT_EQ(fine.inverted(m.x), 0);
  for (Index n = 0; n < c.mesh.n_nodes(); ++n) EXPECT_LT(distance(m.x[n], whole.x[n]), single);
  for (Index e = 0; e < fine.mesh.n_elements(); ++e) {
    auto const n = fine.mesh.elements.nodes[e];
    EXPECT_LT(distance(m.x[n[4]], 0.5 * (m.x[n[0]] + m.x[n[1]])), 1e-12);
    EXPECT_LT(distance(m.x[n[9]], 0.5 * (m.x[n[2]] + m.x[n[3]])), 1e-12);
  }
}

TEST_F(SameMesh, AsPolyhedraMovesAlike) {
  Case const polyhedra(as_polyhedra(c.mesh));
  auto const m = polyhedra.morph(motion);
  EXPECT_EQ(polyhedra.largest_miss(m), 0);
  for (Index n = 0; n < c.mesh.n_nodes(); ++n) EXPECT_LT(distance(m.x[n], whole.x[n]), 0.05) << n;
  EXPECT_EQ(c.inverted(m.x), 0);
}

}  // namespace
}  // namespace gridmorph::test
