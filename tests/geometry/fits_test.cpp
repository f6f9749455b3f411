// Least-squares fits against what defines them: residuals that nothing nearby makes smaller, and closed formulas.
#include "support/random.hpp"

#include <gridmorph/geometry/affine_fit.hpp>
#include <gridmorph/geometry/plane_fit.hpp>
#include <gridmorph/geometry/rotation.hpp>
#include <gridmorph/geometry/symmetric_eigen.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gridmorph::test {
namespace {

template <std::size_t N>
SmallMatrix<N> random_symmetric(Random& random) {
  SmallMatrix<N> a{};
  for (std::size_t r = 0; r < N; ++r)
    for (std::size_t c = 0; c <= r; ++c) a[r][c] = a[c][r] = random.between(-2, 2);
  return a;
}

template <std::size_t N>
void expect_eigen(SmallMatrix<N> const& a, SymmetricEigen<N> const& eigen, double size) {
  for (std::size_t k = 0; k < N; ++k) {
    EXPECT_TRUE(k == 0 || eigen.value[k - 1] >= eigen.value[k]);
    for (std::size_t r = 0; r < N; ++r) {
      double product = 0, length = 0;
      for (std::size_t c = 0; c < N; ++c) product += a[r][c] * eigen.vector[k][c];
      EXPECT_NEAR(product, eigen.value[k] * eigen.vector[k][r], 1e-14 * size);
      for (std::size_t c = 0; c < N; ++c) length += eigen.vector[k][c] * eigen.vector[r][c];
      EXPECT_NEAR(length, k == r ? 1 : 0, 1e-14);
    }
  }
}

TEST(SymmetricEigen, VectorsAreThoseThatTheMatrixStretches) {
  Random random(1);
  for (int n = 0; n < 200; ++n) {
    auto const three = random_symmetric<3>(random);
    expect_eigen<3>(three, symmetric_eigen<3>(three), 10);
    auto const four = random_symmetric<4>(random);
    expect_eigen<4>(four, symmetric_eigen<4>(four), 10);
  }
  SmallMatrix<4> const alike{{{3, 0, 0, 0}, {0, 3, 0, 0}, {0, 0, 2, 1}, {0, 0, 1, 2}}};  // 3, 3, 3, 1
  expect_eigen<4>(alike, symmetric_eigen<4>(alike), 10);
  expect_eigen<3>({}, symmetric_eigen<3>({}), 1);
}

TEST(SymmetricEigen, ValuesAreTheRootsOfTheCharacteristicPolynomial) {
  // O. K. Smith, Eigenvalues of a symmetric 3x3 matrix, CACM 4 (1961).
  Random random(2);
  for (int n = 0; n < 200; ++n) {
    auto const a = random_symmetric<3>(random);
    double const m = (a[0][0] + a[1][1] + a[2][2]) / 3;
    auto const at = [&](int r, int c) { return a[r][c] - (r == c ? m : 0); };
    double const q = 0.5 * (at(0, 0) * (at(1, 1) * at(2, 2) - at(1, 2) * at(2, 1)) -
                            at(0, 1) * (at(1, 0) * at(2, 2) - at(1, 2) * at(2, 0)) +
                            at(0, 2) * (at(1, 0) * at(2, 1) - at(1, 1) * at(2, 0)));
    double p = 0;
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) p += at(r, c) * at(r, c) / 6;
    double const angle = std::acos(std::clamp(q / std::pow(p, 1.5), -1.0, 1.0)) / 3;
    auto const eigen = symmetric_eigen<3>(a);
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(eigen.value[k],
                  m + 2 * std::sqrt(p) *
                          std::cos(angle + (k == 0   ? 0
                                            : k == 1 ? 4
                                                     : 2) *
                                               std::numbers::pi / 3),
                  1e-7);
  }
}

std::vector<Vec3> cloud(Random& random, int n, Vec3 const& stretch) {
  std::vector<Vec3> out;
  for (int k = 0; k < n; ++k) {
    Vec3 const p = random.vector(1);
    out.push_back(Vec3{3, -1, 2} + Vec3{stretch.x * p.x, stretch.y * p.y, stretch.z * p.z});
  }
  return out;
}

double sum_of_squares(std::vector<Vec3> const& from, std::vector<Vec3> const& to, RigidTransform const& t) {
  double sum = 0;
  for (std::size_t n = 0; n < from.size(); ++n) sum += dot(t(from[n]) - to[n], t(from[n]) - to[n]);
  return sum;
}

TEST(RigidTransformFit, NothingNearbyIsBetter) {
  Random random(3);
  for (Vec3 const& stretch : {Vec3{1, 1, 1}, Vec3{1, 0.1, 0.01}, Vec3{1, 2, 0}}) {
    auto const from = cloud(random, 40, stretch);
    RigidTransform const given = rotation_about(random.vector(2), random.vector(1), random.between(-3.1, 3.1));
    std::vector<Vec3> to;
    for (Vec3 const& p : from) to.push_back(given(p) + random.vector(0.005));
    RigidTransform const fit = fit_rigid_transform(from, to);
    double const best = sum_of_squares(from, to, fit);
    for (int n = 0; n < 100; ++n) {
      RigidTransform other = fit.then(rotation_about(fit(from.front()), random.vector(1), random.between(-0.01, 0.01)));
      EXPECT_GT(sum_of_squares(from, to, other), best);
      other = fit;
      other.translation += random.vector(0.01);
      EXPECT_GT(sum_of_squares(from, to, other), best);
    }
  }
}

TEST(NearestRotation, OfASymmetricStretchIsExactlyNone) {
  EXPECT_EQ(rotation_vector(nearest_rotation({{{2, 0.3, 0}, {0.3, 1, -0.2}, {0, -0.2, 4}}})), Vec3());
}

TEST(PlaneFit, NothingNearbyIsBetter) {
  Random random(5);
  auto const points = cloud(random, 60, {1, 0.5, 0.02});
  PlaneFit const fit = fit_plane(points);
  EXPECT_TRUE(fit.determined);
  auto const off = [&](Vec3 const& origin, Vec3 const& normal) {
    double sum = 0;
    for (Vec3 const& p : points) sum += dot(p - origin, normal) * dot(p - origin, normal);
    return sum;
  };
  for (int n = 0; n < 100; ++n) {
    Vec3 const turned = rotation_by(random.vector(0.05)) * fit.normal;
    EXPECT_GE(off(fit.origin, turned), off(fit.origin, fit.normal));
    EXPECT_GE(off(fit.origin + random.vector(0.01), fit.normal), off(fit.origin, fit.normal));
  }
}

TEST(PlaneFit, ACoordinatePlaneIsExactAndALineHasNone) {
  Random random(6);
  auto points = cloud(random, 50, {2, 0, 1});
  EXPECT_EQ(std::abs(fit_plane(points).normal.y), 1);
  EXPECT_EQ(fit_plane(points).deviation, 0);
  for (Vec3& p : points) p = p.x * Vec3{1, 2, 3};
  EXPECT_FALSE(fit_plane(points).determined);
}

TEST(AffineFit, WhatATurnedPlateIsAcrossStaysAcross) {
  Random random(8);
  auto const points = cloud(random, 30, {1, 2, 0});
  Mat3 const turn = rotation_by({0.3, -0.2, 0.5});
  std::vector<Vec3> displacement;
  for (Vec3 const& p : points) displacement.push_back(turn * p - p);
  auto const fit = fit_affine(points, displacement, points);
  for (Vec3 const& p : cloud(random, 10, {1, 1, 1})) EXPECT_LT(distance(fit(p), turn * p - p), 1e-13);
}

}  // namespace
}  // namespace gridmorph::test
