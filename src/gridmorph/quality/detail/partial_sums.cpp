#include <gridmorph/quality/detail/partial_sums.hpp>

#include <algorithm>

namespace gridmorph::detail {

namespace {

Index3 cell_index(Zone const& zone, Index local) {
  Index const ni = zone.extent[0] - 1, nj = zone.extent[1] - 1;
  return {int(local % ni), int(local / ni % nj), int(local / (ni * nj))};
}

void add(MeasureStatistics& total, PartialMeasure const& part, bool larger_is_worse, Index& worst_cell) {
  if (part.worst_cell < 0) return;
  double const worst = larger_is_worse ? part.max : part.min;
  if (worst_cell < 0 || (larger_is_worse ? worst > total.worst : worst < total.worst)) {
    total.worst = worst;
    worst_cell = part.worst_cell;
  }
  total.min = std::min(total.min, part.min);
  total.max = std::max(total.max, part.max);
  total.mean += part.sum;  // divided by the number of cells at the end
}

}  // namespace

void combine(Mesh const& mesh, std::vector<CellChunk> const& chunks, PartialSums const* sums, QualityRegion& near_field,
             QualityRegion& far_field) {
  std::vector<Index> const first = first_cells(mesh);
  combine(chunks.size(), sums, near_field, far_field, [&](Index cell, MeasureStatistics& s) {
    s.worst_zone = int(std::upper_bound(first.begin(), first.end(), cell) - first.begin()) - 1;
    s.worst_cell = cell_index(mesh.zones[s.worst_zone], cell - first[s.worst_zone]);
  });
}

void combine(std::size_t n_chunks, PartialSums const* sums, QualityRegion& near_field, QualityRegion& far_field,
             std::function<void(Index cell, MeasureStatistics& statistics)> const& place) {
  QualityRegion* const regions[2] = {&near_field, &far_field};
  for (int r = 0; r < 2; ++r) {
    QualityRegion& region = *regions[r];
    region = {};
    for (std::size_t c = 0; c < n_chunks; ++c) {
      PartialRegion const& part = sums[c].region[r];
      region.cells += part.cells;
      region.inverted += part.inverted;
      region.newly_inverted += part.newly_inverted;
      region.collapsed += part.collapsed;
    }
    for (std::size_t m = 0; m < n_measures; ++m) {
      MeasureStatistics s;
      s.min = unbounded;
      s.max = -unbounded;
      Index worst = -1;
      for (std::size_t c = 0; c < n_chunks; ++c)
        add(s, sums[c].region[r].measure[m], larger_is_worse(Measure(m)), worst);
      if (worst < 0) continue;  // no cells, or not measured: all zero
      s.mean /= double(region.cells);
      place(worst, s);
      region.measure[m] = s;
    }
  }
}

}  // namespace gridmorph::detail
