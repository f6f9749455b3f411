// Tables that kernels over the cells of all zones need; internal to the quality part.
#pragma once

#include <gridmorph/kernels/cell_quality.hpp>
#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/quality/quality.hpp>

#include <Kokkos_Core.hpp>

#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace gridmorph::detail {

/// One zone as a kernel over its cells sees it.
struct ZoneCells {
  Index first_node = 0;
  Index first_cell = 0;
  int extent[3] = {0, 0, 0};  ///< cells along i, j, k
  double handedness = 1;

  KOKKOS_INLINE_FUNCTION Index node_stride(int axis) const {
    return axis == 0 ? 1 : axis == 1 ? Index(extent[0]) + 1 : (Index(extent[0]) + 1) * (Index(extent[1]) + 1);
  }
  KOKKOS_INLINE_FUNCTION Index cell_stride(int axis) const {
    return axis == 0 ? 1 : axis == 1 ? Index(extent[0]) : Index(extent[0]) * extent[1];
  }
};

/// Cells begin <= n < end of one box of cells, numbered within the box, i fastest. One work item takes one chunk: sums
/// over a chunk are made in order, so they do not depend on how many threads share the chunks.
struct CellChunk {
  int zone = 0;
  int box_begin[3] = {0, 0, 0};
  int box_extent[3] = {0, 0, 0};
  Index begin = 0, end = 0;
};

/// Long chunks for CPUs, short ones where thousands of threads want work.
template <class Exec>
inline constexpr Index cells_per_chunk =
    Kokkos::SpaceAccessibility<Kokkos::HostSpace, typename Exec::memory_space>::accessible ? 1024 : 128;

/// Calls f(i, j, k) for the cells of a chunk, in order.
template <class Function>
KOKKOS_INLINE_FUNCTION void for_each_cell(CellChunk const& chunk, Function const& f) {
  Index const ni = chunk.box_extent[0], nj = chunk.box_extent[1];
  int i = int(chunk.begin % ni), j = int(chunk.begin / ni % nj), k = int(chunk.begin / (ni * nj));
  for (Index n = chunk.begin; n < chunk.end; ++n) {
    f(chunk.box_begin[0] + i, chunk.box_begin[1] + j, chunk.box_begin[2] + k);
    if (++i == chunk.box_extent[0]) {
      i = 0;
      if (++j == chunk.box_extent[1]) {
        j = 0;
        ++k;
      }
    }
  }
}

template <class MemorySpace>
KOKKOS_INLINE_FUNCTION HexCell load_cell(CoordinateViews<MemorySpace> const& c, ZoneCells const& zone, int i, int j,
                                         int k) {
  Index const sj = zone.node_stride(1), sk = zone.node_stride(2);
  Index const first = zone.first_node + i + j * sj + k * sk;
  HexCell cell;
  for (int n = 0; n < 8; ++n) {
    Index const node = first + (n & 1) + (n >> 1 & 1) * sj + (n >> 2) * sk;
    cell.corner[n] = {c.x(node), c.y(node), c.z(node)};
  }
  return cell;
}

/// handedness: one per zone, or empty for +1.
std::vector<ZoneCells> zone_cells(Mesh const& mesh, std::span<int const> handedness);

/// All cells of all zones in mesh order, in chunks of at most `size` cells.
std::vector<CellChunk> chunks_of(Mesh const& mesh, Index size);

/// The cells of the boxes in their order. Throws MeshError for a box outside its zone.
std::vector<CellChunk> chunks_of(Mesh const& mesh, std::span<CellBox const> boxes, Index size);

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
  Kokkos::View<T*, typename Exec::memory_space> device(Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, label),
                                                       table.size());
  Kokkos::View<T const*, Kokkos::HostSpace, Kokkos::MemoryUnmanaged> const host(table.data(), table.size());
  Kokkos::deep_copy(exec, device, host);
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
