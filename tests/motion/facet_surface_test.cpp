// Discrete surfaces made smooth: how near they are to the surface their points come from, and the foot of a point.
#include "support/expect_error.hpp"
#include "support/random.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/geometry/facet_surface.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

namespace gridmorph {
namespace {

using kernels::FacetFoot;

using test::expect_all_in;
using test::message_of;
using test::Random;

constexpr double pi = std::numbers::pi;

/// A surface as a map of the unit square, and the distance of a point from it.
struct Shape {
  std::string name;
  std::function<Vec3(double, double)> at;
  std::function<double(Vec3 const&)> off;
};

Shape sphere() {
  return {"sphere",
          [](double u, double v) {
            double const a = -0.8 + 1.6 * u, b = -0.7 + 1.3 * v;
            return Vec3{std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b)};
          },
          [](Vec3 const& p) { return std::abs(norm(p) - 1); }};
}

/// About a point of it that all lines of one direction end in.
Shape polar_cap() {
  return {"polar cap",
          [](double u, double v) {
            double const a = 2 * pi * u, b = 1.2 * v;
            return Vec3{std::sin(b) * std::cos(a), std::sin(b) * std::sin(a), std::cos(b)};
          },
          sphere().off};
}

double off_torus(Vec3 const& p) { return std::abs(std::hypot(std::hypot(p.x, p.y) - 2, p.z) - 0.5); }

Shape torus() {
  return {"torus",
          [](double u, double v) {
            double const a = 2 * pi * u, r = 2 + 0.5 * std::cos(2 * pi * v);
            return Vec3{r * std::cos(a), r * std::sin(a), 0.5 * std::sin(2 * pi * v)};
          },
          off_torus};
}

/// A part of it between lines that are no lines of curvature and cross at changing angles.
Shape skewed_torus() {
  return {"skewed torus",
          [](double u, double v) {
            double const a = 1.5 * u + 0.5 * v * v, b = 2 * pi * (0.4 * v + 0.1 * u) + 0.2 * std::sin(3 * u);
            double const r = 2 + 0.5 * std::cos(b);
            return Vec3{r * std::cos(a), r * std::sin(a), 0.5 * std::sin(b)};
          },
          off_torus};
}

Shape cylinder() {
  return {"cylinder",
          [](double u, double v) {
            double const a = 1.8 * u;
            return Vec3{3 * v, 0.7 * std::cos(a), 0.7 * std::sin(a)};
          },
          [](Vec3 const& p) { return std::abs(std::hypot(p.y, p.z) - 0.7); }};
}

enum class Cut { quads, triangles };

FacetList sampled(Shape const& shape, int n, Cut cut) {
  FacetList list;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) list.points.push_back(shape.at(double(i) / n, double(j) / n));
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      int const a = i + (n + 1) * j, b = a + 1, c = b + n + 1, d = c - 1;
      if (cut == Cut::quads) {
        list.facets.push_back({a, b, c, d});
      } else if ((i + j) % 2 == 0) {
        list.facets.push_back({a, b, c, -1});
        list.facets.push_back({a, c, d, -1});
      } else {
        list.facets.push_back({a, b, d, -1});
        list.facets.push_back({b, c, d, -1});
      }
    }
  return list;
}

/// The same surface as a file might have it: points of its own for every facet, in any order, turned and mirrored.
FacetList scrambled(FacetList const& list, Random& random) {
  std::vector<std::array<std::int32_t, 4>> facets = list.facets;
  random.shuffle(facets);
  FacetList out;
  for (auto const& facet : facets) {
    int const size = facet[3] < 0 ? 3 : 4, start = random.below(size), step = random.coin() ? 1 : size - 1;
    std::array<std::int32_t, 4> own{-1, -1, -1, -1};
    for (int q = 0; q < size; ++q) {
      own[q] = std::int32_t(out.points.size());
      out.points.push_back(list.points[facet[(start + q * step) % size]]);
    }
    out.facets.push_back(own);
  }
  return out;
}

/// Largest distance, from the true surface, of feet of points up to `away` off it.
double largest_error(Shape const& shape, FacetSurface const& surface, double away) {
  Random random(5);
  double worst = 0;
  for (int m = 0; m < 4000; ++m) {
    Vec3 const on = shape.at(random.unit(), random.unit());
    Vec3 const normal = surface.closest_point(on).normal;
    worst = std::max(worst, shape.off(surface.closest_point(on + random.between(-away, away) * normal).point));
  }
  return worst;
}

class FacetSurfaceOrder : public ::testing::TestWithParam<Shape> {};

TEST_P(FacetSurfaceOrder, QuadrilateralsAreOffByTheFourthPowerOfTheirSize) {
  auto const error = [&](int n) {
    return largest_error(GetParam(), FacetSurface::from_facets(sampled(GetParam(), n, Cut::quads)), 0.05);
  };
  double const coarse = error(24), middle = error(48), fine = error(96);
  EXPECT_LT(coarse, 1e-3);
  EXPECT_GT(std::log2(coarse / fine) / 2, 3.7) << coarse << " " << middle << " " << fine;
}

TEST_P(FacetSurfaceOrder, TrianglesAreOffByTheThirdPowerOfTheirSize) {
  auto const error = [&](int n) {
    return largest_error(GetParam(), FacetSurface::from_facets(sampled(GetParam(), n, Cut::triangles)), 0.05);
  };
  double const coarse = error(24), fine = error(96);
  EXPECT_LT(coarse, 2e-3);
  EXPECT_GT(std::log2(coarse / fine) / 2, 2.7) << coarse << " " << fine;
}

INSTANTIATE_TEST_SUITE_P(Shapes, FacetSurfaceOrder,
                         ::testing::Values(sphere(), polar_cap(), torus(), skewed_torus(), cylinder()),
                         [](auto const& info) {
                           std::string name = info.param.name;
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

TEST(FacetSurface, GoesThroughItsPoints) {
  for (Cut const cut : {Cut::quads, Cut::triangles})
    for (Shape const& shape : {torus(), polar_cap(), skewed_torus()}) {
      FacetList const list = sampled(shape, 20, cut);
      FacetSurface const surface = FacetSurface::from_facets(list);
      for (Vec3 const& p : list.points)
        EXPECT_LE(surface.closest_point(p).distance, 1e-14 * surface.size()) << shape.name;
    }
}

TEST(FacetSurface, FeetAreTheirOwnFeet) {
  Random random(7);
  for (Cut const cut : {Cut::quads, Cut::triangles}) {
    FacetSurface const surface = FacetSurface::from_facets(sampled(skewed_torus(), 16, cut));
    for (int m = 0; m < 2000; ++m) {
      Vec3 const p = skewed_torus().at(random.unit(), random.unit()) + random.vector(0.1);
      FacetFoot const foot = surface.closest_point(p);
      EXPECT_LE(surface.closest_point(foot.point).distance, 1e-13);
      EXPECT_NEAR(foot.distance, distance(p, foot.point), 1e-15);
      EXPECT_NEAR(norm(foot.normal), 1, 1e-14);
    }
  }
}

TEST(FacetSurface, DoesNotDependOnHowItIsStored) {
  Random random(11);
  for (Cut const cut : {Cut::quads, Cut::triangles})
    for (Shape const& shape : {torus(), polar_cap(), skewed_torus()}) {
      FacetList const list = sampled(shape, 15, cut);
      FacetSurface const one = FacetSurface::from_facets(list);
      FacetSurface const other = FacetSurface::from_facets(scrambled(list, random));
      ASSERT_EQ(one.facets.size(), other.facets.size());
      for (int m = 0; m < 500; ++m) {
        Vec3 const p = shape.at(random.unit(), random.unit()) + random.vector(0.05);
        EXPECT_LE(distance(one.closest_point(p).point, other.closest_point(p).point), 1e-14) << shape.name;
      }
    }
}

TEST(FacetSurface, FeetMoveContinuouslyFromFacetToFacet) {
  // Along a line over many facets the foot moves evenly: a faceted surface would hold it at the edges and jump or hurry
  // between them.
  FacetSurface const surface = FacetSurface::from_facets(sampled(torus(), 24, Cut::quads));
  int const n = 20000;
  double least = 1, most = 0;
  Vec3 before;
  for (int m = 0; m <= n; ++m) {
    double const a = 2.0 * m / n, b = 0.9 * m / n;
    double const r = 2 + 0.6 * std::cos(b);  // 0.1 outside
    Vec3 const foot = surface.closest_point({r * std::cos(a), r * std::sin(a), 0.6 * std::sin(b)}).point;
    if (m > 0) {
      least = std::min(least, distance(foot, before));
      most = std::max(most, distance(foot, before));
    }
    before = foot;
  }
  // The true feet's steps: 2.5 to 2.31 times 2 / n around, and 0.5 times 0.9 / n across.
  EXPECT_GT(least, 0.97 * std::hypot(2.31 * 2.0 / n, 0.5 * 0.9 / n));
  EXPECT_LT(most, 1.03 * std::hypot(2.5 * 2.0 / n, 0.5 * 0.9 / n));
}

TEST(FacetSurface, TheRateIsTheDerivativeOfTheFoot) {
  Random random(3);
  for (Cut const cut : {Cut::quads, Cut::triangles}) {
    FacetSurface const surface = FacetSurface::from_facets(sampled(torus(), 20, cut));
    for (int m = 0; m < 300; ++m) {
      Vec3 const p = torus().at(random.unit(), random.unit()) + random.vector(0.05), rate = random.vector(1);
      double const h = 1e-6;
      FacetFoot const foot = surface.closest_point(p), after = surface.closest_point(p + h * rate),
                      before = surface.closest_point(p - h * rate);
      if (foot.facet != after.facet || foot.facet != before.facet) continue;  // not differentiable at an edge
      Vec3 const expected = (0.5 / h) * (after.point - before.point);
      EXPECT_LE(distance(surface.view().foot_rate(foot, p, rate), expected), 1e-8);
    }
  }
}

TEST(FacetSurface, APlaneStaysExactlyPlane) {
  Random random(2);
  FacetList list;
  int const n = 9;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) list.points.push_back({i + 0.3 * random.unit(), j + 0.3 * random.unit(), 0.25});
  for (int j = 0; j + 1 < n; ++j)
    for (int i = 0; i + 1 < n; ++i)
      list.facets.push_back({i + n * j, i + 1 + n * j, i + 1 + n * (j + 1), i + n * (j + 1)});
  FacetSurface const surface = FacetSurface::from_facets(list);
  for (int m = 0; m < 500; ++m) {
    Vec3 const p{random.between(-2, 11), random.between(-2, 11), random.between(-3, 3)};
    FacetFoot const foot = surface.closest_point(p);
    EXPECT_EQ(foot.point.z, 0.25);
    // Beyond its rim the surface goes on along its tangent plane.
    Vec3 const slid = surface.view().slide(foot, p);
    EXPECT_NEAR(slid.x, p.x, 1e-12);
    EXPECT_NEAR(slid.y, p.y, 1e-12);
    EXPECT_NEAR(slid.z, 0.25, 1e-12);
  }
}

/// A roof: two flat slopes that meet at a right angle along the y axis.
FacetList roof() {
  FacetList list;
  for (int j = 0; j <= 4; ++j)
    for (int i = -3; i <= 3; ++i) list.points.push_back({double(i), double(j), -std::abs(double(i))});
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 6; ++i) list.facets.push_back({i + 7 * j, i + 1 + 7 * j, i + 8 + 7 * j, i + 7 + 7 * j});
  return list;
}

TEST(FacetSurface, ACreaseStaysSharp) {
  FacetSurface const surface = FacetSurface::from_facets(roof());
  FacetFoot const above = surface.closest_point({0.1, 1.3, 0.5});
  EXPECT_LE(distance(above.point, {0, 1.3, 0}), 1e-14);
  EXPECT_EQ(above.place, FacetFoot::Place::crease);
  EXPECT_LE(distance(surface.closest_point({1.5, 2.2, -0.5}).point, {1, 2.2, -1}), 1e-14);
  // Under the roof the nearer slope counts.
  EXPECT_LE(distance(surface.closest_point({-0.2, 2.2, -1}).point, {-0.6, 2.2, -0.6}), 1e-14);
  EXPECT_LE(distance(surface.closest_point({0.2, 2.2, -1}).point, {0.6, 2.2, -0.6}), 1e-14);

  FacetSurface const rounded = FacetSurface::from_facets(roof(), {.crease_angle_rad = 2});
  EXPECT_EQ(rounded.closest_point({0.1, 1.3, 0.5}).place, FacetFoot::Place::inside);
}

TEST(FacetSurface, EqualTiesAreBrokenTheSameWayHoweverItIsStored) {
  // The centre of a closed cylinder is equally far from all of it.
  Shape const tube{"tube", [](double u, double v) { return Vec3{v, std::cos(2 * pi * u), std::sin(2 * pi * u)}; }, {}};
  FacetList const list = sampled(tube, 16, Cut::quads);
  Random random(8);
  Vec3 const centre{0.5, 0, 0}, foot = FacetSurface::from_facets(list).closest_point(centre).point;
  for (int m = 0; m < 5; ++m)
    EXPECT_EQ(foot, FacetSurface::from_facets(scrambled(list, random)).closest_point(centre).point);
}

TEST(FacetSurface, CollapsedAndRepeatedFacetsChangeNothing) {
  FacetList list = roof();
  std::size_t const n = FacetSurface::from_facets(list).facets.size();
  list.facets.push_back(list.facets[3]);
  list.facets.push_back({0, 1, 1, 0});
  list.facets.push_back({4, 4, 4, -1});
  EXPECT_EQ(FacetSurface::from_facets(list).facets.size(), n);
}

TEST(FacetSurface, WhatIsNoSurfaceIsRefused) {
  FacetList list = roof();
  list.facets[2][1] = 99;
  expect_all_in(message_of<MotionError>([&] { FacetSurface::from_facets(list); }), {"facet 3", "point 100", "35"});
  list = roof();
  list.points[7].y = std::nan("");
  expect_all_in(message_of<MotionError>([&] { FacetSurface::from_facets(list); }), {"point 8", "not finite"});
  list.facets.clear();
  list.points.clear();
  EXPECT_THROW(FacetSurface::from_facets(list), MotionError);
  EXPECT_THROW(FacetSurface::from_facets({{{0, 0, 0}, {1, 0, 0}}, {{0, 1, 0, 1}}}), MotionError);
}

TEST(FacetSurface, PointsAnywhereHaveAFoot) {
  Random random(4);
  for (Shape const& shape : {torus(), polar_cap(), skewed_torus()}) {
    FacetSurface const surface = FacetSurface::from_facets(sampled(shape, 16, Cut::quads));
    for (int m = 0; m < 500; ++m) {
      FacetFoot const foot = surface.closest_point(random.vector(10));
      ASSERT_GE(foot.facet, 0);
      EXPECT_LE(shape.off(foot.point), 1e-3) << shape.name;
    }
    EXPECT_GE(surface.closest_point({std::nan(""), 0, 0}).facet, 0);
  }
}

/// Columns of an H grid around the round nose of a hole in the plane z = 0: behind the nose grid lines turn by eighty
/// degrees, so that local coordinates of the facets there fold.
TEST(FacetSurface, KinkedGridLinesHaveAFootForEveryPoint) {
  std::array<double, 15> const x{-5.355, -3.732, -2.478, -1.594, -.97,  -.53,  -.219, 0,
                                 .219,   .512,   .903,   1.426,  2.121, 3.041, 4.252};
  std::array<double, 8> const low{0, -1.315, -1.931, -2.465, -2.965, -3.444, -3.9, -4.3},
      high{0, 1.496, 2.351, 3.198, 4.103, 5.1, 6.21, 7.45};
  std::array<double, 6> const y{0, .56, 1.3, 2.25, 3.49, 5.08};
  constexpr int n = 15, m = 6, nose = 7;
  FacetList list;
  for (int const side : {1, -1}) {
    auto const first = std::int32_t(list.points.size());
    for (int j = 0; j < m; ++j)
      for (int i = 0; i < n; ++i) {
        double const rim = i < nose ? .55 * (x[i] + .219) : (side > 0 ? high[i - nose] : low[i - nose]);
        list.points.push_back({x[i], rim + side * y[j], 0});
      }
    for (std::int32_t j = 0; j + 1 < m; ++j)
      for (std::int32_t i = 0; i + 1 < n; ++i) {
        std::int32_t const a = first + i + n * j;
        list.facets.push_back({a, a + 1, a + 1 + n, a + n});
      }
  }
  FacetSurface const surface = FacetSurface::from_facets(list);
  // How far a point of the plane is from the flat facets; the rim between their corners is curved.
  auto const from_facets = [&](double px, double py) {
    double best = 1e9;
    for (auto const& f : list.facets) {
      int left = 0;
      double edge = 1e9;
      for (int q = 0; q < 4; ++q) {
        Vec3 const a = list.points[f[q]], d = list.points[f[(q + 1) % 4]] - a;
        left += d.x * (py - a.y) - d.y * (px - a.x) > 0 ? 1 : 0;
        double const t = std::clamp(((px - a.x) * d.x + (py - a.y) * d.y) / dot(d, d), 0.0, 1.0);
        edge = std::min(edge, std::hypot(px - a.x - t * d.x, py - a.y - t * d.y));
      }
      best = std::min(best, left == 0 || left == 4 ? 0 : edge);
    }
    return best;
  };
  for (double px = -1; px < 2; px += 0.0371)
    for (double py = -2; py <= 2; py += 0.0413)
      for (double const pz : {0.01, 1.0, 2.3}) {
        kernels::FacetFoot const foot = surface.closest_point({px, py, pz});
        ASSERT_GE(foot.facet, 0) << px << " " << py << " " << pz;
        ASSERT_NEAR(foot.distance, std::hypot(from_facets(px, py), pz), 0.07) << px << " " << py << " " << pz;
      }
}

}  // namespace
}  // namespace gridmorph
