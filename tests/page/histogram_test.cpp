// Histograms: each cell once, in the bin that holds its value.
#include <gridmorph/app/page/histogram.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

namespace gridmorph::page {
namespace {

TEST(Histogram, CountsEveryCellOnceWhateverItsValue) {
  std::mt19937 random(3);
  std::normal_distribution<double> value(0.5, 2);
  for (Measure const m : {Measure::determinant_3x3x3, Measure::minimum_angle_deg, Measure::aspect_ratio}) {
    std::vector<double> before, after;
    std::vector<char> in;
    Index inside = 0;
    for (int n = 0; n < 5000; ++n) {
      before.push_back(std::exp(3 * value(random)) - 5);
      after.push_back(n % 50 == 0 ? HUGE_VAL : n % 51 == 0 ? std::nan("") : n % 52 == 0 ? -HUGE_VAL : value(random));
      in.push_back(n % 3 == 0);
      inside += n % 3 == 0;
    }
    Histogram const h = histogram(m, before, after, in);
    EXPECT_EQ(std::accumulate(h.before.begin(), h.before.end(), Index(0)), inside);
    EXPECT_EQ(std::accumulate(h.after.begin(), h.after.end(), Index(0)), inside);
    EXPECT_TRUE(std::is_sorted(h.edge.begin(), h.edge.end()));
  }
}

TEST(Histogram, PutsAValueBetweenTheEdgesOfItsBin) {
  for (double const v : {-0.05, 0.0, 0.031, 0.5, 0.99999, 1.0}) {
    Histogram const h = histogram(Measure::determinant_3x3x3, {v}, {}, {1});
    for (std::size_t b = 0; b < h.before.size(); ++b)
      if (h.before[b] == 1) {
        EXPECT_LE(h.edge[b], v + 1e-12);
        EXPECT_GE(h.edge[b + 1], v - 1e-12);
      }
  }
}

TEST(Histogram, PutsTheInvertedIntoTheFirstBinAndTheUnboundedIntoTheLast) {
  Histogram const d = histogram(Measure::determinant_3x3x3, {-3, std::nan("")}, {}, {1, 1});
  EXPECT_EQ(d.before.front(), 2);
  Histogram const a = histogram(Measure::aspect_ratio, {HUGE_VAL, std::nan(""), 50}, {}, {1, 1, 1});
  EXPECT_EQ(a.before.back(), 2);
}

}  // namespace
}  // namespace gridmorph::page
