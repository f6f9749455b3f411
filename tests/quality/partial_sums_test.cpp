// Statistics gathered row by row and part by part against plain loops over all values.
#include <gridmorph/quality/detail/partial_sums.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace gridmorph::detail {
namespace {

using kernels::native_lanes;
using kernels::unbounded;

/// Values with repetitions, so that equal extremes occur.
std::vector<double> coarse_values(int count) {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> value(-6, 6);
  std::vector<double> v(count);
  for (double& x : v) x = 0.25 * value(random);
  return v;
}

void expect_statistics_of(std::vector<double> const& v, PartialMeasure const& m, Index first, bool larger_is_worse) {
  double sum = 0;
  for (double const x : v) sum += x;
  EXPECT_DOUBLE_EQ(m.sum, sum);  // multiples of 1/4: exact in any order
  auto const lo = std::min_element(v.begin(), v.end()), hi = std::max_element(v.begin(), v.end());
  EXPECT_EQ(m.min, *lo);
  EXPECT_EQ(m.max, *hi);
  EXPECT_EQ(m.worst_cell, first + ((larger_is_worse ? hi : lo) - v.begin()));  // the first one of equals
}

TEST(PartialMeasure, RowsOfEveryLengthGiveTheStatisticsOfAPlainLoop) {
  for (int count = 1; count <= 67; ++count)
    for (bool const larger_is_worse : {false, true}) {
      std::vector<double> const v = coarse_values(count);
      PartialMeasure lanes, one;
      lanes.add<native_lanes>(v.data(), count, 1000, larger_is_worse);
      one.add<1>(v.data(), count, 1000, larger_is_worse);
      expect_statistics_of(v, lanes, 1000, larger_is_worse);
      expect_statistics_of(v, one, 1000, larger_is_worse);
    }
}

TEST(PartialMeasure, RowsAndPartsJoinedInAnyOrderKeepTheFirstWorstCell) {
  std::vector<double> const v = coarse_values(60);
  for (bool const larger_is_worse : {false, true}) {
    PartialMeasure whole, parts[3];
    for (int row = 0; row < 6; ++row) {
      whole.add<native_lanes>(v.data() + 10 * row, 10, 10 * row, larger_is_worse);
      parts[row % 3].add<native_lanes>(v.data() + 10 * row, 10, 10 * row, larger_is_worse);
    }
    expect_statistics_of(v, whole, 0, larger_is_worse);
    PartialMeasure joined;  // begins without any cell
    for (int const p : {2, 0, 1}) joined.join(parts[p], larger_is_worse);
    joined.join(PartialMeasure(), larger_is_worse);
    expect_statistics_of(v, joined, 0, larger_is_worse);
  }
}

TEST(PartialMeasure, SumsDoNotDependOnTheNumberOfLanes) {
  std::vector<double> v(61);
  for (std::size_t n = 0; n < v.size(); ++n) v[n] = std::exp(std::sin(double(n)) * 20);
  PartialMeasure two, native;
  two.add<(native_lanes < 2 ? native_lanes : 2)>(v.data(), int(v.size()), 0, true);
  native.add<native_lanes>(v.data(), int(v.size()), 0, true);
  EXPECT_EQ(two.sum, native.sum);
}

TEST(PartialMeasure, UnboundedValuesHaveAPlaceToo) {
  double const v[3] = {unbounded, unbounded, unbounded};
  PartialMeasure m;
  m.add<native_lanes>(v, 3, 7, true);
  EXPECT_EQ(m.worst_cell, 7);
  EXPECT_EQ(m.max, unbounded);
}

struct CellRun {
  int region, begin, end;
  bool operator==(CellRun const&) const = default;
};

/// A lambda would be a function for the host alone, which nvcc refuses in functions for both.
struct NoteRuns {
  CellRun* run;
  int* count;
  KOKKOS_INLINE_FUNCTION void operator()(int region, int begin, int end) const {
    run[(*count)++] = {region, begin, end};
  }
};

std::vector<CellRun> runs_of(std::uint8_t const* mask, int cells) {
  std::vector<CellRun> runs(static_cast<std::size_t>(cells));
  int count = 0;
  for_each_region_run(mask, cells, NoteRuns{runs.data(), &count});
  runs.resize(static_cast<std::size_t>(count));
  return runs;
}

TEST(RegionRuns, CoverARowInOrderAndChangeWithTheMask) {
  std::vector<std::uint8_t> const mask{0, 0, 1, 2, 0, 1, 0};
  EXPECT_EQ(runs_of(mask.data(), 7), (std::vector<CellRun>{{1, 0, 2}, {0, 2, 4}, {1, 4, 5}, {0, 5, 6}, {1, 6, 7}}));
  EXPECT_EQ(runs_of(nullptr, 5), (std::vector<CellRun>{{1, 0, 5}}));
}

}  // namespace
}  // namespace gridmorph::detail
