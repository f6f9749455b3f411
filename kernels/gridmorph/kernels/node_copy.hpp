// Displacements between coincident nodes: from the one that was computed to all its copies, turned into their frames.
#pragma once

#include <gridmorph/kernels/field.hpp>

namespace gridmorph::kernels {

/// A corner, edge or face of nodes: destination node (p, q) gets matrix * source node (p, q).
struct NodeCopy {
  Index source, source_stride_p, source_stride_q;
  Index destination, destination_stride_p, destination_stride_q;
  std::int32_t n_p, n_q;
  std::int32_t matrix;  ///< in the rotation table, -1 for the identity
};

template <class MemorySpace>
struct CopyNodes {
  Kokkos::View<NodeCopy const*, MemorySpace> copies;
  Kokkos::View<Index const*, MemorySpace> first_item;  ///< per copy, and one past the last
  Kokkos::View<Mat3 const*, MemorySpace> matrices;
  Field<double> u;

  KOKKOS_INLINE_FUNCTION void operator()(Index item) const {
    int lo = 0, hi = int(copies.extent(0));
    while (hi - lo > 1) {
      int const mid = (lo + hi) / 2;
      if (first_item(mid) <= item) {
        lo = mid;
      } else {
        hi = mid;
      }
    }
    NodeCopy const& copy = copies(lo);
    Index const local = item - first_item(lo);
    Index const p = local % copy.n_p, q = local / copy.n_p;
    Vec3 const v = u[copy.source + p * copy.source_stride_p + q * copy.source_stride_q];
    u.set(copy.destination + p * copy.destination_stride_p + q * copy.destination_stride_q,
          copy.matrix < 0 ? v : matrices(copy.matrix) * v);
  }
};

}  // namespace gridmorph::kernels
