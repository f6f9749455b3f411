// Tables that kernels over the cells of all zones need; internal to the quality part.
#pragma once

#include <gridmorph/core/enqueue_copy.hpp>
#include <gridmorph/kernels/cell_row.hpp>
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

/// How execution spaces differ: a work item of a CPU takes a chunk row by row, several cells at once; GPUs take one cell
/// per work item and have a team of threads for the chunk. Chunks are the same everywhere.
template <class Exec>
struct CellPolicy {
  static constexpr bool on_host =
      Kokkos::SpaceAccessibility<Kokkos::HostSpace, typename Exec::memory_space>::accessible;
  static constexpr int lanes = on_host ? kernels::native_lanes : 1;
  static constexpr int row_length = on_host ? 64 : 1;  ///< scratch arrays of rows stay in the first-level cache
  static constexpr int team_size = on_host ? 1 : 32;   ///< partial sums of a team fit into 48 KiB of scratch memory
};

/// Cells begin <= n < end of one box of cells, numbered within the box, i fastest. Sums are made chunk by chunk, so they
/// do not depend on how many threads share the chunks.
struct CellChunk {
  int zone = 0;
  int box_begin[3] = {0, 0, 0};
  int box_extent[3] = {0, 0, 0};
  Index begin = 0, end = 0;
};

inline constexpr Index cells_per_chunk = 1024;

/// `count` cells of a zone that follow one another along i from cell (i, j, k) on.
struct RowOfCells {
  int zone;
  int i, j, k;
  int count;
};

/// The cell with number n of a chunk's box.
KOKKOS_INLINE_FUNCTION RowOfCells cell_of_chunk(CellChunk const& chunk, Index n) {
  Index const ni = chunk.box_extent[0], nj = chunk.box_extent[1];
  return {chunk.zone, chunk.box_begin[0] + int(n % ni), chunk.box_begin[1] + int(n / ni % nj),
          chunk.box_begin[2] + int(n / (ni * nj)), 1};
}

/// Calls f(row) for the cells of a chunk in order, in rows of at most `length` cells.
template <class Function>
KOKKOS_INLINE_FUNCTION void for_each_row(CellChunk const& chunk, int length, Function const& f) {
  for (Index n = chunk.begin; n < chunk.end;) {
    RowOfCells row = cell_of_chunk(chunk, n);
    Index const to_end_of_row = chunk.box_begin[0] + chunk.box_extent[0] - row.i, to_end_of_chunk = chunk.end - n;
    Index const count = to_end_of_row < to_end_of_chunk ? to_end_of_row : to_end_of_chunk;
    row.count = int(count < length ? count : length);
    f(row);
    n += row.count;
  }
}

/// Number in the mesh of the first cell of a row.
KOKKOS_INLINE_FUNCTION Index first_cell(ZoneCells const& zone, RowOfCells const& r) {
  return zone.first_cell + r.i + r.j * zone.cell_stride(1) + r.k * zone.cell_stride(2);
}

template <class MemorySpace>
KOKKOS_INLINE_FUNCTION kernels::CellRow cell_row(CoordinateViews<MemorySpace> const& c, ZoneCells const& zone,
                                                 RowOfCells const& r) {
  Index const sj = zone.node_stride(1), sk = zone.node_stride(2);
  Index const first = zone.first_node + r.i + r.j * sj + r.k * sk;
  return {c.x.data() + first, c.y.data() + first, c.z.data() + first, sj, sk, r.count, zone.handedness};
}

/// handedness: one per zone, or empty for +1.
std::vector<ZoneCells> zone_cells(Mesh const& mesh, std::span<int const> handedness);

/// All cells of all zones in mesh order, in chunks of at most cells_per_chunk.
std::vector<CellChunk> chunks_of(Mesh const& mesh);

/// The cells of the boxes in their order. Throws MeshError for a box outside its zone.
std::vector<CellChunk> chunks_of(Mesh const& mesh, std::span<CellBox const> boxes);

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
