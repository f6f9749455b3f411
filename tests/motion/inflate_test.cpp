// Surfaces offset along their normals: against planes, cubes, cylinders and spheres, whichever way the mesh is stored.
#include "annulus.hpp"
#include "moved_nodes.hpp"
#include "support/expect_error.hpp"
#include "support/motions.hpp"
#include "support/periodic_match.hpp"
#include "support/scramble.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/motion/inflation/surface_offset.hpp>
#include <gridmorph/motion/inflation_heights.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

namespace gridmorph::test {
namespace {

constexpr double pi = std::numbers::pi;

InflateRule by(double height) {
  InflateRule out;
  out.height = [height](std::span<SurfacePlace const> places, std::span<double> h) {
    std::fill(h.begin(), h.begin() + std::ptrdiff_t(places.size()), height);
  };
  return out;
}

InflateRule by(std::function<double(SurfacePlace const&)> height) {
  InflateRule out;
  out.height = [height = std::move(height)](std::span<SurfacePlace const> places, std::span<double> h) {
    for (std::size_t n = 0; n < places.size(); ++n) h[n] = height(places[n]);
  };
  return out;
}

/// A cube from -1 to 1 in the middle of a larger one, 26 zones around it; its walls are the family "step".
Mesh around_a_cube() {
  Bricks bricks;
  bricks.name = "cube";
  bricks.extent = {10, 10, 10};
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i)
        if (i != 1 || j != 1 || k != 1)
          bricks.zones.push_back({{3 * i, 3 * j, 3 * k}, {3 * i + 4, 3 * j + 4, 3 * k + 4}});
  bricks.position = [](Vec3 const& p) { return 6 * p - Vec3{3, 3, 3}; };
  return make(bricks);
}

/// One zone on a surface: (a, b) in [0, 1]^2, and its third direction from the surface into the mesh. Walls "body", and
/// the others.
Mesh shell(int n, std::function<Vec3(double a, double b, double off)> const& position) {
  MeshBuilder builder("shell");
  int const zone = builder.zone("shell", {n, n, 2}, [=](Index3 const& at) {
    return position(double(at[0]) / (n - 1), double(at[1]) / (n - 1), at[2]);
  });
  builder.patch("body", PatchKind::wall, zone, 2, 0);
  builder.patch("top", PatchKind::farfield, zone, 2, 1);
  for (int axis = 0; axis < 2; ++axis)
    for (int side = 0; side < 2; ++side)
      builder.patch("ab"[axis] + std::string(side == 0 ? "_min" : "_max"), PatchKind::other, zone, axis, side);
  return builder.finish();
}

Vec3 on_sphere(double radius, double a, double b) {
  double const theta = 0.8 + 1.1 * a, phi = 2 * b;
  return radius * Vec3{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

TEST(Inflate, AFlatWallMovesByTheHeightIntoTheMesh) {
  Mesh const mesh = box({3, 5, 4}, Shape::straight, 1);
  for (auto const& [n, at, u] : moved_nodes(mesh, motion({rule({"u_max"}, by(0.01))})))
    EXPECT_LE(distance(u, {-0.01, 0, 0}), 1e-16);
}

TEST(Inflate, ACubeStaysACubeAtItsEdgesAndCorners) {
  Mesh const mesh = around_a_cube();
  double const h = 0.3;
  for (auto const& [n, at, u] : moved_nodes(mesh, motion({rule({"step"}, by(h))}))) {
    auto const grown = [&](double x) { return std::abs(std::abs(x) - 1) < 1e-9 ? std::copysign(h, x) : 0.0; };
    EXPECT_LE(distance(u, {grown(at.x), grown(at.y), grown(at.z)}), 1e-14);
  }
}

TEST(Inflate, QuadrilateralsCutIntoTrianglesMoveAlikeOnFlatFaces) {
  Mesh const blocks = around_a_cube(), elements = to_prisms_and_tetrahedra(blocks, 1);
  Motion const grown = motion({rule({"step"}, by([](SurfacePlace const& p) { return 0.1 + 0.02 * p.point.x; }))});
  PointNumbers numbers(1e-9);
  std::vector<Vec3> displacement;
  for (auto const& [n, at, u] : moved_nodes(blocks, grown))
    if (numbers.find_or_add(at, int(displacement.size())) == int(displacement.size())) displacement.push_back(u);
  for (auto const& [n, at, u] : moved_nodes(elements, grown)) {
    int const v = numbers.find(at);
    ASSERT_GE(v, 0);
    EXPECT_LE(distance(u, displacement[v]), 1e-14);
  }
}

TEST(Inflate, SpheresStaySpheresToSecondOrderFromInsideAndOutside) {
  for (double const into : {1.0, -1.0}) {
    double before = 0;
    for (int const n : {9, 17, 33}) {
      Mesh const mesh = shell(n, [&](double a, double b, double off) { return on_sphere(2 + into * 0.5 * off, a, b); });
      double worst = 0;
      for (auto const& [node, at, u] : moved_nodes(mesh, motion({rule({"body"}, by(0.25))}))) {
        Index3 const place{int(node % n), int(node / n), 0};
        if (place[0] % (n - 1) == 0 || place[1] % (n - 1) == 0) continue;  // faces on one side only
        worst = std::max(worst, std::abs(norm(at + u) - (2 + into * 0.25)));
      }
      if (before > 0) {
        EXPECT_GT(before, 3.5 * worst) << n;
      }
      before = worst;
    }
    EXPECT_LT(before, 1e-4);
  }
}

TEST(Inflate, NothingDependsOnHowZonesAreStored) {
  Mesh const mesh = annulus_sector({}, 7);
  auto const motion_of = [&] {
    return motion({rule({"hub"}, by([](SurfacePlace const& p) { return 0.02 + 0.01 * p.point.x; })),
                   rule({"inlet", "outlet"}, SlipRule{})});
  };
  std::map<Index, Vec3> expected;
  for (auto const& [n, at, u] : moved_nodes(mesh, motion_of())) expected[n] = u;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    ScrambledMesh const other = scramble(mesh, {.seed = seed, .cuts = 2});
    for (auto const& [n, at, u] : moved_nodes(other.mesh, motion_of()))
      EXPECT_LE(distance(u, expected.at(other.old_node[n])), 1e-13) << seed;
  }
}

TEST(Inflate, PeriodicCopiesMoveAlikeAndTheHubStaysRound) {
  Sector const sector;
  Mesh const mesh = annulus_sector(sector, 3);
  double const h = 0.05;
  std::map<Index, Vec3> u;
  for (auto const& node : moved_nodes(mesh, motion({rule({"hub"}, by(h)), rule({"inlet", "outlet"}, SlipRule{})}))) {
    u[node.node] = node.u;
    Vec3 const before = sector_coordinates(sector, node.at), after = sector_coordinates(sector, node.at + node.u);
    EXPECT_NEAR(after.y, before.y + h, 2e-3 * h);  // the hub's facets are chords of the circle
  }
  PeriodicMatch const match = periodic_match(mesh, u);
  EXPECT_GT(match.pairs, 3);
  EXPECT_LE(match.apart, 1e-14);
}

TEST(Inflate, NodesOfSlipWallsStayOnThemAndAllFacesAreOffsetByTheHeight) {
  // A wall that leans by 30 degrees over the floor b_min.
  double const lean = pi / 6, h = 0.1;
  Vec3 const normal{0, -std::sin(lean), std::cos(lean)};
  Mesh const mesh = shell(6, [&](double a, double b, double off) {
    return Vec3{a, b * std::cos(lean), b * std::sin(lean)} + off * Vec3{0, 0, 1};
  });
  for (auto const& [n, at, u] : moved_nodes(mesh, motion({rule({"body"}, by(h)), rule({"b_min"}, SlipRule{})}))) {
    EXPECT_NEAR(dot(u, normal), h, 1e-15);
    if (at.y == 0) {
      EXPECT_LE(std::abs(u.y), 1e-16);
    }
    if (at.z == std::sin(lean)) {
      EXPECT_LE(distance(u, h * normal), 1e-15);
    }
  }
}

TEST(Inflate, NodesOfWallsOfRevolutionThatTurnStayOnThem) {
  Mesh const mesh = bend_sector({}, 4);
  Sector const sector;
  Motion m =
      motion({rule({"inlet"}, by(0.1)), rule({"hub", "case"}, SlipRule{.surface = SlipRule::Surface::revolution})});
  m.axis = {sector.origin, sector.axis};
  BoundaryMotion const moves(mesh, resolve(mesh, m));
  int on_walls = 0;
  for (auto const& [n, at, u] : moved_nodes(mesh, m)) {
    EXPECT_NEAR(norm(u), 0.1, 0.02);
    for (SlipSurface const& wall : moves.slip_surfaces()) {
      if (distance(wall.view().project(at), at) > 1e-6) continue;
      EXPECT_LE(distance(wall.view().project(at + u), at + u), 1e-9);
      ++on_walls;
    }
  }
  EXPECT_GT(on_walls, 6);
}

TEST(Inflate, OfAPlaneMeshGoesAcrossItsLines) {
  Mesh const mesh = flat_box(5, 4, 2);
  for (auto const& [n, at, u] : moved_nodes(mesh, motion({rule({"j_max"}, by(0.25))})))
    EXPECT_LE(distance(u, {0, -0.25, 0}), 1e-16);
  for (auto const& [n, at, u] : moved_nodes(mesh, motion({rule({"i_min", "j_min"}, by(0.25))})))
    EXPECT_LE(distance(u, {at.x == 0 ? 0.25 : 0, at.y == 0 ? 0.25 : 0, 0}), 1e-15);
}

TEST(Inflate, NodesBetweenTheCornersOfCurvedFacesGoAlongWithThem) {
  // 10-node tetrahedra have nodes on sides that belong to no facet; here six around one cube whose k_min is inflated.
  Mesh mesh = to_prisms_and_tetrahedra(unit_box({2, 2, 2}), 0);
  UnstructuredTopology const topology = make_topology(mesh);
  Boundary const flat(mesh, topology, find_face_patches(mesh, topology));
  PatchSurface surface(flat, {4});
  ASSERT_EQ(surface.lines, false);
  surface.grids[0].vertex.push_back(int(surface.points.size()));
  surface.points.push_back({0.5, 0, 0});
  VertexNormals const normals(flat, surface, {}, 40);
  auto const parts = normals.parts(int(surface.points.size()) - 1);
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_LE(distance(parts[0], {0, 0, 1}), 1e-15);
}

TEST(Inflate, ZeroIsZeroBitForBitAndAShareIsAShare) {
  Mesh const mesh = annulus_sector({}, 3);
  for (auto const& [n, at, u] : moved_nodes(mesh, motion({rule({"hub"}, by(0)), rule({"inlet"}, SlipRule{})})))
    EXPECT_EQ(u, Vec3{});
  InflateRule half = by(0.5);
  half.share = 0.5;
  auto const a = moved_nodes(mesh, motion({rule({"case"}, half)})),
             b = moved_nodes(mesh, motion({rule({"case"}, by(0.25))}));
  for (std::size_t n = 0; n < a.size(); ++n) EXPECT_EQ(a[n].u, b[n].u);
}

TEST(Inflate, AnotherMotionOfTheSameRulesTakesTheOtherHeight) {
  Mesh const mesh = annulus_sector({}, 3);
  Motion const first = motion({rule({"case"}, by(0.1))}), second = motion({rule({"case"}, by(0.2))});
  BoundaryMotion const moves(mesh, resolve(mesh, first));
  BoundaryMotion const other = moves.with(second);
  for (auto const& [n, at, u] : moved_nodes(mesh, second)) {
    Vec3 v;
    other.displacement(0, {&at, 1}, {&v, 1});
    EXPECT_EQ(v, u);
  }
}

TEST(Inflate, WhatFoldsIsRefusedWithTheShareThatWouldDo) {
  // Inside a cylinder of radius 1: areas shrink as 1 - s h, to a hundredth at s h = 0.99.
  Mesh const mesh = shell(9, [](double a, double b, double off) {
    return Vec3{b, (1 - 0.1 * off) * std::cos(1.5 * a), (1 - 0.1 * off) * std::sin(1.5 * a)};
  });
  auto const grow = [&](double h) { (void)moved_nodes(mesh, motion({rule({"body"}, by(h))})); };
  std::string const message = message_of<MotionError>([&] { grow(2); });
  expect_all_in(message, {"inflate", "folds at", "height is 2", "of the height would do"});
  double const share = std::stod(message.substr(message.find("up to ") + 6));
  EXPECT_NEAR(2 * share, 0.99, 0.03);  // at rims chords stand for the circle
  EXPECT_NO_THROW(grow(2 * share));
  EXPECT_THROW(grow(2 * share * 1.01), MotionError);
  EXPECT_THROW(grow(2000), MotionError);  // far through the axis faces look right again
  EXPECT_NO_THROW(grow(-5));              // outwards nothing shrinks
  expect_all_in(message_of<MotionError>([&] { grow(std::nan("")); }), {"height", "nan"});
}

TEST(Inflate, SharpEdgesGoNoFartherThanTwoHeights) {
  Vec3 const x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  auto const of = [](std::vector<Vec3> const& normals, std::vector<Vec3> const& kept = {}) {
    return offset_direction(normals, kept);
  };
  EXPECT_LE(distance(of({x}), x), 1e-16);
  EXPECT_LE(distance(of({x, y}), x + y), 1e-15);
  EXPECT_LE(distance(of({x, y, z}), x + y + z), 1e-15);
  EXPECT_LE(distance(of({x, y}, {z}), x + y), 1e-15);
  EXPECT_LE(distance(of({x}, {std::sqrt(0.5) * (x + y)}), x - y), 1e-15);
  auto const edge = [&](double half) {  // of an edge, by half its angle
    return norm(of({{std::sin(half), std::cos(half), 0}, {std::sin(half), -std::cos(half), 0}}));
  };
  EXPECT_NEAR(edge(0.6), 1 / std::sin(0.6), 1e-13);
  EXPECT_NEAR(edge(0.4), 2, 1e-13);
  EXPECT_NEAR(edge(0.05), 2, 1e-13);
  EXPECT_EQ(of({x}, {x}), Vec3{});
}

TEST(Inflate, PlacesOnABladeAreSpanChordAndSide) {
  using namespace gridmorph::test;
  RowMesh row;
  row.add(o_blade(161, 41));
  row.add(end_wall("hub", 0, 401, 5));
  row.add(end_wall("case", 1, 401, 5));
  Mesh const mesh = row.finish();
  int checked = 0;
  InflateRule raise = by([&](SurfacePlace const& p) {
    double const h = span_of(p.point.x, radius_of(p.point));
    EXPECT_NEAR(p.span_fraction, h, 1e-9);
    double const off = std::remainder(angle_of(p.point) - camber((p.point.x - leading(h)) / chord(h), h), pitch);
    if (std::abs(off) > 0.004 && p.chord_fraction > 0.02 && p.chord_fraction < 0.98) {
      EXPECT_EQ(p.side, off > 0 ? 1 : -1) << p.chord_fraction;
      ++checked;
    }
    EXPECT_LE(p.from_leading_edge, 1.05 * p.chord);
    EXPECT_GE(p.from_leading_edge + p.from_trailing_edge, p.chord * (1 - 1e-9));
    return 0.004 * (1 - p.span_fraction) * (1 - p.chord_fraction);
  });
  raise.sections = InflateRule::Sections{.sides = true};
  Motion m =
      motion({rule({"blade"}, raise), rule({"hub", "case"}, SlipRule{.surface = SlipRule::Surface::revolution})});
  m.axis = {{0, 0, 0}, {1, 0, 0}};
  for (auto const& [n, at, u] : moved_nodes(mesh, m)) EXPECT_LE(norm(u), 0.0041);
  EXPECT_GT(checked, 80 * 41);
}

TEST(Inflate, HeightsAboveTheChordAreRefusedWhereTheyAreLimitedByIt) {
  using namespace gridmorph::test;
  RowMesh row;
  row.add(o_blade(81, 21));
  InflateRule raise = by([](SurfacePlace const& p) { return p.chord_fraction < 0.01 ? 1.0 : 0.0; });
  raise.sections = InflateRule::Sections{};
  raise.most_chords = 1;
  Motion m = motion({rule({"blade"}, raise)});
  m.axis = {{0, 0, 0}, {1, 0, 0}};
  Mesh const mesh = row.finish();
  std::string const message = message_of<MotionError>([&] { (void)moved_nodes(mesh, m); });
  expect_all_in(message, {"more than the chord", "would do"});
}

TEST(Inflate, RulesThatMeanNothingAreRefused) {
  Mesh const mesh = annulus_sector({}, 3);
  InflateRule none;
  expect_all_in(message_of<MotionError>([&] { resolve(mesh, motion({rule({"hub"}, none)})); }), {"no height"});
  expect_all_in(message_of<MotionError>([&] { resolve(mesh, motion({rule({"type:periodic"}, by(1))})); }),
                {"periodic"});
  InflateRule crease = by(1);
  crease.crease_angle_deg = 0;
  expect_all_in(message_of<MotionError>([&] { resolve(mesh, motion({rule({"hub"}, crease)})); }), {"crease"});
}

TEST(HeightTables, PassThroughTheirStationsOnEitherSide) {
  using Interpolation = SpanwiseTable::Interpolation;
  HeightTable const both({{1, 0, 0, 3}, {0, 1, 0, 2}, {0, 0, 0, 1}, {1, 1, 0, 4}}, Interpolation::linear);
  EXPECT_FALSE(both.has_sides());
  EXPECT_EQ(both.at(0, 0, 1), 1);
  EXPECT_EQ(both.at(1, 1, -1), 4);
  EXPECT_NEAR(both.at(0.5, 0.5, 1), 2.5, 1e-15);
  HeightTable const sides({{0, 0.2, 1, 5}, {0, 0.2, -1, 7}, {1, 0, 0, 9}}, Interpolation::spline);
  EXPECT_EQ(sides.at(0, 0.9, 1), 5);
  EXPECT_EQ(sides.at(0, 0.9, -1), 7);
  EXPECT_EQ(sides.at(1, 0.3, -1), 9);
  expect_all_in(message_of<MotionError>([] {
                  HeightTable({{0, 0, 0, 1}, {0, 0, 0, 2}}, Interpolation::linear);
                }),
                {"two heights", "span fraction 0"});
  expect_all_in(message_of<MotionError>([] {
                  HeightTable({{0, 0, 1, 1}}, Interpolation::linear);
                }),
                {"no heights on side -1"});
}

}  // namespace
}  // namespace gridmorph::test
