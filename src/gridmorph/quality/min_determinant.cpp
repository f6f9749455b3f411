#include <gridmorph/core/error.hpp>
#include <gridmorph/core/instantiate.hpp>
#include <gridmorph/kernels/cell_chunks.hpp>
#include <gridmorph/quality/detail/zone_cells.hpp>

namespace gridmorph {

namespace {

/// The smallest value of some cells, and of equal ones the first cell in order of i, j, k.
struct SmallestCell {
  double value = 2;  // above every determinant
  int i = 0, j = 0, k = 0;

  KOKKOS_INLINE_FUNCTION bool before(SmallestCell const& other) const {
    return k != other.k ? k < other.k : j != other.j ? j < other.j : i < other.i;
  }
  KOKKOS_INLINE_FUNCTION void join(SmallestCell const& other) {
    if (other.value < value || (other.value == value && other.before(*this))) *this = other;
  }
};

}  // namespace

template <BuiltFor Exec>
CellValue min_determinant(Exec const& exec, Mesh const& mesh,
                          CoordinateViews<typename Exec::memory_space> const& coordinates,
                          std::span<int const> handedness, std::span<CellBox const> boxes) {
  detail::check_size(mesh, coordinates, "coordinates for the smallest determinant");
  if (handedness.size() != mesh.zones.size())
    throw MeshError("smallest determinant: " + std::to_string(handedness.size()) +
                    " zones have a handedness, the mesh '" + mesh.source + "' has " +
                    std::to_string(mesh.zones.size()) + " zones; use zone_handedness()");
  std::vector<kernels::CellChunk> const table = detail::chunks_of(mesh, boxes);
  CellValue smallest;
  if (table.empty()) return smallest;

  using Policy = kernels::CellPolicy<Exec>;
  auto const zones = detail::upload(exec, "gridmorph::quality::zones", detail::zone_cells(mesh, handedness));
  auto const chunks = detail::upload(exec, "gridmorph::quality::chunks", table);
  Kokkos::View<SmallestCell*, typename Exec::memory_space> const minima(
      Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, "gridmorph::quality::minima"), table.size());
  kernels::visit_chunks<kernels::by_lanes>(
      exec, "gridmorph::min_determinant", chunks, minima,
      KOKKOS_LAMBDA(kernels::RowOfCells const& row, SmallestCell& smallest_of_chunk) {
        double determinant[Policy::row_length], mark[Policy::row_length];
        kernels::row_determinants<Policy::lanes>(detail::cell_row(coordinates, zones(row.zone), row), determinant,
                                                 mark);
        for (int n = 0; n < row.count; ++n)
          if (determinant[n] < smallest_of_chunk.value) smallest_of_chunk = {determinant[n], row.i + n, row.j, row.k};
      });
  auto const minima_h = detail::download(exec, minima);

  for (std::size_t c = 0; c < table.size(); ++c) {
    SmallestCell const& m = minima_h(c);
    if (smallest.zone < 0 || m.value < smallest.value) smallest = {m.value, table[c].zone, {m.i, m.j, m.k}};
  }
  return smallest;
}

#define GRIDMORPH_INSTANTIATE(Exec)                                                                        \
  template CellValue min_determinant(Exec const&, Mesh const&, CoordinateViews<Exec::memory_space> const&, \
                                     std::span<int const>, std::span<CellBox const>);
GRIDMORPH_FOR_EACH_EXEC(GRIDMORPH_INSTANTIATE)
#undef GRIDMORPH_INSTANTIATE

}  // namespace gridmorph
