// Displacements carried over between arrays, turned into the frame of the destination: ends of chains, known sides, and
// all copies of a node of the skeleton.
#pragma once

#include <gridmorph/kernels/field.hpp>
#include <gridmorph/kernels/launch.hpp>
#include <gridmorph/kernels/tile.hpp>
#include <gridmorph/kernels/vector_array.hpp>

namespace gridmorph::kernels {

/// A corner, edge or face of nodes: destination node (p, q) gets matrix * source node (p, q).
struct NodeCopy {
  Index source, source_stride_p, source_stride_q;
  Index destination, destination_stride_p, destination_stride_q;
  std::int32_t n_p, n_q;
  std::int32_t matrix;  ///< in the rotation table, -1 for the identity
};

/// x + u, and x bit for bit where u is zero of either sign: -0.0 + 0.0 would be +0.0, but -0.0 - (0.0 - u) is -0.0.
/// Without a comparison the loops over it vectorise.
KOKKOS_INLINE_FUNCTION double moved(double x, double u) { return x - (0.0 - u); }
KOKKOS_INLINE_FUNCTION Vec3 moved(Vec3 const& x, Vec3 const& u) {
  return {moved(x.x, u.x), moved(x.y, u.y), moved(x.z, u.z)};
}

/// One item per row of at most `Width` nodes of a copy. With `Move`, the destination gets baseline + matrix * source.
template <class MemorySpace, int Width, class Destination = Field<double>, bool Move = false>
struct CopyNodes {
  Kokkos::View<NodeCopy const*, MemorySpace> copies;
  Kokkos::View<Index const*, MemorySpace> first_item;  ///< per copy, and one past the last
  Kokkos::View<Mat3 const*, MemorySpace> matrices;
  Field<double const> source;
  Destination destination;
  VectorArray baseline = {};

  static Index items(NodeCopy const& c) { return tiles(c.n_p, Width) * c.n_q; }

  KOKKOS_INLINE_FUNCTION void operator()(Index item) const {
    int const entry = entry_of(first_item, item);
    NodeCopy const& copy = copies(entry);
    RowOfNodes const row = row_of_nodes<Width>(copy.n_p, item - first_item(entry));
    for (int p = row.begin; p < row.end; ++p) {
      Vec3 v = source[copy.source + p * copy.source_stride_p + row.q * copy.source_stride_q];
      if (copy.matrix >= 0) v = matrices(copy.matrix) * v;
      Index const to = copy.destination + p * copy.destination_stride_p + row.q * copy.destination_stride_q;
      if constexpr (Move) v = moved(baseline[to], v);
      destination.set(to, v);
    }
  }
};
/// Copies given displacements, each to its slot: u(slots(n)) = given(n).
template <class MemorySpace>
struct ScatterBoundary {
  Kokkos::View<Index const*, MemorySpace> slots;
  VectorArray given;
  Field<double> u;

  [[nodiscard]] Index size() const { return Index(slots.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const { u.set(slots(n), given[n]); }
};

template <class Exec>
void scatter_boundary(Exec const& exec, Kokkos::View<Index const*, typename Exec::memory_space> const& slots,
                      VectorArray const& given, Field<double> const& u) {
  launch("gridmorph::boundary", exec, ScatterBoundary<typename Exec::memory_space>{slots, given, u});
}

/// Copies values of nodes between arrays of the skeleton and of chains; `source` and `destination` may be the same
/// where no copy reads what another writes.
template <class Exec>
void copy_nodes(Exec const& exec, char const* label, TileList<NodeCopy, typename Exec::memory_space> const& copies,
                Kokkos::View<Mat3 const*, typename Exec::memory_space> const& matrices,
                Field<double const> const& source, Field<double> const& destination) {
  launch(label, exec, 0, copies.n_items,
         CopyNodes<typename Exec::memory_space, TileShape<Exec>::row>{copies.entries, copies.first_item, matrices,
                                                                      source, destination});
}

/// Copies values of the skeleton to the nodes of a mesh. With `Move`, they get baseline + matrix * source.
template <bool Move, class Exec>
void write_skeleton_nodes(Exec const& exec, TileList<NodeCopy, typename Exec::memory_space> const& copies,
                          Kokkos::View<Mat3 const*, typename Exec::memory_space> const& matrices,
                          Field<double const> const& source, VectorArray const& destination,
                          VectorArray const& baseline) {
  launch("gridmorph::skeleton_nodes", exec, 0, copies.n_items,
         CopyNodes<typename Exec::memory_space, TileShape<Exec>::row, VectorArray, Move>{
             copies.entries, copies.first_item, matrices, source, destination, baseline});
}

}  // namespace gridmorph::kernels
