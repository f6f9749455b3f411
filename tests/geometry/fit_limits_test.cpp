// Affine displacements, planes and normals through points whose answers are known, in any position; points that do not
// say enough.
#include "support/random.hpp"

#include <gridmorph/geometry/affine_fit.hpp>
#include <gridmorph/geometry/plane_fit.hpp>
#include <gridmorph/geometry/rotation.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace gridmorph::test {
namespace {

Mat3 from_columns(Vec3 const& a, Vec3 const& b, Vec3 const& c) {
  return {{{a.x, b.x, c.x}, {a.y, b.y, c.y}, {a.z, b.z, c.z}}};
}

/// Somewhere, at some angle.
RigidTransform placed(Random& random) { return {rotation_by(random.vector(2)), random.vector(5)}; }

/// Points of the box |x| <= size.x, ..., placed.
std::vector<Vec3> points_in(Vec3 const& size, int n, RigidTransform const& place, Random& random) {
  std::vector<Vec3> points;
  for (int k = 0; k < n; ++k) {
    Vec3 const p = random.vector(1);
    points.push_back(place({p.x * size.x, p.y * size.y, p.z * size.z}));
  }
  return points;
}

template <class Displacement>
std::vector<Vec3> displaced(std::vector<Vec3> const& points, Displacement const& u) {
  std::vector<Vec3> out;
  for (Vec3 const& p : points) out.push_back(u(p));
  return out;
}

TEST(AffineFit, ReproducesAffineDisplacementsAndTurnsNormals) {
  Random random(1);
  for (int const n : {4, 30, 400}) {
    RigidTransform const place = placed(random);
    auto const points = points_in({1, 2, 0.8}, n, place, random);
    Mat3 const g = from_columns(random.vector(0.5), random.vector(0.5), random.vector(0.5));
    Vec3 const t = random.vector(3);
    auto const u = [&](Vec3 const& x) { return g * x + t; };
    auto const fit = fit_affine(points, displaced(points, u), points);
    for (Vec3 const& x : points_in({3, 3, 3}, 20, place, random)) EXPECT_LT(distance(fit(x), u(x)), 1e-11) << n;
    Vec3 const a = random.vector(1), b = random.vector(1);
    EXPECT_LT(distance(fit.turned(cross(a, b)), cross(a + g * a, b + g * b)), 1e-11);
  }
}

TEST(AffineFit, OfALineHasNoGradientAcrossIt) {
  Random random(3);
  RigidTransform const place = placed(random);
  auto const points = points_in({1, 0, 0}, 30, place, random);
  Vec3 const along = place.rotation * Vec3{1, 0, 0}, slope = random.vector(1);
  auto const u = [&](Vec3 const& x) { return dot(x, along) * slope + Vec3{1, 2, 3}; };
  auto const fit = fit_affine(points, displaced(points, u), points);
  for (Vec3 const& x : points_in({3, 3, 3}, 20, place, random)) EXPECT_LT(distance(fit(x), u(x)), 1e-12);
}

TEST(AffineFit, PointsThinnerThanTheirRegionSayNothingAboutItsThickness) {
  Random random(4);
  RigidTransform const place = placed(random);
  Vec3 const across = place.rotation * Vec3{0, 0, 1};
  // Mirrored in pairs, so that what varies across does not look like something that varies along.
  std::vector<Vec3> points;
  for (Vec3 const& p : points_in({1, 1, 0.02}, 40, {}, random))
    for (double const side : {-1, 1}) points.push_back(place({p.x, p.y, side * p.z}));
  auto const region = points_in({1, 1, 1}, 400, place, random);
  auto const u = [&](Vec3 const& x) { return 10 * dot(x, across) * across; };
  auto const given = displaced(points, u);
  EXPECT_LT(distance(fit_affine(points, given, points).gradient * across, 10 * across), 1e-10);
  EXPECT_LT(norm(fit_affine(points, given, region).gradient * across), 1e-10);
}

TEST(AffineFit, OfNothingIsExactlyNothing) {
  Random random(5);
  auto const points = points_in({1, 1, 1}, 10, {}, random);
  for (auto const& fit : {fit_affine(points, std::vector<Vec3>(10), points), fit_affine({}, {}, points)}) {
    EXPECT_EQ(fit({3, 4, 5}), Vec3{});
    EXPECT_EQ(fit.turned({1, 2, 3}), (Vec3{1, 2, 3}));
  }
}

TEST(PlaneFit, FindsThePlaneOfItsPoints) {
  Random random(6);
  for (int const n : {3, 20, 500}) {
    RigidTransform const place = placed(random);
    auto const points = points_in({3, 0.5, 0}, n, place, random);
    auto const fit = fit_plane(points);
    EXPECT_TRUE(fit.determined);
    EXPECT_NEAR(std::abs(dot(fit.normal, place.rotation * Vec3{0, 0, 1})), 1, 1e-12);
    EXPECT_NEAR(norm(fit.normal), 1, 1e-15);
    EXPECT_LT(fit.deviation, 1e-13);
    EXPECT_LE(fit.extent, 2 * std::hypot(3, 0.5));
    for (Vec3 const& p : points) EXPECT_LE(distance(p, fit.origin), fit.extent * (1 + 1e-15));
    EXPECT_NEAR(deviation_from_plane(points, fit.origin + 0.25 * fit.normal, fit.normal), 0.25, 1e-13);
  }
  // On a coordinate plane without round-off.
  std::vector<Vec3> points;
  for (Vec3 const& p : points_in({1, 1, 0}, 20, {}, random)) points.push_back({p.x, 0.1, p.y});
  auto const fit = fit_plane(points);
  EXPECT_EQ(std::abs(fit.normal.y), 1);
  EXPECT_EQ(fit.deviation, 0);
}

TEST(PlaneFit, OfALineOrAPointIsNotDetermined) {
  Random random(8);
  RigidTransform const place = placed(random);
  EXPECT_FALSE(fit_plane(points_in({1, 0, 0}, 10, place, random)).determined);
  EXPECT_FALSE(fit_plane(std::vector<Vec3>(5, Vec3{1, 2, 3})).determined);
  EXPECT_FALSE(fit_plane(std::vector<Vec3>{{1, 2, 3}}).determined);
  EXPECT_TRUE(fit_plane(points_in({1, 1e-3, 0}, 10, place, random)).determined);
}

/// Of z = height(x, y) over n points of a disc of radius h, seen at an angle: the angle between normals at (0, 0),
/// where the slopes of the height are (1, 0.5).
double error_of_normal(double h, int n) {
  Random random(9);
  RigidTransform const place = placed(random);
  std::vector<Vec3> around;
  for (int k = 0; k < n; ++k) {
    double const angle = 2.4 * k, r = h * std::sqrt((k + 0.7) / n), x = r * std::cos(angle), y = r * std::sin(angle);
    around.push_back(place({x, y, std::exp(x + 0.5 * y) - 1}));
  }
  Vec3 const exact = place.rotation * ((1 / 1.5) * Vec3{-1, -0.5, 1}), guess = place.rotation * Vec3{-0.6, 0, 0.8};
  auto const fitted = fit_normal(place({0, 0, 0}), guess, around);
  return fitted ? distance(*fitted, exact) : 1;
}

TEST(HeightFit, CubicsAreOffByTheThirdPowerAndQuadraticsByTheSecond) {
  for (double const h : {0.4, 0.2, 0.1}) {
    EXPECT_LT(error_of_normal(h / 2, 24), error_of_normal(h, 24) / 6) << h;
    EXPECT_LT(error_of_normal(h / 2, 9), error_of_normal(h, 9) / 3) << h;
  }
  EXPECT_LT(error_of_normal(0.1, 24), 1e-4);
  EXPECT_LT(error_of_normal(0.1, 9), 5e-3);
}

TEST(HeightFit, PlanesAndCubicsOverTheirTangentPlaneAreExact) {
  Random random(10);
  for (int trial = 0; trial < 20; ++trial) {
    RigidTransform const place = placed(random);
    Vec3 const normal = place.rotation * Vec3{0, 0, 1};
    double const a = random.between(-1, 1), b = random.between(-1, 1), c = random.between(-1, 1);
    std::vector<Vec3> flat, curved;
    for (Vec3 const& p : points_in({1, 0.02, 0}, 30, {}, random)) {
      flat.push_back(place(p));
      curved.push_back(place({p.x, p.y, a * p.x * p.x + b * p.x * p.y + c * p.x * p.x * p.y}));
    }
    Vec3 tilted = normal + random.vector(0.3);
    tilted = (1 / norm(tilted)) * tilted;
    auto const of_flat = fit_normal(place({}), tilted, flat), of_curved = fit_normal(place({}), normal, curved);
    ASSERT_TRUE(of_flat && of_curved);
    EXPECT_LT(distance(*of_flat, normal), 1e-10);
    EXPECT_LT(distance(*of_curved, normal), 1e-10);
  }
}

TEST(HeightFit, PointsThatDoNotDetermineItGiveNothing) {
  Random random(11);
  RigidTransform const place = placed(random);
  Vec3 const centre = place({0, 0, 0}), normal = place.rotation * Vec3{0, 0, 1};
  EXPECT_FALSE(fit_normal(centre, normal, {}));
  EXPECT_FALSE(fit_normal(centre, normal, points_in({1, 1, 0}, 5, place, random)));
  EXPECT_FALSE(fit_normal(centre, normal, points_in({1, 0, 0}, 30, place, random)));
  EXPECT_FALSE(fit_normal(centre, normal, std::vector<Vec3>(30, centre)));
  // Two lines through the centre.
  std::vector<Vec3> cross_of_lines;
  for (int k = 1; k < 8; ++k)
    for (double const s : {-0.1 * k, 0.1 * k}) {
      cross_of_lines.push_back(place({s, 0, s * s}));
      cross_of_lines.push_back(place({0, s, s * s}));
    }
  EXPECT_FALSE(fit_normal(centre, normal, cross_of_lines));
}

}  // namespace
}  // namespace gridmorph::test
