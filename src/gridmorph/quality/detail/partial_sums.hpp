// Statistics of cells gathered chunk by chunk; internal to the quality part.
#pragma once

#include <gridmorph/quality/detail/zone_cells.hpp>

#include <vector>

namespace gridmorph::detail {

/// One measure over some cells.
struct PartialMeasure {
  double sum = 0, min = unbounded, max = -unbounded;
  Index worst_cell = -1;  ///< number in the mesh

  KOKKOS_INLINE_FUNCTION void add(double value, Index cell, bool larger_is_worse) {
    sum += value;
    bool const worst = larger_is_worse ? value > max : value < min;
    if (worst || worst_cell < 0) worst_cell = cell;
    min = smaller(min, value);
    max = larger(max, value);
  }
};

/// The cells of one region (0: near field, 1: far field) in one chunk.
struct PartialRegion {
  int cells = 0, inverted = 0, newly_inverted = 0, collapsed = 0;
  PartialMeasure measure[n_measures];

  KOKKOS_INLINE_FUNCTION void add(Measure m, double value, Index cell) {
    measure[int(m)].add(value, cell, larger_is_worse(m));
  }
};

struct PartialSums {
  PartialRegion region[2];
};

/// Adds the chunks in order and turns cell numbers into zones and indices. sums: as many as chunks.
void combine(Mesh const& mesh, std::vector<CellChunk> const& chunks, PartialSums const* sums, QualityRegion& near_field,
             QualityRegion& far_field);

}  // namespace gridmorph::detail
