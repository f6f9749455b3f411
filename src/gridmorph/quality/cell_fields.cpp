#include <gridmorph/core/error.hpp>
#include <gridmorph/core/instantiate.hpp>
#include <gridmorph/quality/detail/visit_chunks.hpp>
#include <gridmorph/quality/detail/volume_ratio.hpp>

#include <algorithm>

namespace gridmorph {

template <class Exec>
std::vector<Kokkos::View<double*, typename Exec::memory_space>> cell_fields(
    Exec const& exec, Mesh const& mesh, QualityInput<typename Exec::memory_space> const& input,
    std::span<Measure const> measures) {
  using MemorySpace = typename Exec::memory_space;
  using Policy = detail::CellPolicy<Exec>;
  using Field = Kokkos::View<double*, MemorySpace>;
  bool const against_baseline = input.baseline.x.extent(0) > 0;
  detail::check_size(mesh, input.coordinates, "coordinates to measure");
  if (against_baseline) detail::check_size(mesh, input.baseline, "baseline coordinates");

  auto const wanted = [&](Measure m) { return std::find(measures.begin(), measures.end(), m) != measures.end(); };
  Index const n_cells = first_cells(mesh).back();
  // One View per measure, of size 0 where it is not asked for.
  Field fields[n_measures];
  for (std::size_t m = 0; m < n_measures; ++m) {
    bool const needed = wanted(Measure(m)) || (Measure(m) == Measure::volume && wanted(Measure::volume_ratio));
    fields[m] = Field(Kokkos::view_alloc(exec, Kokkos::WithoutInitializing,
                                         "gridmorph::cell_fields::" + std::string(to_string(Measure(m)))),
                      needed ? n_cells : 0);
  }

  std::vector<int> const handedness =
      zone_handedness(exec, mesh, against_baseline ? input.baseline : input.coordinates);
  std::vector<detail::CellChunk> const table = detail::chunks_of(mesh);
  auto const zones = detail::upload(exec, "gridmorph::quality::zones", detail::zone_cells(mesh, handedness));
  auto const chunks = detail::upload(exec, "gridmorph::quality::chunks", table);
  auto const coordinates = input.coordinates;
  auto const baseline = input.baseline;
  Field const aspect_ratio = fields[int(Measure::aspect_ratio)], det8 = fields[int(Measure::determinant_2x2x2)],
              det27 = fields[int(Measure::determinant_3x3x3)], angle = fields[int(Measure::minimum_angle_deg)],
              skewness = fields[int(Measure::equiangle_skewness)], volume = fields[int(Measure::volume)],
              ratio = fields[int(Measure::volume_ratio)], relative = fields[int(Measure::relative_displacement)];
  Kokkos::View<detail::NoResult*, MemorySpace> const nothing;
  detail::visit_chunks(
      exec, "gridmorph::cell_fields", chunks, nothing, KOKKOS_LAMBDA(detail::RowOfCells const& row, detail::NoResult&) {
        constexpr int lanes = Policy::lanes, length = Policy::row_length;
        detail::ZoneCells const zone = zones(row.zone);
        Index const cell = detail::first_cell(zone, row);
        auto const write = [&](Field const& field, double const* values) {
          if (field.extent(0) > 0)
            for (int n = 0; n < row.count; ++n) field(cell + n) = values[n];
        };
        CellRow const now = detail::cell_row(coordinates, zone, row);
        RowMeasures<length> m;
        row_measures<lanes>(now, m);
        write(aspect_ratio, m.aspect_ratio);
        write(det8, m.determinant_2x2x2);
        write(det27, m.determinant_3x3x3);
        write(angle, m.minimum_angle_deg);
        write(skewness, m.equiangle_skewness);
        write(volume, m.volume);
        if (relative.extent(0) > 0) {
          double values[length];
          if (against_baseline)
            row_relative_displacements<lanes>(detail::cell_row(baseline, zone, row), now, values);
          else
            for (double& value : values) value = 0;
          write(relative, values);
        }
      });

  if (wanted(Measure::volume_ratio)) {
    auto const neighbours = detail::upload_neighbours(exec, mesh);
    Kokkos::View<double const*, MemorySpace> const volumes = volume;
    detail::visit_chunks(
        exec, "gridmorph::cell_fields::volume_ratio", chunks, nothing,
        KOKKOS_LAMBDA(detail::RowOfCells const& row, detail::NoResult&) {
          double values[Policy::row_length];
          detail::ZoneCells const zone = zones(row.zone);
          detail::worst_volume_ratios<Policy::row_length>(volumes, zone, neighbours, row, values);
          Index const cell = detail::first_cell(zone, row);
          for (int n = 0; n < row.count; ++n) ratio(cell + n) = values[n];
        });
  }
  compat::fence(exec, "gridmorph::cell_fields (temporary fields go away)");

  std::vector<Field> result;
  for (Measure const m : measures) result.push_back(fields[int(m)]);
  return result;
}

#define GRIDMORPH_INSTANTIATE(Exec)                                            \
  template std::vector<Kokkos::View<double*, Exec::memory_space>> cell_fields( \
      Exec const&, Mesh const&, QualityInput<Exec::memory_space> const&, std::span<Measure const>);
GRIDMORPH_FOR_EACH_EXEC(GRIDMORPH_INSTANTIATE)
#undef GRIDMORPH_INSTANTIATE

}  // namespace gridmorph
