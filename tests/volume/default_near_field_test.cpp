// Near fields that nobody asked for, and those that are asked for without an extent.
#include "support/mesh_builders.hpp"
#include "support/morph_run.hpp"
#include "support/motions.hpp"

#include <gridmorph/geometry/rigid_transform.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace gridmorph::test {
namespace {

constexpr int cells_across = 12;

Motion pushed_wall(std::vector<std::string> const& walls, std::vector<std::string> const& fixed) {
  std::vector<MotionRule> rules{rule(walls, function_rule([](Vec3 const&) {
                                       return Vec3{0, 1, 0};
                                     })),
                                rule({"v_min", "v_max", "w_min", "w_max"}, FreeRule{})};
  if (!fixed.empty()) rules.push_back(rule(fixed, FixedRule{}));
  return motion(std::move(rules));
}

/// How far the nodes of a line across a straight box move whose cells are all alike and whose u_min moves by one.
std::vector<double> line_across(PlanOptions const& options) {
  Outcome const r =
      morph(box({cells_across + 1, 4, 3}, Shape::straight, 1), pushed_wall({"u_min"}, {"u_max"}), options);
  std::vector<double> out;
  for (int i = 0; i <= cells_across; ++i) out.push_back(r.u(r.mesh.zones[0].node({i, 1, 1})).y);
  return out;
}

/// One up to some node, and linear from there to zero.
void expect_rigid_to(int layers, std::vector<double> const& line) {
  for (int i = 0; i <= cells_across; ++i)
    EXPECT_NEAR(line[i], i <= layers ? 1 : double(cells_across - i) / (cells_across - layers), 1e-14) << i;
}

TEST(DefaultNearField, IsAThirdOfTheCellsOfABlockThatRunsFromAMovingWallToABoundary) {
  expect_rigid_to(cells_across / 3, line_across(PlanOptions{}));
}

TEST(DefaultNearField, EndsWhereAnotherBlockFollows) {
  PlanOptions options;
  options.volume.cuts = {{box({4, 4, 4}, Shape::straight, 1).zones[0].name, 0, 5, {}}};
  expect_rigid_to(5, line_across(options));
}

TEST(DefaultNearField, IsThatOfABoundaryLayerWithoutWallsAndExtent) {
  PlanOptions bare;
  bare.boundary_layers = {BoundaryLayer{}};
  EXPECT_EQ(line_across(bare), line_across(PlanOptions{}));
}

TEST(DefaultNearField, CanBeLeftOut) {
  PlanOptions none;
  none.default_boundary_layer = false;
  expect_rigid_to(0, line_across(none));
}

TEST(DefaultNearField, IsNotBetweenWallsThatFaceOneAnotherAndBothMove) {
  Mesh mesh = box({cells_across + 1, 4, 3}, Shape::straight, 1);
  for (Patch& patch : mesh.patches)
    if (patch.name == "u_max" || (!patch.families.empty() && patch.families.front() == "u_max"))
      patch.kind = PatchKind::wall;
  Plan const plan = prepare(mesh, pushed_wall({"u_min", "u_max"}, {}), PlanOptions{}).plan();
  EXPECT_TRUE(plan.near_field.empty());
}

TEST(DefaultNearField, IsNotOffWallsThatStandStill) {
  Plan const plan =
      prepare(box({7, 4, 3}, Shape::straight, 1), motion({rule({"*"}, FixedRule{})}), PlanOptions{}).plan();
  EXPECT_TRUE(plan.near_field.empty());
}

TEST(DefaultNearField, HasANoteThatSaysHowFarItReaches) {
  Plan const plan =
      prepare(box({cells_across + 1, 4, 3}, Shape::straight, 1), pushed_wall({"u_min"}, {"u_max"}), PlanOptions{})
          .plan();
  EXPECT_TRUE(std::any_of(plan.notes.begin(), plan.notes.end(), [](std::string const& note) {
    return note.find("'u_min'") != std::string::npos && note.find("4 of 12 cells") != std::string::npos &&
           note.find("boundary_layer = false") != std::string::npos;
  }));
}

TEST(DefaultNearField, TurnsRigidlyWithABodyInAnOGridOfOneBlock) {
  RigidTransform const turn = rotation_about({0.1, -0.2, 0}, {0, 0, 1}, 0.7);
  Outcome const r = morph(
      o_grid(0.8, 12),
      motion({rule({"body"}, function_rule([&](Vec3 const& p) { return turn(p) - p; })), rule({"far"}, FixedRule{})}),
      PlanOptions{});
  Zone const& zone = r.mesh.zones[0];
  int const layers = (zone.extent[1] - 1) / 3;
  ASSERT_GE(layers, 1);
  for (int k = 0; k < zone.extent[2]; ++k)
    for (int j = 0; j <= layers; ++j)
      for (int i = 0; i < zone.extent[0]; ++i) {
        Index const n = zone.node({i, j, k});
        Vec3 const x = r.mesh.coordinates[n];
        EXPECT_LT(distance(x + r.u(n), turn(x)), 1e-12) << i << " " << j << " " << k;
      }
}

constexpr int nodes_around = 48, cells_away = 24;
constexpr double half_chord = 0.5, half_thickness = 0.06;

/// A wing with an elliptic section, lines along confocal hyperbolas: they leave the wall at right angles and end 15
/// chords away.
Mesh elliptic_wing() {
  Bricks b;
  b.name = "wing";
  b.extent = {nodes_around + 1, cells_away + 1, 3};
  b.position = [](Vec3 const& q) {
    double const angle = 2 * std::numbers::pi * q.x, growth = 1.4;
    double const height =
        15 * (std::pow(growth, std::lround(q.y * cells_away)) - 1) / (std::pow(growth, cells_away) - 1);
    double const lambda = height * (height + 2 * half_thickness);
    return Vec3{std::cos(angle) * std::sqrt(half_chord * half_chord + lambda),
                std::sin(angle) * std::sqrt(half_thickness * half_thickness + lambda), q.z};
  };
  b.ends[0].kind = Ends::Kind::closed;
  b.family = {"", "", "wing", "far", "root", "tip"};
  b.kind = {PatchKind::other,    PatchKind::other,    PatchKind::wall,
            PatchKind::farfield, PatchKind::symmetry, PatchKind::symmetry};
  return make(b);
}

/// Sine of the smallest angle of a cell's corners in the section, negative where one is turned over, and the largest
/// change of the angle between wall and line.
struct SectionShapes {
  double sine = 1, leaned = 0;
};
SectionShapes shapes_of(Mesh const& mesh, Coordinates const& moved) {
  Zone const& zone = mesh.zones[0];
  SectionShapes out;
  auto const corner = [&](Coordinates const& x, int i, int j, int di, int dj) {
    Vec3 const at = x[zone.node({i, j, 0})];
    Vec3 const a = x[zone.node({(i + di + nodes_around) % nodes_around, j, 0})] - at,
               b = x[zone.node({i, j + dj, 0})] - at;
    return cross(a, b).z / (norm(a) * norm(b)) * di * dj;
  };
  auto const degrees_off_wall = [&](Coordinates const& x, int i) {
    Vec3 const along =
        x[zone.node({(i + 1) % nodes_around, 0, 0})] - x[zone.node({(i + nodes_around - 1) % nodes_around, 0, 0})];
    Vec3 const line = x[zone.node({i, 1, 0})] - x[zone.node({i, 0, 0})];
    return std::atan2(cross(along, line).z, dot(along, line)) * 180 / std::numbers::pi;
  };
  double const sign = corner(mesh.coordinates, 0, 0, 1, 1) > 0 ? 1 : -1;
  for (int i = 0; i < nodes_around; ++i) {
    out.leaned = std::max(out.leaned, std::abs(degrees_off_wall(moved, i) - degrees_off_wall(mesh.coordinates, i)));
    for (int j = 0; j <= cells_away; ++j)
      for (int const di : {-1, 1})
        for (int const dj : {-1, 1})
          if (j + dj >= 0 && j + dj <= cells_away) out.sine = std::min(out.sine, sign * corner(moved, i, j, di, dj));
  }
  return out;
}

TEST(DefaultNearField, KeepsAWingInAnOGridSoundThatTurnsFar) {
  Mesh const mesh = elliptic_wing();
  struct Turn {
    double degrees, sine;
  };
  for (Turn const& turn : {Turn{10, 0.85}, Turn{60, 0.8}, Turn{120, 0.5}, Turn{175, 0.25}}) {
    RigidTransform const t = rotation_about({0, 0, 0}, {0, 0, 1}, turn.degrees * std::numbers::pi / 180);
    Outcome const r = morph(mesh,
                            motion({rule({"wing"}, function_rule([&](Vec3 const& p) { return t(p) - p; })),
                                    rule({"far"}, FixedRule{}), rule({"root", "tip"}, FreeRule{})}),
                            PlanOptions{});
    SectionShapes const shapes = shapes_of(mesh, r.morphed.position);
    EXPECT_LT(shapes.leaned, 0.1) << turn.degrees;
    EXPECT_GT(shapes.sine, turn.sine) << turn.degrees;
  }
}

}  // namespace
}  // namespace gridmorph::test
