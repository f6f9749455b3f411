#include <gridmorph/core/error.hpp>
#include <gridmorph/core/instantiate.hpp>
#include <gridmorph/quality/detail/partial_sums.hpp>
#include <gridmorph/quality/detail/volume_ratio.hpp>
#include <gridmorph/quality/detail/wall_quality.hpp>

#include <algorithm>

namespace gridmorph {

template <class Exec>
QualityReport measure_quality(Exec const& exec, Mesh const& mesh,
                              QualityInput<typename Exec::memory_space> const& input) {
  using MemorySpace = typename Exec::memory_space;
  bool const against_baseline = input.baseline.x.extent(0) > 0;
  detail::check_size(mesh, input.coordinates, "coordinates to measure");
  if (against_baseline) detail::check_size(mesh, input.baseline, "baseline coordinates");
  std::vector<Index> const first = first_cells(mesh);
  if (input.near_field.extent(0) > 0 && Index(input.near_field.extent(0)) < first.back())
    throw MeshError("near-field mask: it holds " + std::to_string(input.near_field.extent(0)) + " cells, the mesh '" +
                    mesh.source + "' has " + std::to_string(first.back()));

  std::vector<int> const handedness =
      zone_handedness(exec, mesh, against_baseline ? input.baseline : input.coordinates);
  std::vector<detail::CellChunk> const table = detail::chunks_of(mesh, detail::cells_per_chunk<Exec>);
  auto const zones = detail::upload(exec, "gridmorph::quality::zones", detail::zone_cells(mesh, handedness));
  auto const chunks = detail::upload(exec, "gridmorph::quality::chunks", table);
  auto const neighbours = detail::upload_neighbours(exec, mesh);
  Kokkos::View<double*, MemorySpace> volumes(
      Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, "gridmorph::quality::volumes"), first.back());
  Kokkos::View<detail::PartialSums*, MemorySpace> sums(
      Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, "gridmorph::quality::sums"), table.size());

  auto const coordinates = input.coordinates;
  auto const baseline = input.baseline;
  auto const near_field = input.near_field;
  bool const has_near_field = near_field.extent(0) > 0;
  Kokkos::parallel_for(
      "gridmorph::measure_quality::cells", Kokkos::RangePolicy<Exec>(exec, 0, int(table.size())), KOKKOS_LAMBDA(int c) {
        detail::CellChunk const chunk = chunks(c);
        detail::ZoneCells const zone = zones(chunk.zone);
        detail::PartialSums s;
        detail::for_each_cell(chunk, [&](int i, int j, int k) {
          Index const cell = zone.first_cell + i + j * zone.cell_stride(1) + k * zone.cell_stride(2);
          HexCell const corners = detail::load_cell(coordinates, zone, i, j, k);
          CellMeasures const m = cell_measures(corners, zone.handedness);
          volumes(cell) = m.volume;
          auto& region = s.region[has_near_field && near_field(cell) != 0 ? 0 : 1];
          region.cells += 1;
          region.collapsed += m.collapsed ? 1 : 0;
          region.add(Measure::aspect_ratio, m.aspect_ratio, cell);
          region.add(Measure::determinant_2x2x2, m.determinant_2x2x2, cell);
          region.add(Measure::determinant_3x3x3, m.determinant_3x3x3, cell);
          region.add(Measure::minimum_angle_deg, m.minimum_angle_deg, cell);
          region.add(Measure::equiangle_skewness, m.equiangle_skewness, cell);
          region.add(Measure::volume, m.volume, cell);
          bool const inverted = !(m.smallest_corner_jacobian > 0);
          region.inverted += inverted ? 1 : 0;
          if (against_baseline) {
            HexCell const before = detail::load_cell(baseline, zone, i, j, k);
            Vec3 const r = relative_displacement(before, corners);
            region.add(Measure::relative_displacement, larger(r.x, larger(r.y, r.z)), cell);
            if (inverted && cell_measures(before, zone.handedness).smallest_corner_jacobian > 0)
              region.newly_inverted += 1;
          }
        });
        sums(c) = s;
      });

  Kokkos::View<double const*, MemorySpace> const all_volumes = volumes;
  Kokkos::parallel_for(
      "gridmorph::measure_quality::volume_ratio", Kokkos::RangePolicy<Exec>(exec, 0, int(table.size())),
      KOKKOS_LAMBDA(int c) {
        detail::CellChunk const chunk = chunks(c);
        detail::ZoneCells const zone = zones(chunk.zone);
        detail::PartialMeasure ratio[2];
        detail::for_each_cell(chunk, [&](int i, int j, int k) {
          Index const cell = zone.first_cell + i + j * zone.cell_stride(1) + k * zone.cell_stride(2);
          ratio[has_near_field && near_field(cell) != 0 ? 0 : 1].add(
              detail::worst_volume_ratio(all_volumes, chunk.zone, zone, neighbours, i, j, k), cell,
              larger_is_worse(Measure::volume_ratio));
        });
        for (int r = 0; r < 2; ++r) sums(c).region[r].measure[int(Measure::volume_ratio)] = ratio[r];
      });
  auto const sums_h = detail::download(exec, sums);

  QualityReport report;
  detail::combine(mesh, table, sums_h.data(), report.near_field, report.far_field);
  report.wall = detail::wall_quality(exec, mesh, input.coordinates, input.baseline, input.walls);
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
