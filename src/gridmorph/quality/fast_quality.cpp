#include <gridmorph/core/instantiate.hpp>
#include <gridmorph/kernels/cell_chunks.hpp>
#include <gridmorph/quality/detail/fast_quality.hpp>
#include <gridmorph/quality/detail/judge_cells.hpp>
#include <gridmorph/quality/detail/zone_cells.hpp>

#include <algorithm>
#include <limits>

namespace gridmorph::detail {

namespace {

/// Cells begin <= n < end of a row that lie in one region: their smallest determinant and angle, and those that fell.
template <int N>
struct RunOfCells {
  kernels::CellRow now, before;
  kernels::RowVerdicts<N> const& verdict;
  int begin, end;
  Index first;  ///< number in the mesh of the row's cell 0
  bool against_baseline;

  KOKKOS_INLINE_FUNCTION void add_to(PartialRegion& region, CellLimits const& limits, CellScreen const& screen) const {
    constexpr double degrees = 57.295779513082320877;
    double determinant = kernels::unbounded, angle = kernels::unbounded, cosine = -2;
    int determinant_at = begin, angle_at = begin, cosine_at = begin;
    for (int n = begin; n < end; ++n) {
      double value = verdict.determinant_3x3x3[n];
      bool may_fall = true;
      if (verdict.mark[n] != 0) {
        kernels::CellMeasures const m = cell_measures(now.cell(n), now.handedness);
        value = m.determinant_3x3x3;
        region.collapsed += m.collapsed ? 1 : 0;
        count_state(region, m.smallest_corner_jacobian);
        if (m.minimum_angle_deg < angle) {
          angle = m.minimum_angle_deg;
          angle_at = n;
        }
        may_fall = screen.may_fall(m.determinant_3x3x3, m.minimum_angle_deg, m.equiangle_skewness, m.collapsed);
      } else {
        if (verdict.largest_cosine[n] > cosine) {
          cosine = verdict.largest_cosine[n];
          cosine_at = n;
        }
        may_fall = screen.may_fall_by_cosines(value, verdict.largest_cosine[n], verdict.smallest_cosine[n]);
      }
      if (value < determinant) {
        determinant = value;
        determinant_at = n;
      }
      if (may_fall && against_baseline)
        judge(region, limits, cell_measures(before.cell(n), before.handedness),
              cell_measures(now.cell(n), now.handedness), first + n,
              [&] { return kernels::flat_cell(before.cell(n), now.cell(n), now.handedness); });
    }
    region.cells += end - begin;
    double const sharpest = degrees * kernels::arc_cosine(cosine);
    if (cosine > -2 && (sharpest < angle || (sharpest == angle && cosine_at < angle_at))) {
      angle = sharpest;
      angle_at = cosine_at;
    }
    region.add<1>(Measure::determinant_3x3x3, &determinant, 1, first + determinant_at);
    region.add<1>(Measure::minimum_angle_deg, &angle, 1, first + angle_at);
  }
};

}  // namespace

void keep_verdict(QualityReport& report) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  for (auto* region : {&report.near_field, &report.far_field})
    for (Measure const m : {Measure::determinant_3x3x3, Measure::minimum_angle_deg})
      region->measure[std::size_t(m)].mean = region->measure[std::size_t(m)].max = unknown;
  report.fast = true;
}

template <class Exec>
QualityReport fast_quality(Exec const& exec, Mesh const& mesh, QualityInput<typename Exec::memory_space> const& input) {
  using Policy = kernels::CellPolicy<Exec>;
  bool const against_baseline = input.baseline.x.extent(0) > 0;
  std::vector<kernels::CellChunk> const table = chunks_of(mesh);
  auto const zones = upload(exec, "gridmorph::quality::zones", zone_cells(mesh, input.handedness));
  auto const chunks = upload(exec, "gridmorph::quality::chunks", table);
  Kokkos::View<PartialSums*, typename Exec::memory_space> const sums(
      Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, "gridmorph::quality::sums"), table.size());
  auto const coordinates = input.coordinates;
  auto const baseline = against_baseline ? input.baseline : input.coordinates;
  auto const near_field = input.near_field;
  bool const has_near_field = near_field.extent(0) > 0;
  CellLimits const limits = input.limits;
  CellScreen const screen(limits);
  kernels::visit_chunks<kernels::by_lanes>(
      exec, "gridmorph::measure_quality::verdict", chunks, sums,
      KOKKOS_LAMBDA(kernels::RowOfCells const& row, PartialSums& s) {
        kernels::ZoneCells const zone = zones(row.zone);
        Index const first = kernels::first_cell(zone, row);
        kernels::CellRow const now = cell_row(coordinates, zone, row), before = cell_row(baseline, zone, row);
        kernels::RowVerdicts<Policy::row_length> verdict;
        kernels::row_verdicts<Policy::lanes>(now, verdict);
        for_each_region_run(
            has_near_field ? near_field.data() + first : nullptr, row.count, [&](int r, int begin, int end) {
              RunOfCells<Policy::row_length> const run{now, before, verdict, begin, end, first, against_baseline};
              run.add_to(s.region[r], limits, screen);
            });
      });
  auto const sums_h = download(exec, sums);
  QualityReport report;
  combine(mesh, table, sums_h.data(), report.near_field, report.far_field);
  for (Zone const& zone : mesh.zones) report.zone_names.push_back(zone.name);
  report.left_handed_zones = int(std::count(input.handedness.begin(), input.handedness.end(), -1));
  report.against_baseline = against_baseline;
  keep_verdict(report);
  return report;
}

#define GRIDMORPH_INSTANTIATE(Exec) \
  template QualityReport fast_quality(Exec const&, Mesh const&, QualityInput<Exec::memory_space> const&);
GRIDMORPH_FOR_EACH_EXEC(GRIDMORPH_INSTANTIATE)
#undef GRIDMORPH_INSTANTIATE

}  // namespace gridmorph::detail
