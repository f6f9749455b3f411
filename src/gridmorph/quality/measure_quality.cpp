#include <gridmorph/core/error.hpp>
#include <gridmorph/core/instantiate.hpp>
#include <gridmorph/kernels/cell_chunks.hpp>
#include <gridmorph/quality/detail/fast_quality.hpp>
#include <gridmorph/quality/detail/judge_cells.hpp>
#include <gridmorph/quality/detail/volume_ratio.hpp>
#include <gridmorph/quality/detail/wall_quality.hpp>
#include <gridmorph/quality/detail/zone_cells.hpp>

#include <algorithm>
#include <utility>

namespace gridmorph {

template <class Exec>
QualityReport measure_quality(Exec const& exec, Mesh const& mesh,
                              QualityInput<typename Exec::memory_space> const& input) {
  using MemorySpace = typename Exec::memory_space;
  using Policy = kernels::CellPolicy<Exec>;
  bool const against_baseline = input.baseline.x.extent(0) > 0;
  detail::check_size(mesh, input.coordinates, "coordinates to measure");
  if (against_baseline) detail::check_size(mesh, input.baseline, "baseline coordinates");
  std::vector<Index> const first = first_cells(mesh);
  if (input.near_field.extent(0) > 0 && Index(input.near_field.extent(0)) < first.back())
    throw MeshError("near-field mask: it holds " + std::to_string(input.near_field.extent(0)) + " cells, the mesh '" +
                    mesh.source + "' has " + std::to_string(first.back()));

  for (std::size_t m = 0; m < n_measures; ++m)
    if (Index const size = Index(input.fields.of[m].extent(0)); size > 0 && size < first.back())
      throw MeshError("field of " + std::string(to_string(Measure(m))) + ": it has room for " + std::to_string(size) +
                      " cells, the mesh '" + mesh.source + "' has " + std::to_string(first.back()));

  if (input.handedness.size() != mesh.zones.size()) {
    auto known = input;
    known.handedness = zone_handedness(exec, mesh, against_baseline ? input.baseline : input.coordinates);
    return measure_quality(exec, mesh, known);
  }
  if (input.fast) return detail::fast_quality(exec, mesh, input);
  std::vector<int> const& handedness = input.handedness;
  std::vector<kernels::CellChunk> const table = detail::chunks_of(mesh);
  auto const zones = detail::upload(exec, "gridmorph::quality::zones", detail::zone_cells(mesh, handedness));
  auto const chunks = detail::upload(exec, "gridmorph::quality::chunks", table);
  auto const neighbours = detail::upload_neighbours(exec, mesh);
  auto const fields = input.fields;
  Kokkos::View<double*, MemorySpace> volumes = input.fields.of[int(Measure::volume)];
  if (volumes.extent(0) == 0)
    volumes = Kokkos::View<double*, MemorySpace>(
        Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, "gridmorph::quality::volumes"), first.back());
  Kokkos::View<detail::PartialSums*, MemorySpace> const sums(
      Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, "gridmorph::quality::sums"), table.size());

  auto const coordinates = input.coordinates;
  auto const baseline = input.baseline;
  auto const near_field = input.near_field;
  bool const has_near_field = near_field.extent(0) > 0;
  CellLimits const limits = input.limits;
  detail::CellScreen const screen(limits);
  kernels::visit_chunks(
      exec, "gridmorph::measure_quality::cells", chunks, sums,
      KOKKOS_LAMBDA(kernels::RowOfCells const& row, detail::PartialSums& s) {
        constexpr int lanes = Policy::lanes, length = Policy::row_length;
        kernels::ZoneCells const zone = zones(row.zone);
        Index const cell = kernels::first_cell(zone, row);
        kernels::CellRow const now = detail::cell_row(coordinates, zone, row);
        kernels::RowMeasures<length> m;
        row_measures<lanes>(now, m);
        for (int n = 0; n < row.count; ++n) volumes(cell + n) = m.volume[n];
        kernels::CellRow before = now;
        double relative[length];
        if (against_baseline) {
          before = detail::cell_row(baseline, zone, row);
          row_relative_displacements<lanes>(before, now, relative);
        }
        auto const write = [&](Measure measure, double const* values) {
          auto const& field = fields.of[int(measure)];
          if (field.extent(0) > 0)
            for (int n = 0; n < row.count; ++n) field(cell + n) = values[n];
        };
        write(Measure::aspect_ratio, m.aspect_ratio);
        write(Measure::determinant_2x2x2, m.determinant_2x2x2);
        write(Measure::determinant_3x3x3, m.determinant_3x3x3);
        write(Measure::minimum_angle_deg, m.minimum_angle_deg);
        write(Measure::equiangle_skewness, m.equiangle_skewness);
        if (against_baseline) write(Measure::relative_displacement, relative);
        detail::for_each_region_run(
            has_near_field ? near_field.data() + cell : nullptr, row.count, [&](int r, int begin, int end) {
              auto& region = s.region[r];
              auto const add = [&](Measure measure, double const* values) {
                region.template add<lanes>(measure, values + begin, end - begin, cell + begin);
              };
              add(Measure::aspect_ratio, m.aspect_ratio);
              add(Measure::determinant_2x2x2, m.determinant_2x2x2);
              add(Measure::determinant_3x3x3, m.determinant_3x3x3);
              add(Measure::minimum_angle_deg, m.minimum_angle_deg);
              add(Measure::equiangle_skewness, m.equiangle_skewness);
              add(Measure::volume, m.volume);
              if (against_baseline) add(Measure::relative_displacement, relative);
              region.cells += end - begin;
              for (int n = begin; n < end; ++n) {
                region.collapsed += m.collapsed[n] ? 1 : 0;
                detail::count_state(region, m.smallest_corner_jacobian[n]);
                if (against_baseline && screen.may_fall(m.determinant_3x3x3[n], m.minimum_angle_deg[n],
                                                        m.equiangle_skewness[n], m.collapsed[n]))
                  detail::judge(region, limits, cell_measures(before.cell(n), zone.handedness),
                                cell_measures(now.cell(n), zone.handedness), cell + n);
              }
            });
      });

  Kokkos::View<double const*, MemorySpace> const all_volumes = volumes;
  auto const ratio_field = fields.of[int(Measure::volume_ratio)];
  Kokkos::View<detail::VolumeRatios*, MemorySpace> const ratios(
      Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, "gridmorph::quality::volume_ratios"), table.size());
  kernels::visit_chunks(
      exec, "gridmorph::measure_quality::volume_ratio", chunks, ratios,
      KOKKOS_LAMBDA(kernels::RowOfCells const& row, detail::VolumeRatios& s) {
        constexpr int lanes = Policy::lanes, length = Policy::row_length;
        kernels::ZoneCells const zone = zones(row.zone);
        Index const cell = kernels::first_cell(zone, row);
        double ratio[length];
        detail::worst_volume_ratios<length>(all_volumes, zone, neighbours, row, ratio);
        if (ratio_field.extent(0) > 0)
          for (int n = 0; n < row.count; ++n) ratio_field(cell + n) = ratio[n];
        detail::for_each_region_run(has_near_field ? near_field.data() + cell : nullptr, row.count,
                                    [&](int r, int begin, int end) {
                                      s.region[r].template add<lanes>(ratio + begin, end - begin, cell + begin,
                                                                      larger_is_worse(Measure::volume_ratio));
                                    });
      });
  auto const sums_h = detail::download(exec, sums);
  auto const ratios_h = detail::download(exec, ratios);
  for (std::size_t c = 0; c < table.size(); ++c)
    for (int r = 0; r < 2; ++r) sums_h(c).region[r].measure[int(Measure::volume_ratio)] = ratios_h(c).region[r];

  QualityReport report;
  detail::combine(mesh, table, sums_h.data(), report.near_field, report.far_field);
  detail::WallQualities walls = detail::wall_quality(exec, mesh, input.coordinates, input.baseline, input.walls);
  report.wall = walls.all;
  report.wall_groups = std::move(walls.groups);
  for (Zone const& zone : mesh.zones) report.zone_names.push_back(zone.name);
  report.left_handed_zones = int(std::count(handedness.begin(), handedness.end(), -1));
  report.against_baseline = against_baseline;
  return report;
}

#define GRIDMORPH_INSTANTIATE(Exec) \
  template QualityReport measure_quality(Exec const&, Mesh const&, QualityInput<Exec::memory_space> const&);
GRIDMORPH_FOR_EACH_EXEC(GRIDMORPH_INSTANTIATE)
#undef GRIDMORPH_INSTANTIATE

}  // namespace gridmorph
