// The space-filling curves: each place of a cube once, one step from each to the next.
#include "support/random.hpp"

#include <gridmorph/kernels/box_tree.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

namespace gridmorph::test {
namespace {

using kernels::LatticePlace;

/// A step of the lattice to a unit of length.
LatticePlace place(double x, double y, double z) { return {{x, y, z}, {0, 0, 0}, {1, 1, 1}}; }

int steps_between(LatticePlace const& a, LatticePlace const& b) {
  auto const apart = [](std::uint32_t p, std::uint32_t q) { return std::abs(int(p) - int(q)); };
  return apart(a.x, b.x) + apart(a.y, b.y) + apart(a.z, b.z);
}

TEST(HilbertCurve, FillsEveryAlignedCubeStepByStep) {
  Random random(1);
  for (int bits = 1; bits <= 4; ++bits) {
    int const side = 1 << bits, last = (1 << LatticePlace::bits) / side - 1;
    for (int trial = 0; trial < 12; ++trial) {
      // At the origin, in the opposite corner, anywhere.
      int corner[3];
      for (int& c : corner) c = side * (trial == 0 ? 0 : trial == 1 ? last : random.below(last + 1));
      std::vector<LatticePlace> along(std::size_t(side) * side * side, place(-1, -1, -1));
      std::vector<int> met(along.size(), 0);
      std::uint64_t const cube = hilbert_code(place(corner[0], corner[1], corner[2])) >> (3 * bits);
      for (int k = 0; k < side; ++k)
        for (int j = 0; j < side; ++j)
          for (int i = 0; i < side; ++i) {
            LatticePlace const p = place(corner[0] + i, corner[1] + j, corner[2] + k);
            std::uint64_t const code = hilbert_code(p);
            ASSERT_EQ(code >> (3 * bits), cube);
            along[code % along.size()] = p;
            ++met[code % along.size()];
          }
      EXPECT_EQ(met, std::vector<int>(along.size(), 1));
      for (std::size_t n = 1; n < along.size(); ++n) ASSERT_EQ(steps_between(along[n - 1], along[n]), 1) << n;
    }
  }
}

TEST(HilbertCurve, BeginsAndEndsInCornersOfTheWholeCube) {
  double const last = double((1 << LatticePlace::bits) - 1);
  std::uint64_t const end = (std::uint64_t(1) << (3 * LatticePlace::bits)) - 1;
  EXPECT_EQ(hilbert_code(place(0, 0, 0)), 0u);
  int ends = 0;
  for (int corner = 0; corner < 8; ++corner)
    ends += hilbert_code(place(corner & 1 ? last : 0, corner & 2 ? last : 0, corner & 4 ? last : 0)) == end ? 1 : 0;
  EXPECT_EQ(ends, 1);
}

TEST(ZOrder, IsTheBitsOfThreeNumbersInTurn) {
  Random random(2);
  for (int trial = 0; trial < 100; ++trial) {
    LatticePlace const p = place(random.below(1 << 21), random.below(1 << 21), random.below(1 << 21));
    std::uint64_t expected = 0;
    for (int b = 0; b < LatticePlace::bits; ++b)
      expected |= std::uint64_t(p.x >> b & 1) << (3 * b) | std::uint64_t(p.y >> b & 1) << (3 * b + 1) |
                  std::uint64_t(p.z >> b & 1) << (3 * b + 2);
    EXPECT_EQ(z_code(p), expected);
  }
}

TEST(LatticePlace, WhatIsOutsideCountsAsTheLimit) {
  std::uint32_t const last = (1u << LatticePlace::bits) - 1;
  double const infinity = std::numeric_limits<double>::infinity();
  LatticePlace const p = place(-3, 1e12, infinity), q = place(-infinity, std::nan(""), 7.9);
  EXPECT_EQ(p.x, 0u);
  EXPECT_EQ(p.y, last);
  EXPECT_EQ(p.z, last);
  EXPECT_EQ(q.x, 0u);
  EXPECT_EQ(q.y, 0u);
  EXPECT_EQ(q.z, 7u);
  LatticePlace const scaled({1.5, 2.5, 3.5}, {1, 2, 3}, {4, 8, 16});
  EXPECT_EQ(scaled.x, 2u);
  EXPECT_EQ(scaled.y, 4u);
  EXPECT_EQ(scaled.z, 8u);
}

}  // namespace
}  // namespace gridmorph::test
