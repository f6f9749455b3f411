// Histograms: each cell once, in the bin that holds its value.
#include <gridmorph/page/report_page.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
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
    std::array<Index, 2> cells{};
    for (int n = 0; n < 5000; ++n) {
      before.push_back(std::exp(3 * value(random)) - 5);
      after.push_back(n % 50 == 0 ? HUGE_VAL : n % 51 == 0 ? std::nan("") : n % 52 == 0 ? -HUGE_VAL : value(random));
      in.push_back(n % 3 == 0);
      ++cells[n % 3 == 0 ? 1 : 0];
    }
    auto const both = histograms(m, before, after, in);
    for (std::size_t s = 0; s < 2; ++s) {
      Histogram const& h = both[s];
      EXPECT_EQ(std::accumulate(h.before.begin(), h.before.end(), Index(0)), cells[s]);
      EXPECT_EQ(std::accumulate(h.after.begin(), h.after.end(), Index(0)), cells[s]);
      EXPECT_TRUE(std::is_sorted(h.edge.begin(), h.edge.end()));
      EXPECT_EQ(h.edge, both[0].edge);
    }
  }
}

/// The bin by going through all edges: what lies below the first is in the first bin, what is not below the last in the
/// last.
std::size_t bin_by_edges(std::vector<double> const& edge, double value) {
  std::size_t bin = 0;
  while (bin + 2 < edge.size() && value >= edge[bin + 1]) ++bin;
  return bin;
}

TEST(Histogram, PutsAValueBetweenTheEdgesOfItsBin) {
  std::mt19937 random(5);
  for (Measure const m : {Measure::determinant_3x3x3, Measure::minimum_angle_deg, Measure::aspect_ratio})
    for (double const largest : {3.0, 900.0, 2e6}) {
      std::uniform_real_distribution<double> share(-0.1, 1.1);
      std::vector<double> values{largest};
      for (double const e : histogram_edges(m, largest))
        for (double const v : {e, std::nextafter(e, -HUGE_VAL), std::nextafter(e, HUGE_VAL)})
          values.push_back(std::min(v, largest));
      double const end = m == Measure::aspect_ratio ? std::log(largest) : m == Measure::minimum_angle_deg ? 90 : 1;
      for (int n = 0; n < 2000; ++n)
        values.push_back(
            std::min(largest, m == Measure::aspect_ratio ? std::exp(end * share(random)) : end * share(random)));
      Histogram const h = histograms(m, values, {}, std::vector<char>(values.size(), 1))[1];
      std::vector<Index> expected(h.before.size(), 0);
      for (double const v : values) ++expected[bin_by_edges(h.edge, v)];
      EXPECT_EQ(h.before, expected) << int(m) << " up to " << largest;
    }
}

TEST(Histogram, PutsTheInvertedIntoTheFirstBinAndTheUnboundedIntoTheLast) {
  Histogram const d = histograms(Measure::determinant_3x3x3, {-3, std::nan("")}, {}, {1, 1})[1];
  EXPECT_EQ(d.before.front(), 2);
  Histogram const a = histograms(Measure::aspect_ratio, {HUGE_VAL, std::nan(""), 50}, {}, {1, 1, 1})[1];
  EXPECT_EQ(a.before.back(), 2);
}

}  // namespace
}  // namespace gridmorph::page
