// Is a mesh valid: d = min over its cells of their determinant (cell_row.hpp, element_quality.hpp), and how many have d
// < 0. Chunk by chunk, then over the chunks.
#pragma once

#include <gridmorph/kernels/cell_chunks.hpp>
#include <gridmorph/kernels/cell_row.hpp>
#include <gridmorph/kernels/launch.hpp>
#include <gridmorph/kernels/vector_array.hpp>

#include <Kokkos_Core.hpp>

namespace gridmorph::kernels {

/// The verdict on one chunk of cells.
struct ChunkValidity {
  double smallest_determinant = 1;
  Index inverted = 0;

  KOKKOS_INLINE_FUNCTION void take(double determinant) {
    if (determinant < smallest_determinant) smallest_determinant = determinant;
    if (determinant < 0) ++inverted;
  }
  KOKKOS_INLINE_FUNCTION void join(ChunkValidity const& other) {
    if (other.smallest_determinant < smallest_determinant) smallest_determinant = other.smallest_determinant;
    inverted += other.inverted;
  }
};

/// The nodes of a row of cells gathered from wherever they lie.
template <int Length>
struct RowNodes {
  double x[4][Length + 1], y[4][Length + 1], z[4][Length + 1];

  KOKKOS_INLINE_FUNCTION RowNodes(VectorArray const& from, ZoneCells const& zone, RowOfCells const& row) {
    Index const sj = zone.node_stride(1), sk = zone.node_stride(2);
    for (int line = 0; line < 4; ++line) {
      Index const first = zone.first_node + row.i + (row.j + line % 2) * sj + (row.k + line / 2) * sk;
      from.with_row(first, [&](auto const& nodes) {
        for (int n = 0; n <= row.count; ++n) {
          x[line][n] = nodes.x[n * nodes.stride];
          y[line][n] = nodes.y[n * nodes.stride];
          z[line][n] = nodes.z[n * nodes.stride];
        }
      });
    }
  }
  KOKKOS_INLINE_FUNCTION CellRow cells(int count, double handedness) const {
    return {x[0], y[0], z[0], Length + 1, 2 * (Length + 1), count, handedness};
  }
};

/// of_chunk(c): the cells of chunk c. `zones` of blocks.
template <class Exec>
void check_blocks(Exec const& exec, Kokkos::View<CellChunk*, typename Exec::memory_space> const& chunks,
                  Kokkos::View<ZoneCells*, typename Exec::memory_space> const& zones, VectorArray const& x,
                  Kokkos::View<ChunkValidity*, typename Exec::memory_space> const& of_chunk) {
  using Policy = CellPolicy<Exec>;
  visit_chunks<by_lanes>(
      exec, "gridmorph::validity::blocks", chunks, of_chunk,
      KOKKOS_LAMBDA(RowOfCells const& row, ChunkValidity& validity) {
        RowNodes<Policy::row_length> const nodes(x, zones(row.zone), row);
        double determinant[Policy::row_length], mark[Policy::row_length];
        row_determinants<Policy::lanes>(nodes.cells(row.count, zones(row.zone).handedness), determinant, mark);
        for (int n = 0; n < row.count; ++n) validity.take(determinant[n]);
      });
}

/// The verdict on each chunk of elements, into of_chunk; determinant_of(element) is 1 where there is none to look at.
/// Those of zone z begin at first_element(z).
template <class Exec, class DeterminantOf>
void check_elements(Exec const& exec, Kokkos::View<CellChunk*, typename Exec::memory_space> const& chunks,
                    Kokkos::View<Index*, typename Exec::memory_space> const& first_element,
                    DeterminantOf const& determinant_of,
                    Kokkos::View<ChunkValidity*, typename Exec::memory_space> const& of_chunk) {
  visit_chunks(
      exec, "gridmorph::validity::elements", chunks, of_chunk,
      KOKKOS_LAMBDA(RowOfCells const& row, ChunkValidity& validity) {
        for (int n = 0; n < row.count; ++n) validity.take(determinant_of(first_element(row.zone) + row.i + n));
      });
}

template <class MemorySpace, class Validity>
struct ClearValidity {
  Kokkos::View<Validity, MemorySpace> of_mesh;
  KOKKOS_INLINE_FUNCTION void operator()(Index) const { of_mesh() = Validity{}; }
};

/// Joins the verdicts on all chunks into that on the mesh. Neither the smallest of some values nor the sum of whole
/// numbers depends on the order in which they come.
template <class MemorySpace, class Validity>
struct JoinChunks {
  Kokkos::View<ChunkValidity const*, MemorySpace> of_chunk;
  Kokkos::View<Validity, MemorySpace> of_mesh;

  [[nodiscard]] Index size() const { return Index(of_chunk.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index c) const {
    Kokkos::atomic_fetch_min(&of_mesh().smallest_determinant, of_chunk(c).smallest_determinant);
    Kokkos::atomic_add(&of_mesh().inverted, of_chunk(c).inverted);
  }
};

/// of_mesh: all chunks together.
template <class Exec, class Validity>
void join_chunks(Exec const& exec, Kokkos::View<ChunkValidity*, typename Exec::memory_space> const& of_chunk,
                 Kokkos::View<Validity, typename Exec::memory_space> const& of_mesh) {
  using MemorySpace = typename Exec::memory_space;
  launch("gridmorph::validity::begin", exec, 0, 1, ClearValidity<MemorySpace, Validity>{of_mesh});
  launch("gridmorph::validity::all", exec, JoinChunks<MemorySpace, Validity>{of_chunk, of_mesh});
}

}  // namespace gridmorph::kernels
