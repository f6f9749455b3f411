// Tables that kernels over the cells of all zones need; internal to the quality part.
#pragma once

#include <gridmorph/core/enqueue_copy.hpp>
#include <gridmorph/kernels/cell_chunks.hpp>
#include <gridmorph/kernels/cell_row.hpp>
#include <gridmorph/kernels/field.hpp>
#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/quality/quality.hpp>

#include <Kokkos_Core.hpp>

#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace gridmorph::detail {

template <class MemorySpace>
kernels::Field<double const> field_of(CoordinateViews<MemorySpace> const& c) {
  return {c.x.data(), c.y.data(), c.z.data()};
}

template <class MemorySpace>
KOKKOS_INLINE_FUNCTION kernels::CellRow cell_row(CoordinateViews<MemorySpace> const& c, kernels::ZoneCells const& zone,
                                                 kernels::RowOfCells const& r) {
  Index const sj = zone.node_stride(1), sk = zone.node_stride(2);
  Index const first = zone.first_node + r.i + r.j * sj + r.k * sk;
  return {c.x.data() + first, c.y.data() + first, c.z.data() + first, sj, sk, r.count, zone.handedness};
}

/// handedness: one per zone, or empty for +1.
std::vector<kernels::ZoneCells> zone_cells(Mesh const& mesh, std::span<int const> handedness);

/// All cells of all zones in mesh order, in chunks of at most cells_per_chunk.
std::vector<kernels::CellChunk> chunks_of(Mesh const& mesh);

/// The cells of the boxes in their order. Throws MeshError for a box outside its zone.
std::vector<kernels::CellChunk> chunks_of(Mesh const& mesh, std::span<CellBox const> boxes);

/// Throws MeshError unless each of the Views holds every node of the mesh; `what` names them in the message.
void check_size(Mesh const& mesh, std::size_t nx, std::size_t ny, std::size_t nz, std::string const& what);

template <class MemorySpace>
void check_size(Mesh const& mesh, CoordinateViews<MemorySpace> const& c, std::string const& what) {
  check_size(mesh, c.x.extent(0), c.y.extent(0), c.z.extent(0), what);
}

/// A host table on the device. Fences, because `table` may go out of scope.
template <class Exec, class T>
Kokkos::View<T*, typename Exec::memory_space> upload(Exec const& exec, std::string const& label,
                                                     std::vector<T> const& table) {
  static_assert(std::is_trivially_copyable_v<T>);
  auto const device = enqueue_copy(exec, table, label);
  compat::fence(exec, "gridmorph::quality::upload (the host table may go away)");
  return device;
}

/// A device table on the host, where it can be read at once.
template <class Exec, class View>
auto download(Exec const& exec, View const& device) {
  auto host = Kokkos::create_mirror_view(device);
  Kokkos::deep_copy(exec, host, device);
  compat::fence(exec, "gridmorph::quality::download (the host reads it)");
  return host;
}

}  // namespace gridmorph::detail
