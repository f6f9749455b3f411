// Distances from walls of known shape.
#include "support/contoured_wall.hpp"
#include "support/expect_error.hpp"
#include "support/random.hpp"

#include <gridmorph/boundary/periodic_copies.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/report/tip_clearance.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace gridmorph::test {
namespace {

Axis const x_axis{{0, 0, 0}, {1, 0, 0}};
constexpr double pi = ContouredWall::pi;

/// Quadrilaterals between n_a x n_b places, right-handed about (direction a) x (direction b).
FacetList grid(int n_a, int n_b, std::function<Vec3(double, double)> const& place) {
  FacetList list;
  for (int b = 0; b <= n_b; ++b)
    for (int a = 0; a <= n_a; ++a) list.points.push_back(place(double(a) / n_a, double(b) / n_b));
  for (int b = 0; b < n_b; ++b)
    for (int a = 0; a < n_a; ++a) {
      std::int32_t const n = a + b * (n_a + 1);
      list.facets.push_back({n, n + 1, n + n_a + 2, n + n_a + 1});
    }
  return list;
}

FacetList as_triangles(FacetList const& quads) {
  FacetList list{quads.points, {}};
  for (auto const& f : quads.facets) {
    list.facets.push_back({f[0], f[1], f[2], -1});
    list.facets.push_back({f[0], f[2], f[3], -1});
  }
  return list;
}

/// A passage of the wall, normals towards the axis, from half a pitch below the angle 0 to half a pitch above.
FacetList passage(ContouredWall const& wall, int n) {
  double const pitch = 2 * pi / wall.waves;
  return grid(n, n, [&](double a, double b) {
    return wall.place(wall.first + a * (wall.last - wall.first), (b - 0.5) * pitch);
  });
}

std::vector<RigidTransform> pitches(ContouredWall const& wall) {
  auto const turn = rotation_about(x_axis.origin, x_axis.direction, 2 * pi / wall.waves);
  return {turn, turn.inverse()};
}

double largest_error(ContouredWall const& wall, SurfaceWall const& surface, double gap) {
  Random random(7);
  double worst = 0;
  for (int n = 0; n < 60; ++n) {
    double const axial = random.between(0.15, 0.85), angle = random.between(-0.25, 0.25);
    Vec3 const p = wall.place(axial, angle) + gap * wall.normal(axial, angle);
    worst = std::max(worst, std::abs(surface.distance(p) - wall.distance_of(p)));
  }
  return worst;
}

TEST(SurfaceWall, GivesTheHeightOverAPlaneWhereverItLies) {
  auto const turn = rotation_about({0.3, 0.1, -2}, {1, 2, -1}, 0.7);
  for (bool const triangles : {false, true}) {
    FacetList list = grid(7, 5, [&](double a, double b) { return turn({a, 2 * b, 0}); });
    if (triangles) list = as_triangles(list);
    SurfaceWall const wall(list);
    Random random(3);
    for (int n = 0; n < 50; ++n) {
      double const height = random.between(-0.2, 0.2);
      EXPECT_NEAR(wall.distance(turn({random.between(0, 1), random.between(0, 2), height})), height, 1e-14);
    }
    EXPECT_NEAR(wall.distance(turn({-0.3, 1, 0.4})), 0.5, 1e-14) << "beyond the end: to its rim";
    for (auto& f : list.facets) std::reverse(f.begin(), f.begin() + (f[3] < 0 ? 3 : 4));
    EXPECT_NEAR(SurfaceWall(list).distance(turn({0.5, 0.5, 0.1})), -0.1, 1e-14) << "the mesh on its other side";
  }
}

TEST(SurfaceWall, GivesTheShortestDistanceFromAContouredWall) {
  ContouredWall const wall;
  for (double const gap : {0.004, 0.02, -0.003}) {
    double const coarse = largest_error(wall, SurfaceWall(with_copies(passage(wall, 16), pitches(wall))), gap);
    double const fine = largest_error(wall, SurfaceWall(with_copies(passage(wall, 32), pitches(wall))), gap);
    EXPECT_LT(coarse, 3e-5);
    EXPECT_LT(fine, coarse / 7) << "error of order h^4 at the wall, d h^2 along it";
    EXPECT_LT(largest_error(wall, SurfaceWall(with_copies(as_triangles(passage(wall, 32)), pitches(wall))), gap), 3e-5);
  }
  // The meridional distance from a wall like this means nothing, so it is not taken.
  EXPECT_FALSE(RevolutionWall::through(x_axis, passage(wall, 32).points));
}

TEST(SurfaceWall, SeesTheCopyBehindAPeriodicSide) {
  ContouredWall const wall;
  double const side = pi / wall.waves;
  SurfaceWall const one(passage(wall, 32)), three(with_copies(passage(wall, 32), pitches(wall)));
  for (double const beyond : {0.02, -0.02, 0.1})  // a tip that leans over the side
    for (double const sign : {-1.0, 1.0}) {
      Vec3 const p = wall.place(0.45, sign * (side + beyond)) + 0.01 * wall.normal(0.45, sign * (side + beyond));
      EXPECT_NEAR(three.distance(p), wall.distance_of(p), 1e-5);
      if (beyond > 0) {
        EXPECT_GT(std::abs(one.distance(p) - wall.distance_of(p)), 1e-3) << "the passage alone ends there";
      }
    }
}

TEST(SurfaceWall, KnowsTheSideOfEveryPartOfAWall) {
  // Two walls of a channel, each listed with its normals into it, in one list.
  FacetList both = grid(4, 4, [](double a, double b) { return Vec3{a, b, 0}; });
  both.add(grid(4, 4, [](double a, double b) { return Vec3{b, a, 1}; }));
  SurfaceWall const wall(both);
  EXPECT_NEAR(wall.distance({0.3, 0.6, 0.2}), 0.2, 1e-15);
  EXPECT_NEAR(wall.distance({0.3, 0.6, 0.9}), 0.1, 1e-15);
  EXPECT_NEAR(wall.distance({0.3, 0.6, -0.1}), -0.1, 1e-15);
  EXPECT_NEAR(wall.distance({0.3, 0.6, 1.1}), -0.1, 1e-15);
}

TEST(SurfaceWall, KnowsTheSideOfASmallPartOfALargeWall) {
  FacetList list = grid(60, 60, [](double a, double b) { return Vec3{a, b, 0}; });
  for (int const n : {0, 1})  // one facet looks down, the other up
    list.add(grid(1, 1, [&](double a, double b) {
      return n == 0 ? Vec3{0.4 + 0.1 * b, 0.4 + 0.1 * a, 1} : Vec3{0.7 + 0.1 * a, 0.4 + 0.1 * b, 1};
    }));
  SurfaceWall const wall(list);
  EXPECT_NEAR(wall.distance({0.45, 0.45, 0.9}), 0.1, 1e-15);
  EXPECT_NEAR(wall.distance({0.75, 0.45, 0.9}), -0.1, 1e-15);
  EXPECT_NEAR(wall.distance({0.75, 0.45, 1.1}), 0.1, 1e-15);
}

TEST(SurfaceWall, GoesRoundTheEdgesOfAGroove) {
  // A groove of depth 0.1 and width 0.2 across a plane: from above the nearest place is a wall, an edge or the floor.
  FacetList list;
  auto const strip = [&](double x0, double z0, double x1, double z1) {
    list.add(grid(4, 6, [&](double a, double b) { return Vec3{x0 + a * (x1 - x0), b, z0 + a * (z1 - z0)}; }));
  };
  strip(0, 0, 0.4, 0);
  strip(0.4, 0, 0.4, -0.1);
  strip(0.4, -0.1, 0.6, -0.1);
  strip(0.6, -0.1, 0.6, 0);
  strip(0.6, 0, 1, 0);
  SurfaceWall const wall(list);
  EXPECT_NEAR(wall.distance({0.2, 0.5, 0.02}), 0.02, 1e-12);
  EXPECT_NEAR(wall.distance({0.5, 0.5, 0.01}), std::hypot(0.1, 0.01), 1e-12) << "the edges are nearer than the floor";
  EXPECT_NEAR(wall.distance({0.47, 0.5, -0.04}), 0.06, 1e-12) << "floor";
  EXPECT_NEAR(wall.distance({0.43, 0.5, -0.04}), 0.03, 1e-12) << "side";
  EXPECT_NEAR(wall.distance({0.38, 0.5, -0.03}), -0.02, 1e-12) << "in the land";
}

TEST(SurfaceWall, AgreesWithTheMeridionalDistanceOnWallsOfRevolution) {
  auto const radius = [](double a) { return 0.9 - 0.1 * a + 0.05 * std::sin(3 * a); };
  for (int const n : {16, 32}) {
    auto const list =
        grid(n, n, [&](double a, double b) { return ContouredWall::at_radius(a, 0.6 * b - 0.3, radius(a)); });
    auto const profile = RevolutionWall::through(x_axis, list.points);
    ASSERT_TRUE(profile);
    SurfaceWall const surface(list);
    double worst = 0;
    for (double const axial : {0.21, 0.5, 0.77})
      for (double const angle : {-0.17, 0.0, 0.04, 0.21})
        for (double const gap : {0.02, 0.001, -0.004}) {
          Vec3 const p = ContouredWall::at_radius(axial, angle, radius(axial) - gap);
          worst = std::max(worst, std::abs(surface.distance(p) - profile->distance(p)));
        }
    EXPECT_LT(worst, n == 16 ? 1e-6 : 2e-7) << "the chords of the profile, sixteen to a facet, are off by as much";
  }
}

TEST(SurfaceWall, GoesOnWhereABladeStandsOnIt) {
  // The wall of an H mesh ends at the blade, which leans by a third of what it is wide: what was under it is no end of
  // the wall.
  ContouredWall const wall;
  double const pitch = 2 * pi / wall.waves, half = 0.2 * pitch;  // of the blade
  FacetList const list = grid(32, 32, [&](double a, double b) { return wall.place(a, half + b * (pitch - 2 * half)); });
  std::vector<Vec3> foot;
  for (int n = 0; n <= 32; ++n) foot.push_back(wall.place(n / 32.0, half));
  SurfaceWall const ends(list), goes_on(list, foot);
  for (double const gap : {0.004, -0.004})
    for (double const beyond : {0.01, 0.03}) {
      Vec3 const p = wall.place(0.5, half - beyond) + gap * wall.normal(0.5, half - beyond);
      EXPECT_NEAR(goes_on.distance(p), wall.distance_of(p), 2.5 * beyond * beyond) << "as a tangent plane does";
      EXPECT_GT(std::abs(ends.distance(p)), 0.8 * beyond);
    }
  Vec3 const other = wall.place(0.5, pitch - half + 0.02) + 0.004 * wall.normal(0.5, pitch - half + 0.02);
  EXPECT_GT(goes_on.distance(other), 0.015) << "no blade stands at the other end";
}

TEST(SurfaceWall, NeedsAnArea) {
  EXPECT_NE(message_of<MotionError>([] { SurfaceWall(FacetList{}); }), "");
}

TEST(RevolutionWall, IsTheRadialGapUnderACylinderAndTheShortestOneUnderACone) {
  Axis const axis{{0.1, -0.2, 0.3}, {0, 0, 2}};
  auto const place = [&](double axial, double radius, double angle) {
    return axis.origin + Vec3{radius * std::cos(angle), radius * std::sin(angle), axial};
  };
  auto const wall = [&](double slope) {
    std::vector<Vec3> out;
    for (int i = 0; i <= 40; ++i)
      for (double angle = 0; angle < 0.3; angle += 0.05) out.push_back(place(i / 40.0, 0.9 + slope * i / 40, angle));
    return RevolutionWall::through(axis, out);
  };
  double const slope = 0.5;
  auto const cylinder = wall(0), cone = wall(slope);
  ASSERT_TRUE(cylinder);
  ASSERT_TRUE(cone);
  EXPECT_LT(cylinder->scatter(), 1e-15);
  for (double const axial : {0.213, 0.5, 0.77})
    for (double const gap : {0.02, 0.001, -0.004}) {
      EXPECT_NEAR(cylinder->distance(place(axial, 0.9 - gap, 2.1)), gap, 1e-15);
      EXPECT_NEAR(cone->distance(place(axial, 0.9 + slope * axial - gap, 2.1)), gap / std::hypot(1, slope), 1e-15);
    }
}

TEST(RevolutionWall, IsOneOfRevolutionAlone) {
  std::vector<Vec3> flat;
  for (double x = 0; x < 1; x += 0.1)
    for (double y = 0; y < 1; y += 0.1) flat.push_back({x, y, 0.5 + 0.1 * x});
  EXPECT_FALSE(RevolutionWall::through(x_axis, flat));
  EXPECT_FALSE(RevolutionWall::through(x_axis, {})) << "no nodes";
  std::vector<Vec3> disc;
  for (double r = 0.5; r < 1; r += 0.1) disc.push_back(ContouredWall::at_radius(0, r, r));
  EXPECT_FALSE(RevolutionWall::through(x_axis, disc)) << "no radius over the axial position";
}

TEST(RevolutionWall, IsToldWhereNodesOfElementsHaveAStationEach) {
  // No two nodes are at one axial position: which radii go together only the profile says.
  Random random(11);
  std::vector<std::array<double, 2>> places;
  for (int n = 0; n < 2000; ++n) places.push_back({random.between(0, 1), random.between(-0.26, 0.26)});
  for (double const amplitude : {0.0, 1e-4, 0.03}) {
    ContouredWall wall;
    wall.amplitude = amplitude;
    std::vector<Vec3> nodes;
    for (auto const& [axial, angle] : places) nodes.push_back(wall.place(axial, angle));
    EXPECT_EQ(RevolutionWall::through(x_axis, nodes) != nullptr, amplitude == 0) << amplitude;
  }
}

}  // namespace
}  // namespace gridmorph::test
