#include <gridmorph/core/error.hpp>
#include <gridmorph/core/instantiate.hpp>
#include <gridmorph/quality/detail/volume_ratio.hpp>

#include <algorithm>

namespace gridmorph {

template <class Exec>
std::vector<Kokkos::View<double*, typename Exec::memory_space>> cell_fields(
    Exec const& exec, Mesh const& mesh, QualityInput<typename Exec::memory_space> const& input,
    std::span<Measure const> measures) {
  using MemorySpace = typename Exec::memory_space;
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
  std::vector<detail::CellChunk> const table = detail::chunks_of(mesh, detail::cells_per_chunk<Exec>);
  auto const zones = detail::upload(exec, "gridmorph::quality::zones", detail::zone_cells(mesh, handedness));
  auto const chunks = detail::upload(exec, "gridmorph::quality::chunks", table);
  auto const coordinates = input.coordinates;
  auto const baseline = input.baseline;
  Field const aspect_ratio = fields[int(Measure::aspect_ratio)], det8 = fields[int(Measure::determinant_2x2x2)],
              det27 = fields[int(Measure::determinant_3x3x3)], angle = fields[int(Measure::minimum_angle_deg)],
              skewness = fields[int(Measure::equiangle_skewness)], volume = fields[int(Measure::volume)],
              ratio = fields[int(Measure::volume_ratio)], relative = fields[int(Measure::relative_displacement)];
  Kokkos::parallel_for(
      "gridmorph::cell_fields", Kokkos::RangePolicy<Exec>(exec, 0, int(table.size())), KOKKOS_LAMBDA(int c) {
        detail::CellChunk const chunk = chunks(c);
        detail::ZoneCells const zone = zones(chunk.zone);
        detail::for_each_cell(chunk, [&](int i, int j, int k) {
          Index const cell = zone.first_cell + i + j * zone.cell_stride(1) + k * zone.cell_stride(2);
          HexCell const corners = detail::load_cell(coordinates, zone, i, j, k);
          CellMeasures const m = cell_measures(corners, zone.handedness);
          if (aspect_ratio.extent(0) > 0) aspect_ratio(cell) = m.aspect_ratio;
          if (det8.extent(0) > 0) det8(cell) = m.determinant_2x2x2;
          if (det27.extent(0) > 0) det27(cell) = m.determinant_3x3x3;
          if (angle.extent(0) > 0) angle(cell) = m.minimum_angle_deg;
          if (skewness.extent(0) > 0) skewness(cell) = m.equiangle_skewness;
          if (volume.extent(0) > 0) volume(cell) = m.volume;
          if (relative.extent(0) > 0) {
            Vec3 const r = against_baseline ? relative_displacement(detail::load_cell(baseline, zone, i, j, k), corners)
                                            : Vec3{0, 0, 0};
            relative(cell) = larger(r.x, larger(r.y, r.z));
          }
        });
      });

  if (wanted(Measure::volume_ratio)) {
    auto const neighbours = detail::upload_neighbours(exec, mesh);
    Kokkos::View<double const*, MemorySpace> const volumes = volume;
    Kokkos::parallel_for(
        "gridmorph::cell_fields::volume_ratio", Kokkos::RangePolicy<Exec>(exec, 0, int(table.size())),
        KOKKOS_LAMBDA(int c) {
          detail::CellChunk const chunk = chunks(c);
          detail::ZoneCells const zone = zones(chunk.zone);
          detail::for_each_cell(chunk, [&](int i, int j, int k) {
            Index const cell = zone.first_cell + i + j * zone.cell_stride(1) + k * zone.cell_stride(2);
            ratio(cell) = detail::worst_volume_ratio(volumes, chunk.zone, zone, neighbours, i, j, k);
          });
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
