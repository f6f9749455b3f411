// Statistics of cells gathered chunk by chunk; internal to the quality part.
#pragma once

#include <gridmorph/quality/detail/zone_cells.hpp>

#include <cstdint>
#include <functional>
#include <vector>

namespace gridmorph::detail {

/// One measure over some cells.
struct PartialMeasure {
  double sum = 0, min = kernels::unbounded, max = -kernels::unbounded;
  Index worst_cell = -1;  ///< number in the mesh, the first one of equals

  /// Adds values of consecutive cells, the first one of them `cell`. Sums are made in `partial_sums` parts, so that
  /// they do not depend on the number of lanes.
  template <int W>
  KOKKOS_INLINE_FUNCTION void add(double const* value, int count, Index cell, bool larger_is_worse) {
    double total = 0, least = kernels::unbounded, largest = -kernels::unbounded;
    int n = 0;
    if constexpr (W > 1) {
      constexpr int partial_sums = 8;
      static_assert(partial_sums % W == 0);
      if (count >= partial_sums) {
        using T = kernels::Lanes<W>;
        T sums[partial_sums / W] = {}, low = kernels::broadcast<T>(kernels::unbounded), high = -low;
        for (; n + partial_sums <= count; n += partial_sums)
          for (int p = 0; p < partial_sums / W; ++p) {
            T const v = kernels::load_lanes<T>(value + n + p * W);
            sums[p] += v;
            low = kernels::smaller(low, v);
            high = kernels::larger(high, v);
          }
        for (int p = 0; p < partial_sums; ++p) total += sums[p / W][p % W];
        for (int p = 0; p < W; ++p) {
          least = kernels::smaller(least, double(low[p]));
          largest = kernels::larger(largest, double(high[p]));
        }
      }
    }
    for (; n < count; ++n) {
      total += value[n];
      least = kernels::smaller(least, value[n]);
      largest = kernels::larger(largest, value[n]);
    }
    bool const worse = larger_is_worse ? largest > max : least < min;
    if (worse || worst_cell < 0) {
      double const worst = larger_is_worse ? largest : least;
      int at = 0;
      while (at + 1 < count && value[at] != worst) ++at;
      worst_cell = cell + at;
    }
    sum += total;
    min = kernels::smaller(min, least);
    max = kernels::larger(max, largest);
  }

  /// Adds another part of the same cells' chunk.
  KOKKOS_INLINE_FUNCTION void join(PartialMeasure const& other, bool larger_is_worse) {
    if (other.worst_cell < 0) return;
    double const own = larger_is_worse ? -max : min, others = larger_is_worse ? -other.max : other.min;
    if (worst_cell < 0 || others < own || (others == own && other.worst_cell < worst_cell))
      worst_cell = other.worst_cell;
    sum += other.sum;
    min = kernels::smaller(min, other.min);
    max = kernels::larger(max, other.max);
  }
};

/// Cells that fell in one way; `worst` is the smallest value.
struct PartialFall {
  double worst = kernels::unbounded;
  Index worst_cell = -1;
  int cells = 0;

  KOKKOS_INLINE_FUNCTION void take(double value, Index cell) { join({value, cell, 1}); }
  KOKKOS_INLINE_FUNCTION void join(PartialFall const& other) {
    if (other.cells == 0) return;
    if (cells == 0 || other.worst < worst || (other.worst == worst && other.worst_cell < worst_cell)) {
      worst = other.worst;
      worst_cell = other.worst_cell;
    }
    cells += other.cells;
  }
};

/// Ways to fall whose value is worse the larger it is: gathered with the other sign.
KOKKOS_INLINE_FUNCTION constexpr bool larger_is_worse(Fall f) { return f == Fall::skewness || f == Fall::loss; }

/// The cells of one region (0: near field, 1: far field) in one chunk.
struct PartialRegion {
  int cells = 0, inverted = 0, flat = 0, collapsed = 0;
  PartialMeasure measure[n_measures];
  PartialFall fallen[n_falls];

  template <int W>
  KOKKOS_INLINE_FUNCTION void add(Measure m, double const* value, int count, Index cell) {
    measure[int(m)].template add<W>(value, count, cell, larger_is_worse(m));
  }
  KOKKOS_INLINE_FUNCTION void join(PartialRegion const& other) {
    cells += other.cells;
    inverted += other.inverted;
    flat += other.flat;
    collapsed += other.collapsed;
    for (int m = 0; m < int(n_measures); ++m) measure[m].join(other.measure[m], larger_is_worse(Measure(m)));
    for (int f = 0; f < int(n_falls); ++f) fallen[f].join(other.fallen[f]);
  }
};

struct PartialSums {
  PartialRegion region[2];

  KOKKOS_INLINE_FUNCTION void join(PartialSums const& other) {
    for (int r = 0; r < 2; ++r) region[r].join(other.region[r]);
  }
};

static_assert(32 * sizeof(PartialSums) <= 48 * 1024, "those of a team of a GPU no longer fit into its scratch memory");

/// A ratio to neighbours in both regions: each has a pass of its own, when all volumes, edges or faces are known.
struct NeighbourRatios {
  PartialMeasure region[2];

  KOKKOS_INLINE_FUNCTION void join(NeighbourRatios const& other) {
    for (int r = 0; r < 2; ++r) region[r].join(other.region[r], larger_is_worse(Measure::volume_ratio));
  }
};

/// Calls f(region, begin, end) for the runs of cells begin <= n < end of a row that lie in one region. mask: nonzero in
/// the near field, from the first cell of the row on; null where there is none.
template <class Function>
KOKKOS_INLINE_FUNCTION void for_each_region_run(std::uint8_t const* mask, int count, Function const& f) {
  if (mask == nullptr) {
    f(1, 0, count);
    return;
  }
  for (int begin = 0; begin < count;) {
    bool const near_field = mask[begin] != 0;
    int end = begin + 1;
    while (end < count && (mask[end] != 0) == near_field) ++end;
    f(near_field ? 0 : 1, begin, end);
    begin = end;
  }
}

/// Adds the chunks in order and turns cell numbers into zones and indices. sums: as many as chunks.
void combine(Mesh const& mesh, std::vector<kernels::CellChunk> const& chunks, PartialSums const* sums,
             QualityRegion& near_field, QualityRegion& far_field);

/// Zone and index of a cell for people.
struct CellPlace {
  int zone;
  Index3 cell;
};
/// The place of the cell of blocks with this number (first_cells()). Cost: O(zones).
CellPlace place_of_cell(Mesh const& mesh, Index cell);
CellPlace place_of_element(Mesh const& mesh, Index element);

/// The same for any cells, whose places are asked for where they are the worst.
void combine(std::size_t n_chunks, PartialSums const* sums, QualityRegion& near_field, QualityRegion& far_field,
             std::function<CellPlace(Index cell)> const& place);

}  // namespace gridmorph::detail
