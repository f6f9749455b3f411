#include <gridmorph/core/instantiate.hpp>
#include <gridmorph/quality/detail/zone_cells.hpp>

namespace gridmorph {

template <class Exec>
std::vector<int> zone_handedness(Exec const& exec, Mesh const& mesh,
                                 CoordinateViews<typename Exec::memory_space> const& baseline) {
  detail::check_size(mesh, baseline, "coordinates for the handedness of zones");
  auto const zones = detail::upload(exec, "gridmorph::quality::zones", detail::zone_cells(mesh, {}));
  std::vector<detail::CellChunk> const table = detail::chunks_of(mesh, detail::cells_per_chunk<Exec>);
  auto const chunks = detail::upload(exec, "gridmorph::quality::chunks", table);
  // Positive minus negative Jacobians at corner (0, 0, 0) of the cells of each chunk.
  Kokkos::View<int*, typename Exec::memory_space> balance(
      Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, "gridmorph::quality::balance"), table.size());
  Kokkos::parallel_for(
      "gridmorph::zone_handedness", Kokkos::RangePolicy<Exec>(exec, 0, int(table.size())), KOKKOS_LAMBDA(int c) {
        detail::CellChunk const chunk = chunks(c);
        detail::ZoneCells const zone = zones(chunk.zone);
        int count = 0;
        detail::for_each_cell(chunk, [&](int i, int j, int k) {
          HexEdges const e = hex_edges(detail::load_cell(baseline, zone, i, j, k));
          double const jacobian = dot(cross(e.of[0][0], e.of[1][0]), e.of[2][0]);
          count += (jacobian > 0 ? 1 : 0) - (jacobian < 0 ? 1 : 0);
        });
        balance(c) = count;
      });
  auto const balance_h = detail::download(exec, balance);

  std::vector<Index> total(mesh.zones.size(), 0);
  for (std::size_t c = 0; c < table.size(); ++c) total[table[c].zone] += balance_h(c);
  std::vector<int> handedness(total.size());
  for (std::size_t z = 0; z < total.size(); ++z) handedness[z] = total[z] >= 0 ? 1 : -1;
  return handedness;
}

#define GRIDMORPH_INSTANTIATE(Exec) \
  template std::vector<int> zone_handedness(Exec const&, Mesh const&, CoordinateViews<Exec::memory_space> const&);
GRIDMORPH_FOR_EACH_EXEC(GRIDMORPH_INSTANTIATE)
#undef GRIDMORPH_INSTANTIATE

}  // namespace gridmorph
