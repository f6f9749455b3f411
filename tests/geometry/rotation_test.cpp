// Rotations found in matrices, against the matrix of Rodrigues.
#include "support/random.hpp"

#include <gridmorph/geometry/rotation.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace gridmorph::test {
namespace {

constexpr double pi = std::numbers::pi;

Vec3 direction(Random& random) {
  Vec3 v = random.vector(1);
  while (norm(v) < 0.1) v = random.vector(1);
  return (1 / norm(v)) * v;
}

/// Angle times axis to the matrix, by its definition.
Mat3 matrix_of(Vec3 const& turn) {
  double const angle = norm(turn);
  return angle > 0 ? rotation_matrix((1 / angle) * turn, angle) : Mat3();
}

double difference(Mat3 const& a, Mat3 const& b) {
  double largest = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) largest = std::max(largest, std::abs(a.m[i][j] - b.m[i][j]));
  return largest;
}

TEST(NearestRotation, OfARotatedStretchIsTheRotation) {
  Random random(2);
  for (int trial = 0; trial < 50; ++trial) {
    Mat3 const r = matrix_of(random.between(0, pi) * direction(random)), q = matrix_of(2 * direction(random));
    Mat3 stretch;
    for (int k = 0; k < 3; ++k) stretch.m[k][k] = random.between(0.1, 5);
    EXPECT_LT(difference(nearest_rotation(r * (q * (stretch * transpose(q)))), r), 1e-13);
  }
}

TEST(RotationVector, IsAngleTimesAxisAtAllAngles) {
  Random random(3);
  for (double const angle : {1e-12, 1e-6, 0.3, 1.5, 2.8, 3.0, pi - 1e-6, pi - 1e-9})
    for (int trial = 0; trial < 20; ++trial) {
      Vec3 const v = angle * direction(random);
      EXPECT_LT(distance(rotation_vector(matrix_of(v)), v), 1e-13) << angle;
      EXPECT_LT(difference(rotation_by(v), matrix_of(v)), 1e-15);
    }
  for (Vec3 const& axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}, Vec3{0.6, 0, -0.8}}) {
    Vec3 const half_turn = rotation_vector(matrix_of(pi * axis));  // either sense
    EXPECT_NEAR(std::abs(dot(half_turn, axis)), pi, 1e-14);
  }
  EXPECT_EQ(rotation_vector(Mat3()), Vec3{});
  EXPECT_EQ(difference(rotation_by({}), Mat3()), 0);
}

TEST(RigidFit, APointOfWeightThreeCountsAsThreeAndStillPointsStayExactly) {
  Random random(7);
  std::vector<Vec3> before, after, before_each, after_each;
  std::vector<double> weights;
  for (int n = 0; n < 12; ++n) {
    Vec3 const x = random.vector(1), y = matrix_of({0.3, -0.2, 0.9}) * x + random.vector(0.1);
    before.push_back(x);
    after.push_back(y);
    weights.push_back(n % 4);
    for (int k = 0; k < n % 4; ++k) {
      before_each.push_back(x);
      after_each.push_back(y);
    }
  }
  auto const fit = rigid_fit(before, after, weights), each = rigid_fit(before_each, after_each);
  ASSERT_TRUE(fit && each);
  EXPECT_LT(difference(fit->rotation, each->rotation), 1e-14);
  EXPECT_LT(distance(displacement(*fit, {1, 2, 3}), displacement(*each, {1, 2, 3})), 1e-14);
  EXPECT_EQ(displacement(*rigid_fit(before, before, weights), {1, 2, 3}), Vec3{});
}

}  // namespace
}  // namespace gridmorph::test
