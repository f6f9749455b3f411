#include <gridmorph/mesh/unstructured_mesh.hpp>
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

void combine(Mesh const& mesh, std::vector<kernels::CellChunk> const& chunks, PartialSums const* sums,
             QualityRegion& near_field, QualityRegion& far_field) {
  combine(chunks.size(), sums, near_field, far_field, [&](Index cell) { return place_of_cell(mesh, cell); });
}

CellPlace place_of_cell(Mesh const& mesh, Index cell) {
  std::vector<Index> const first = first_cells(mesh);
  int const zone = int(std::upper_bound(first.begin(), first.end(), cell) - first.begin()) - 1;
  return {zone, cell_index(mesh.zones[zone], cell - first[zone])};
}

CellPlace place_of_element(Mesh const& mesh, Index element) {
  return {mesh.zone_of_element(element), {int(number_in_file(mesh, element) - 1), 0, 0}};
}

void combine(std::size_t n_chunks, PartialSums const* sums, QualityRegion& near_field, QualityRegion& far_field,
             std::function<CellPlace(Index cell)> const& place) {
  QualityRegion* const regions[2] = {&near_field, &far_field};
  for (int r = 0; r < 2; ++r) {
    QualityRegion& region = *regions[r];
    region = {};
    for (std::size_t c = 0; c < n_chunks; ++c) {
      PartialRegion const& part = sums[c].region[r];
      region.cells += part.cells;
      region.inverted += part.inverted;
      region.flat += part.flat;
      region.collapsed += part.collapsed;
    }
    for (std::size_t m = 0; m < n_measures; ++m) {
      MeasureStatistics s;
      s.min = kernels::unbounded;
      s.max = -kernels::unbounded;
      Index worst = -1;
      for (std::size_t c = 0; c < n_chunks; ++c)
        add(s, sums[c].region[r].measure[m], larger_is_worse(Measure(m)), worst);
      if (worst < 0) continue;  // no cells, or not measured: all zero
      s.mean /= double(region.cells);
      CellPlace const at = place(worst);
      s.worst_zone = at.zone;
      s.worst_cell = at.cell;
      region.measure[m] = s;
    }
    for (std::size_t f = 0; f < n_falls; ++f) {
      PartialFall sum;
      for (std::size_t c = 0; c < n_chunks; ++c) sum.join(sums[c].region[r].fallen[f]);
      if (sum.cells == 0) continue;
      CellPlace const at = place(sum.worst_cell);
      region.fallen[f] = {sum.cells, at.zone, at.cell, sum.worst_cell,
                          larger_is_worse(Fall(f)) ? -sum.worst : sum.worst};
    }
    region.newly_inverted = region[Fall::inverted].cells;
    region.inverted -= region[Fall::flat_before].cells;
    region.flat += region[Fall::flat_before].cells;
  }
}

}  // namespace gridmorph::detail
