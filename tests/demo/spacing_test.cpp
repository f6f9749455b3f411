#include <generators/spacing.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace {

using gridmorph::demo::first_of_geometric;
using gridmorph::demo::geometric_spacing;
using gridmorph::demo::tanh_spacing;

void expect_ascending_from_zero_to_one(std::vector<double> const& s) {
  EXPECT_EQ(s.front(), 0.0);
  EXPECT_EQ(s.back(), 1.0);
  for (std::size_t n = 1; n < s.size(); ++n) EXPECT_GT(s[n], s[n - 1]) << "node " << n;
}

TEST(Spacing, GeometricSpacingKeepsItsFirstCellAndGrowsEvenly) {
  for (int const n : {2, 7, 40, 300})
    for (double const first : {1e-5, 1e-3, 0.3 / n, 0.999 / n}) {
      auto const s = geometric_spacing(n, first);
      ASSERT_EQ(int(s.size()), n + 1);
      expect_ascending_from_zero_to_one(s);
      EXPECT_NEAR(s[1], first, 1e-9 * first);
      double const growth = (s[2] - s[1]) / s[1];
      for (int i = 2; i < n; ++i) EXPECT_NEAR((s[i + 1] - s[i]) / (s[i] - s[i - 1]), growth, 1e-6 * growth);
    }
}

TEST(Spacing, TanhSpacingIsSymmetricAndKeepsItsEndCells) {
  for (int const n : {5, 24, 301})
    for (double const first : {1e-6, 1e-3, 0.5 / n}) {
      auto const s = tanh_spacing(n, first);
      expect_ascending_from_zero_to_one(s);
      EXPECT_NEAR(s[1], first, 1e-6 * first);
      for (int i = 0; i <= n; ++i) EXPECT_NEAR(s[i] + s[n - i], 1, 1e-14);
    }
}

TEST(Spacing, IsUniformWhereTheFirstCellIsNotSmallerThanTheOthers) {
  for (auto const& s : {geometric_spacing(8, 0.5), tanh_spacing(8, 0.125)})
    for (int i = 0; i <= 8; ++i) EXPECT_EQ(s[i], i / 8.0);
}

TEST(Spacing, FirstCellOfAGeometricRowMatchesTheSumOfItsCells) {
  for (double const growth : {1.0, 1.0 + 1e-12, 1.2, 3.0}) {
    double sum = 0;
    for (int n = 0; n < 12; ++n) sum += std::pow(growth, n);
    EXPECT_NEAR(first_of_geometric(12, growth), 1 / sum, 1e-12 / sum);
  }
}

}  // namespace
