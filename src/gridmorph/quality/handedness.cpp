#include <gridmorph/core/instantiate.hpp>
#include <gridmorph/kernels/cell_chunks.hpp>
#include <gridmorph/quality/detail/zone_cells.hpp>

namespace gridmorph {

namespace {

/// Positive minus negative Jacobians at corner (0, 0, 0) of some cells.
struct Balance {
  int count = 0;

  KOKKOS_INLINE_FUNCTION void join(Balance const& other) { count += other.count; }
};

}  // namespace

template <BuiltFor Exec>
std::vector<int> zone_handedness(Exec const& exec, Mesh const& mesh,
                                 CoordinateViews<typename Exec::memory_space> const& baseline) {
  detail::check_size(mesh, baseline, "coordinates for the handedness of zones");
  auto const zones = detail::upload(exec, "gridmorph::quality::zones", detail::zone_cells(mesh, {}));
  std::vector<kernels::CellChunk> const table = detail::chunks_of(mesh);
  auto const chunks = detail::upload(exec, "gridmorph::quality::chunks", table);
  Kokkos::View<Balance*, typename Exec::memory_space> const balance(
      Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, "gridmorph::quality::balance"), table.size());
  kernels::visit_chunks(
      exec, "gridmorph::zone_handedness", chunks, balance, KOKKOS_LAMBDA(kernels::RowOfCells const& row, Balance& b) {
        b.count += row_orientation(detail::cell_row(baseline, zones(row.zone), row));
      });
  auto const balance_h = detail::download(exec, balance);

  std::vector<Index> total(mesh.zones.size(), 0);
  for (std::size_t c = 0; c < table.size(); ++c) total[table[c].zone] += balance_h(c).count;
  std::vector<int> handedness(total.size());
  for (std::size_t z = 0; z < total.size(); ++z) handedness[z] = total[z] >= 0 ? 1 : -1;
  return handedness;
}

#define GRIDMORPH_INSTANTIATE(Exec) \
  template std::vector<int> zone_handedness(Exec const&, Mesh const&, CoordinateViews<Exec::memory_space> const&);
GRIDMORPH_FOR_EACH_EXEC(GRIDMORPH_INSTANTIATE)
#undef GRIDMORPH_INSTANTIATE

}  // namespace gridmorph
