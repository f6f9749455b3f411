// Coincident points and joined sets against plain loops over everything.
#include "support/random.hpp"

#include <gridmorph/core/disjoint_sets.hpp>
#include <gridmorph/geometry/cubic_piece.hpp>
#include <gridmorph/geometry/point_numbers.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace gridmorph::test {
namespace {

/// Points of a lattice, each several times, off by no more than the scatter.
std::vector<Vec3> repeated(Random& random, double scatter) {
  std::vector<Vec3> out;
  for (int n = 0; n < 800; ++n)
    out.push_back(Vec3{0.1 * random.below(4), 0.1 * random.below(4) - 0.2, 1e3 + 0.1 * random.below(4)} +
                  random.vector(scatter));
  return out;
}

TEST(PointNumbers, FindsTheNearestOfAllWithinTheTolerance) {
  Random random(1);
  for (double const tolerance : {0.0, 1e-3, 0.3}) {
    PointNumbers numbers(tolerance);
    auto const points = repeated(random, tolerance > 0 ? 1e-3 : 0);
    for (std::size_t n = 0; n < points.size(); n += 2) numbers.add(points[n], int(n));
    for (Vec3 const& p : points) {
      int nearest = -1;
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t n = 0; n < points.size(); n += 2)
        if (double const d = distance(p, points[n]); d <= tolerance && d < least) {
          least = d;
          nearest = int(n);
        }
      EXPECT_EQ(numbers.find(p), nearest);
    }
  }
}

TEST(PointNumbers, CoincidentPointsGetOneNumber) {
  Random random(2);
  PointNumbers numbers(1e-6);
  auto const points = repeated(random, 1e-8);
  std::vector<int> number;
  for (std::size_t n = 0; n < points.size(); ++n) number.push_back(numbers.find_or_add(points[n], int(n)));
  for (std::size_t a = 0; a < points.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) EXPECT_EQ(number[a] == number[b], distance(points[a], points[b]) < 1e-6);
}

TEST(PointNumbers, WithoutAToleranceZerosOfBothSignsAreOne) {
  PointNumbers numbers(0);
  numbers.add({0.0, -0.0, 1}, 7);
  EXPECT_EQ(numbers.find({-0.0, 0.0, 1}), 7);
  EXPECT_EQ(numbers.find({1e-300, 0, 1}), -1);
}

TEST(DisjointSets, HangTogetherAsFarAsAFloodReaches) {
  Random random(3);
  constexpr int size = 120;
  std::vector<std::pair<int, int>> pairs;
  for (int n = 0; n < 90; ++n) pairs.emplace_back(random.below(size), random.below(size));
  DisjointSets<int> sets(size);
  for (auto const& [a, b] : pairs) sets.join(a, b);
  std::vector<int> smallest(size);
  for (int n = 0; n < size; ++n) smallest[n] = n;
  for (int round = 0; round < size; ++round)
    for (auto const& [a, b] : pairs) smallest[a] = smallest[b] = std::min(smallest[a], smallest[b]);
  EXPECT_EQ(sets.roots(), smallest);
  int count = 0;
  auto const number = sets.set_numbers();
  for (int n = 0; n < size; ++n) {
    int const expected = smallest[n] == n ? count++ : number[smallest[n]];
    EXPECT_EQ(number[n], expected);
  }
}

TEST(CubicPiece, IsTheCubicWithThoseValuesAndSlopes) {
  auto const f = [](double x) { return 3 - x + 0.5 * x * x - 2 * x * x * x; };
  auto const slope = [](double x) { return -1 + x - 6 * x * x; };
  double const from = 0.3, to = 1.7;
  for (double const t : {0.0, 0.1, 0.5, 0.9, 1.0})
    EXPECT_NEAR(cubic_piece(f(from), f(to), slope(from), slope(to), to - from, t), f(from + t * (to - from)), 1e-13);
}

TEST(PieceAt, IsTheOneThatHoldsThePlace) {
  std::vector<double> const x{-1, 0, 0.5, 2};
  auto const at = [&](double v) {
    return piece_at(
        int(x.size()), [&](int k) { return x[k]; }, v);
  };
  EXPECT_EQ(at(-5), 0);
  EXPECT_EQ(at(-0.5), 0);
  EXPECT_EQ(at(0), 1);
  EXPECT_EQ(at(0.5), 2);
  EXPECT_EQ(at(9), 2);
}

}  // namespace
}  // namespace gridmorph::test
