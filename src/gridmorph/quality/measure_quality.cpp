#include <gridmorph/core/error.hpp>
#include <gridmorph/core/instantiate.hpp>
#include <gridmorph/kernels/cell_chunks.hpp>
#include <gridmorph/quality/detail/fast_quality.hpp>
#include <gridmorph/quality/detail/judge_cells.hpp>
#include <gridmorph/quality/detail/line_ratios.hpp>
#include <gridmorph/quality/detail/volume_ratio.hpp>
#include <gridmorph/quality/detail/wall_quality.hpp>
#include <gridmorph/quality/detail/zone_cells.hpp>

#include <algorithm>
#include <string>
#include <utility>

namespace gridmorph {

namespace {

/// What the passes over cells share: tables, and values by cell that neighbours are compared by.
template <class Exec>
struct CellPasses {
  using MemorySpace = typename Exec::memory_space;
  using Values = Kokkos::View<double*, MemorySpace>;

  QualityInput<MemorySpace> const& input;
  Kokkos::View<kernels::ZoneCells*, MemorySpace> zones;
  detail::Neighbours<MemorySpace> neighbours;
  detail::LinkedFaces<MemorySpace> linked;
  Values volumes;
};

/// Volume ratios of the cells of a row, from volumes; kept in `field` where there is one.
template <class MemorySpace>
struct VolumeRatiosOfRow {
  Kokkos::View<double const*, MemorySpace> volumes;
  detail::Neighbours<MemorySpace> neighbours;
  Kokkos::View<double*, MemorySpace> field;

  template <int N>
  KOKKOS_INLINE_FUNCTION void operator()(kernels::ZoneCells const& zone, kernels::RowOfCells const& row, Index cell,
                                         double (&ratio)[N]) const {
    detail::worst_volume_ratios<N>(volumes, zone, neighbours, row, ratio);
    if (field.extent(0) > 0)
      for (int n = 0; n < row.count; ++n) field(cell + n) = ratio[n];
  }
};

/// Growth or face area ratios of them; kept likewise.
template <detail::LinePart part, class MemorySpace>
struct LineRatiosOfRow {
  detail::LineSizes<part, MemorySpace> sizes;
  detail::LinkedFaces<MemorySpace> linked;
  Kokkos::View<double*, MemorySpace> field;

  template <int N>
  KOKKOS_INLINE_FUNCTION void operator()(kernels::ZoneCells const& zone, kernels::RowOfCells const& row, Index cell,
                                         double (&ratio)[N]) const {
    detail::worst_line_ratios(sizes, linked, zone, row, ratio);
    if (field.extent(0) > 0)
      for (int n = 0; n < row.count; ++n) field(cell + n) = ratio[n];
  }
};

/// Adds a ratio of the cells of the chunks to their sums. near_field: as QualityInput::near_field.
template <class Exec, class RatiosOfRow>
void add_ratios(Exec const& exec, std::string const& label, Measure measure,
                Kokkos::View<kernels::ZoneCells*, typename Exec::memory_space> const& zones,
                Kokkos::View<kernels::CellChunk*, typename Exec::memory_space> const& chunks,
                Kokkos::View<std::uint8_t const*, typename Exec::memory_space> const& near_field,
                RatiosOfRow const& ratios_of_row, std::vector<detail::PartialSums>& sums) {
  using Policy = kernels::CellPolicy<Exec>;
  Kokkos::View<detail::NeighbourRatios*, typename Exec::memory_space> const ratios(
      Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, "gridmorph::quality::neighbour_ratios"), sums.size());
  bool const has_near_field = near_field.extent(0) > 0;
  kernels::visit_chunks<kernels::by_lanes>(
      exec, label, chunks, ratios, KOKKOS_LAMBDA(kernels::RowOfCells const& row, detail::NeighbourRatios& s) {
        constexpr int lanes = Policy::lanes, length = Policy::row_length;
        kernels::ZoneCells const zone = zones(row.zone);
        Index const cell = kernels::first_cell(zone, row);
        double ratio[length];
        ratios_of_row(zone, row, cell, ratio);
        detail::for_each_region_run(has_near_field ? near_field.data() + cell : nullptr, row.count,
                                    [&](int r, int begin, int end) {
                                      s.region[r].template add<lanes>(ratio + begin, end - begin, cell + begin, true);
                                    });
      });
  auto const ratios_h = detail::download(exec, ratios);
  for (std::size_t c = 0; c < sums.size(); ++c)
    for (int r = 0; r < 2; ++r) sums[c].region[r].measure[int(measure)] = ratios_h(c).region[r];
}

/// Everything but ratios to neighbours, of the cells of the chunks; writes volumes and, where `keep`, fields.
template <class Exec>
std::vector<detail::PartialSums> sums_of_cells(
    Exec const& exec, CellPasses<Exec> const& passes,
    Kokkos::View<kernels::CellChunk*, typename Exec::memory_space> const& chunks,
    Kokkos::View<std::uint8_t const*, typename Exec::memory_space> const& near_field, bool keep) {
  using MemorySpace = typename Exec::memory_space;
  using Policy = kernels::CellPolicy<Exec>;
  Kokkos::View<detail::PartialSums*, MemorySpace> const sums(
      Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, "gridmorph::quality::sums"), chunks.extent(0));
  auto const zones = passes.zones;
  auto const volumes = passes.volumes;
  auto const fields = keep ? passes.input.fields : CellFields<MemorySpace>();
  auto const coordinates = passes.input.coordinates;
  auto const baseline = passes.input.baseline;
  bool const against_baseline = baseline.x.extent(0) > 0;
  bool const has_near_field = near_field.extent(0) > 0;
  CellLimits const limits = passes.input.limits;
  detail::CellScreen const screen(limits);
  kernels::visit_chunks<kernels::by_lanes>(
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
        kernels::RowRelativeDisplacements<length> relative;
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
        if (against_baseline) {
          write(Measure::relative_displacement, relative.largest);
          for (int d = 0; d < 3; ++d) write(relative_displacement_along(d), relative.along[d]);
        }
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
              if (against_baseline) {
                add(Measure::relative_displacement, relative.largest);
                for (int d = 0; d < 3; ++d) add(relative_displacement_along(d), relative.along[d]);
              }
              region.cells += end - begin;
              for (int n = begin; n < end; ++n) {
                region.collapsed += m.collapsed[n] ? 1 : 0;
                detail::count_state(region, m.smallest_corner_jacobian[n]);
                if (against_baseline && screen.may_fall(m.determinant_3x3x3[n], m.minimum_angle_deg[n],
                                                        m.equiangle_skewness[n], m.collapsed[n]))
                  detail::judge(region, limits, cell_measures(before.cell(n), zone.handedness),
                                cell_measures(now.cell(n), zone.handedness), cell + n,
                                [&] { return kernels::flat_cell(before.cell(n), now.cell(n), zone.handedness); });
              }
            });
      });
  auto const sums_h = detail::download(exec, sums);
  return {sums_h.data(), sums_h.data() + sums_h.extent(0)};
}

/// All of it.
template <class Exec>
std::vector<detail::PartialSums> measured(
    Exec const& exec, CellPasses<Exec> const& passes, std::vector<kernels::CellChunk> const& table,
    Kokkos::View<std::uint8_t const*, typename Exec::memory_space> const& near_field, bool whole_mesh) {
  using MemorySpace = typename Exec::memory_space;
  auto const chunks = detail::upload(exec, "gridmorph::quality::chunks", table);
  auto sums = sums_of_cells(exec, passes, chunks, near_field, whole_mesh);
  auto const field = [&](Measure measure) {
    return whole_mesh ? passes.input.fields.of[int(measure)] : Kokkos::View<double*, MemorySpace>();
  };
  auto const add = [&](std::string const& label, Measure measure, auto const& ratios_of_row) {
    add_ratios(exec, label, measure, passes.zones, chunks, near_field, ratios_of_row, sums);
  };
  auto const& x = passes.input.coordinates;
  using detail::LinePart;
  add("gridmorph::measure_quality::volume_ratio", Measure::volume_ratio,
      VolumeRatiosOfRow<MemorySpace>{passes.volumes, passes.neighbours, field(Measure::volume_ratio)});
  add("gridmorph::measure_quality::growth_ratio", Measure::growth_ratio,
      LineRatiosOfRow<LinePart::edge, MemorySpace>{{x}, passes.linked, field(Measure::growth_ratio)});
  add("gridmorph::measure_quality::face_area_ratio", Measure::face_area_ratio,
      LineRatiosOfRow<LinePart::face, MemorySpace>{{x}, passes.linked, field(Measure::face_area_ratio)});
  return sums;
}

}  // namespace

template <BuiltFor Exec>
QualityReport measure_quality(Exec const& exec, Mesh const& mesh,
                              QualityInput<typename Exec::memory_space> const& input) {
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
  Kokkos::View<double*, typename Exec::memory_space> volumes = input.fields.of[int(Measure::volume)];
  if (volumes.extent(0) == 0)
    volumes = Kokkos::View<double*, typename Exec::memory_space>(
        Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, "gridmorph::quality::volumes"), first.back());
  CellPasses<Exec> const passes{
      input, detail::upload(exec, "gridmorph::quality::zones", detail::zone_cells(mesh, handedness)),
      detail::upload_neighbours(exec, mesh), detail::upload_linked_faces(exec, mesh), volumes};
  auto const sums = measured(exec, passes, table, input.near_field, true);

  QualityReport report;
  detail::combine(mesh, table, sums.data(), report.near_field, report.far_field);
  for (NamedCells const& cells : input.regions) {
    std::vector<kernels::CellChunk> const boxes = detail::chunks_of(mesh, cells.boxes);
    NamedRegion region{cells.name, {}};
    QualityRegion none;
    detail::combine(mesh, boxes, measured(exec, passes, boxes, {}, false).data(), none, region.quality);
    report.regions.push_back(std::move(region));
  }
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
