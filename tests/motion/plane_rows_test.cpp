// Rows in a plane: a passage of plane elements around an axis across the plane, or beside others along a straight line.
// The oracles are the same section between two planes, the formula of the blade's motion, and a straight row, whose
// motion comes nearer with the radius.
#include "support/plane_cascade.hpp"
#include "support/unstructured_case.hpp"

#include <gridmorph/mesh/as_hexahedra.hpp>
#include <gridmorph/motion/boundary_motion.hpp>
#include <gridmorph/motion/rigid_motion.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

namespace gridmorph::test {
namespace {

enum PlaneRule { blade_rule, ends_rule, sides_rule };

constexpr int blades = 11;

SectionsRule plane_redesign() {
  SectionsRule rule;
  rule.twist_rad = {{{0, 0.06}}};
  rule.stagger_rad = {{{0, -0.03}}};
  rule.lean = {{{0, 0.02}}};
  rule.chord = {{{0, -0.05}}};
  return rule;
}

Motion plane_rules(Rule const& of_the_blade, Axis const& axis) {
  Motion motion;
  motion.axis = axis;
  motion.rules = {{{"blade"}, of_the_blade, 0, "blade"},
                  {{"inlet", "outlet"}, CircumferentialSlideRule{{"blade"}}, 0, "ends"},
                  {{"type:periodic"}, FollowRule{{"blade"}}, 0, "sides"}};
  return motion;
}

Axis const about_z{{0, 0, 0}, {0, 0, 1}};

using ByRule = std::array<Vec3, 3>;

/// At the nodes of a plane mesh: the rule of the ends at theirs, the others everywhere.
std::vector<ByRule> displacements(BoundaryMotion const& motion, Mesh const& plane) {
  std::vector<char> at_end(plane.n_nodes(), 0);
  for (Patch const& patch : plane.patches)
    for (Index f = 0; patch.name != "blade" && f < patch.faces.size(); ++f)
      for (Index32 const n : patch.faces[f]) at_end[n] = 1;
  std::vector<ByRule> out(at_end.size());
  for (std::size_t n = 0; n < out.size(); ++n)
    for (int const r : {blade_rule, ends_rule, sides_rule}) {
      Vec3 const p = plane.coordinates[Index(n)];
      if (r != ends_rule || at_end[n] != 0) motion.displacement(r, {&p, 1}, {&out[n][r], 1});
    }
  return out;
}

BoundaryMotion motion_in_plane(Mesh const& mesh, Rule const& of_the_blade, Axis const& axis) {
  UnstructuredCase const with(mesh);
  auto const boundary = std::make_shared<Boundary const>(with.mesh, with.topology, with.face_patches);
  return {boundary, resolve(boundary->names(), plane_rules(of_the_blade, axis))};
}

std::vector<ByRule> in_plane(Mesh const& mesh, Rule const& of_the_blade, Axis const& axis = about_z) {
  return displacements(motion_in_plane(mesh, of_the_blade, axis), mesh);
}

Mesh wheel_passage() { return plane_cascade(section_of_wheel(blades), turned_sides(2 * std::numbers::pi / blades)); }

double largest_of(std::vector<ByRule> const& u, std::size_t r) {
  double out = 0;
  for (ByRule const& node : u) out = std::max(out, norm(node[r]));
  return out;
}

TEST(PlaneRows, MoveAsRowsBetweenTwoPlanesDo) {
  Periodic const turn = turned_sides(2 * std::numbers::pi / blades);
  Mesh const thick = cascade_between_planes(section_of_wheel(blades), turn, 0.3), plane = wheel_passage();
  Motion motion = plane_rules(plane_redesign(), about_z);
  motion.rules.push_back({{"hub", "case"}, SlipRule{.surface = SlipRule::Surface::plane}, 0, "walls"});
  auto const u = in_plane(plane, plane_redesign());
  auto const v = displacements(BoundaryMotion(thick, resolve(thick, motion)), plane);
  for (int const r : {blade_rule, ends_rule, sides_rule}) {
    double const largest = largest_of(v, std::size_t(r));
    EXPECT_GT(largest, 0.005);
    double apart = 0;
    for (std::size_t n = 0; n < u.size(); ++n) apart = std::max(apart, distance(u[n][r], v[n][r]));
    EXPECT_LT(apart, 1e-10 * largest) << r;
  }
}

/// What the rules give both planes of a mesh of one cell across, by its nodes; the plane z = 0 as plane_cascade()
/// counts its nodes.
void expect_moves_as_in_plane(Mesh const& two_planes, Boundary const& boundary, Mesh const& plane,
                              std::vector<ByRule> const& wanted, Axis const& axis) {
  BoundaryMotion const motion{std::make_shared<Boundary const>(boundary),
                              resolve(boundary.names(), plane_rules(plane_redesign(), axis))};
  auto const u = displacements(motion, plane);
  double largest = 0, apart = 0;
  for (int const r : {blade_rule, ends_rule, sides_rule}) {
    largest = std::max(largest, largest_of(wanted, std::size_t(r)));
    for (std::size_t n = 0; n < u.size(); ++n) apart = std::max(apart, distance(u[n][r], wanted[n][r]));
  }
  EXPECT_GT(largest, 0.005);
  EXPECT_LT(apart, 1e-10 * largest);
  // And of the other plane alike.
  double uneven = 0;
  for (Index n = 0; n < two_planes.n_nodes(); ++n) {
    Vec3 const p = two_planes.coordinates[n], below{p.x, p.y, 0};
    std::array<Vec3, 2> v;
    for (int const r : {blade_rule, sides_rule}) {
      motion.displacement(r, {&p, 1}, {&v[0], 1});
      motion.displacement(r, {&below, 1}, {&v[1], 1});
      uneven = std::max(uneven, distance(v[0], v[1]));
    }
  }
  EXPECT_LT(uneven, 1e-10 * largest);
}

// Two planes with symmetry conditions and one cell between them are a plane mesh in all but name.
TEST(PlaneRows, OfTwoPlanesMoveAsTheirSection) {
  Periodic const turn = turned_sides(2 * std::numbers::pi / blades),
                 shift = periodic_translation({0, plane_cascade_pitch, 0});
  for (auto const& [section, periodic] :
       {std::pair(section_of_wheel(blades), turn), std::pair(straight_section(), shift)}) {
    Mesh const plane = plane_cascade(section, periodic);
    auto const wanted = in_plane(plane, plane_redesign());
    for (PatchKind const ends : {PatchKind::symmetry, PatchKind::wall}) {
      Mesh const blocks = cascade_between_planes(section, periodic, 0.3, 2, ends);
      expect_moves_as_in_plane(blocks, Boundary(blocks), plane, wanted, about_z);
      UnstructuredCase const elements(as_hexahedra(blocks));
      expect_moves_as_in_plane(elements.mesh, Boundary(elements.mesh, elements.topology, elements.face_patches), plane,
                               wanted, about_z);
    }
    Mesh const of_two_dimensions = plane_cascade_block(section, periodic);
    expect_moves_as_in_plane(of_two_dimensions, Boundary(of_two_dimensions), plane, wanted, about_z);
  }
}

TEST(PlaneRows, FollowReplicatesTheMotionOfTheBladeAndTapersAlongTheRadius) {
  Mesh const mesh = wheel_passage();
  auto const out = [](double r) { return 0.02 * std::sin(3 * r); };
  auto const turn = [](double r) { return 0.05 + 0.04 * (r - 1) + 0.1 * (r - 1) * (r - 1); };
  FunctionRule const rule{"radius and angle", [=](std::span<Vec3 const> points, std::span<Vec3> u) {
                            for (std::size_t n = 0; n < points.size(); ++n) {
                              Vec3 const p = points[n];
                              double const r = std::hypot(p.x, p.y), a = std::atan2(p.y, p.x) + turn(r);
                              u[n] = (r + out(r)) * Vec3{std::cos(a), std::sin(a), 0} - p;
                            }
                          }};
  auto const u = in_plane(mesh, rule);
  double const of_x = 2 * std::numbers::pi / (blades * plane_cascade_pitch);
  double const inlet = std::exp(-1.4 * of_x), leading = 1, trailing = std::exp(of_x), outlet = std::exp(2.4 * of_x);
  double worst = 0, largest = 0;
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    Vec3 const p = mesh.coordinates[n];
    double const r = std::hypot(p.x, p.y), at = std::clamp(r, leading, trailing);
    double const share = r < leading    ? (r - inlet) / (leading - inlet)
                         : r > trailing ? (outlet - r) / (outlet - trailing)
                                        : 1;
    double const a = std::atan2(p.y, p.x) + turn(at), moved = r + share * out(at);
    worst = std::max(worst, distance(p + u[n][sides_rule], moved * Vec3{std::cos(a), std::sin(a), 0}));
    largest = std::max(largest, norm(u[n][sides_rule]));
  }
  EXPECT_GT(largest, 0.1);
  // Between the lines of a blade of 17 of them the motion of its camber line is a smooth curve through them.
  EXPECT_LT(worst, 1e-3 * largest);
}

TEST(PlaneRows, SlideTurnsTheEndsByTheAngleOfTheEdgesAndKeepsTheirRadius) {
  Mesh const mesh = wheel_passage();
  auto const turn = [](double r) { return 0.05 + 0.2 * (r - 1); };
  FunctionRule const rule{
      "angle", [=](std::span<Vec3 const> points, std::span<Vec3> u) {
        for (std::size_t n = 0; n < points.size(); ++n)
          u[n] = rotation_about({}, {0, 0, 1}, turn(std::hypot(points[n].x, points[n].y)))(points[n]) - points[n];
      }};
  auto const u = in_plane(mesh, rule);
  double const trailing = std::exp(2 * std::numbers::pi / (blades * plane_cascade_pitch));
  for (Patch const& patch : mesh.patches) {
    if (patch.name == "blade") continue;
    RigidTransform const wanted = rotation_about({}, {0, 0, 1}, turn(patch.name == "inlet" ? 1 : trailing));
    for (Index f = 0; f < patch.faces.size(); ++f)
      for (Index32 const n : patch.faces[f]) {
        Vec3 const p = mesh.coordinates[n];
        EXPECT_LT(distance(p + u[n][ends_rule], wanted(p)), 1e-13) << patch.name;
      }
  }
}

TEST(PlaneRows, ATurnAboutTheAxisTurnsAllOfTheRowWhereverItsPlaneIs) {
  Mesh mesh = wheel_passage();
  RigidTransform const placed = rotation_about({1, 2, 3}, {1, -2, 0.5}, 0.8);
  for (Index n = 0; n < mesh.n_nodes(); ++n) mesh.coordinates.set(n, placed(mesh.coordinates[n]));
  Vec3 const centre = placed(Vec3{}), direction = placed.rotation * Vec3{0, 0, 1};
  for (Connection& c : mesh.connections)
    c.periodic = periodic_rotation(centre, direction, 2 * std::numbers::pi / blades);
  Axis const axis{centre + 0.7 * direction, -2.0 * direction};
  RigidRule const turn = make_rigid({.angle_rad = 0.2, .axis = axis});
  auto const u = in_plane(mesh, turn, axis);
  EXPECT_GT(largest_of(u, ends_rule), 0.1);
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    for (int const r : {ends_rule, sides_rule}) {
      Vec3 const given = u[n][r];
      if (r == ends_rule && given == Vec3{}) continue;
      EXPECT_LT(distance(given, displacement(turn, mesh.coordinates[n])), 1e-13);
    }
}

TEST(PlaneRows, CopiesAPitchApartMoveAlikeAndSidesMeetTheBlade) {
  Mesh const mesh = wheel_passage();
  auto const u = in_plane(mesh, plane_redesign());
  double const largest = largest_of(u, blade_rule);
  int met = 0;
  for (Connection const& c : mesh.connections)
    for (std::size_t k = 0; k < c.nodes.size(); ++k) {
      Vec3 const own = u[c.nodes[k]][sides_rule], donor = u[c.donor_nodes[k]][sides_rule];
      EXPECT_LT(distance(c.periodic->declared.rotation * own, donor), 1e-14);
      double const r = norm(mesh.coordinates[c.nodes[k]]);
      bool const edge = std::abs(r - 1) < 1e-12 ||
                        std::abs(r - std::exp(2 * std::numbers::pi / (blades * plane_cascade_pitch))) < 1e-12;
      if (!edge) continue;
      EXPECT_LT(distance(own, u[c.nodes[k]][blade_rule]), 1e-10 * largest);
      ++met;
    }
  EXPECT_EQ(met, 2);
}

TEST(PlaneRows, AreStraightOnesWhereTheRadiusIsLarge) {
  Mesh const straight = plane_cascade(straight_section(), periodic_translation({0, plane_cascade_pitch, 0}));
  auto const linear = in_plane(straight, plane_redesign(), Axis{{0, 0, 0}, {1, 0, 0}});
  auto const apart = [&](double radius) {
    Mesh const bent = plane_cascade(bent_section(radius), turned_sides(plane_cascade_pitch / radius));
    auto const u = in_plane(bent, plane_redesign());
    double worst = 0;
    for (Index n = 0; n < bent.n_nodes(); ++n) {
      Vec3 const p = bent.coordinates[n];
      double const r = norm(p), c = p.x / r, s = p.y / r;
      for (int const k : {blade_rule, ends_rule, sides_rule}) {
        Vec3 const v = u[n][k];
        worst = std::max(worst, distance(linear[n][k], {c * v.x + s * v.y, c * v.y - s * v.x, 0}));
      }
    }
    return worst;
  };
  double const near = apart(100), far = apart(1000);
  EXPECT_LT(near, 2e-3);
  EXPECT_LT(far, 0.15 * near);
}

// The pitch leaves one way across it in the plane, so that the axis may stand on the plane as well.
TEST(PlaneRows, OfATranslationTakeTheAxisAlongTheFlowOrAcrossThePlane) {
  Mesh const mesh = plane_cascade(straight_section(), periodic_translation({0, plane_cascade_pitch, 0}));
  auto const along = in_plane(mesh, plane_redesign(), Axis{{0, 0, 0}, {1, 0, 0}}),
             across = in_plane(mesh, plane_redesign(), about_z);
  EXPECT_GT(largest_of(along, sides_rule), 0.01);
  for (std::size_t n = 0; n < along.size(); ++n)
    for (int const r : {blade_rule, ends_rule, sides_rule}) EXPECT_LT(distance(along[n][r], across[n][r]), 1e-15);
}

TEST(PlaneRows, ABladeThatDoesNotMoveMovesNothing) {
  for (ByRule const& node : in_plane(wheel_passage(), FixedRule{}))
    for (Vec3 const& u : node) EXPECT_EQ(u, Vec3{});
}

}  // namespace
}  // namespace gridmorph::test
