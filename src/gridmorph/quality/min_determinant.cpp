#include <gridmorph/core/error.hpp>
#include <gridmorph/core/instantiate.hpp>
#include <gridmorph/quality/detail/zone_cells.hpp>

namespace gridmorph {

namespace {

struct ChunkMinimum {
  double value;
  int cell[3];
};

}  // namespace

template <class Exec>
CellValue min_determinant(Exec const& exec, Mesh const& mesh,
                          CoordinateViews<typename Exec::memory_space> const& coordinates,
                          std::span<int const> handedness, std::span<CellBox const> boxes) {
  detail::check_size(mesh, coordinates, "coordinates for the smallest determinant");
  if (handedness.size() != mesh.zones.size())
    throw MeshError("smallest determinant: " + std::to_string(handedness.size()) +
                    " zones have a handedness, the mesh '" + mesh.source + "' has " +
                    std::to_string(mesh.zones.size()) + " zones; use zone_handedness()");
  std::vector<detail::CellChunk> const table = detail::chunks_of(mesh, boxes, detail::cells_per_chunk<Exec>);
  CellValue smallest;
  if (table.empty()) return smallest;

  auto const zones = detail::upload(exec, "gridmorph::quality::zones", detail::zone_cells(mesh, handedness));
  auto const chunks = detail::upload(exec, "gridmorph::quality::chunks", table);
  Kokkos::View<ChunkMinimum*, typename Exec::memory_space> minima(
      Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, "gridmorph::quality::minima"), table.size());
  Kokkos::parallel_for(
      "gridmorph::min_determinant", Kokkos::RangePolicy<Exec>(exec, 0, int(table.size())), KOKKOS_LAMBDA(int c) {
        detail::CellChunk const chunk = chunks(c);
        detail::ZoneCells const zone = zones(chunk.zone);
        ChunkMinimum m{2, {0, 0, 0}};
        detail::for_each_cell(chunk, [&](int i, int j, int k) {
          double const d = determinant_3x3x3(detail::load_cell(coordinates, zone, i, j, k), zone.handedness);
          if (d < m.value) m = {d, {i, j, k}};
        });
        minima(c) = m;
      });
  auto const minima_h = detail::download(exec, minima);

  for (std::size_t c = 0; c < table.size(); ++c) {
    ChunkMinimum const& m = minima_h(c);
    if (smallest.zone < 0 || m.value < smallest.value)
      smallest = {m.value, table[c].zone, {m.cell[0], m.cell[1], m.cell[2]}};
  }
  return smallest;
}

#define GRIDMORPH_INSTANTIATE(Exec)                                                                        \
  template CellValue min_determinant(Exec const&, Mesh const&, CoordinateViews<Exec::memory_space> const&, \
                                     std::span<int const>, std::span<CellBox const>);
GRIDMORPH_FOR_EACH_EXEC(GRIDMORPH_INSTANTIATE)
#undef GRIDMORPH_INSTANTIATE

}  // namespace gridmorph
