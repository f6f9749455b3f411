// Transpose of what a guard moved nodes by (frozen_shifts.hpp): gradients of nodes, to those of the boundary's
// displacement
//
//   dJ/da_d = sum over nodes of s_d . g,    dJ/du(b) += sum over d of dJ/da_d g_d(b)
//
// and where nodes slide also to the slots of the skeleton that they start from. Sums by chunks, in one order. Costs as
// forwards, with three rates of the surfaces per node that slides.
#pragma once

#include <gridmorph/kernels/frozen_shifts.hpp>

namespace gridmorph::kernels {

/// The gradients of nodes that slide: what is handed to their shift, in the frame of SlidingShift::node, and to their
/// slot, in its own.
template <class MemorySpace>
struct SlidingShiftsBack {
  AddSlidingShifts<MemorySpace, true> forwards;
  VectorArray gradient;
  Vec3* of_shift;
  Field<double> of_slot;

  [[nodiscard]] Index size() const { return forwards.size(); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    SlidingNode const& at = forwards.nodes(k);
    SlidingShift const& slide = forwards.slides(at.slide);
    auto const back = [&](std::int32_t matrix, Vec3 const& v) {
      return matrix < 0 ? v : transpose(forwards.matrices(matrix)) * v;
    };
    Vec3 const more = forwards.in_frame(slide.to_node, back(at.to_node, gradient[at.node]));
    auto const along = [&](Vec3 const& direction) { return dot(forwards.rate_at(at.slide, direction), more); };
    Vec3 const wanted{along({1, 0, 0}), along({0, 1, 0}), along({0, 0, 1})};
    of_shift[k] = wanted;
    of_slot.set(k, back(slide.to_node, wanted - more));
  }
};

/// The part of dJ/da_d that chunk c has, for each item (d, c): of the nodes that move in space and then of those that
/// slide.
template <class MemorySpace>
struct PartialShiftGradients {
  Kokkos::View<Index const*, MemorySpace> node;
  Kokkos::View<Vec3 const*, MemorySpace> shift;  ///< (node, n_modes)
  Kokkos::View<SlidingNode const*, MemorySpace> sliding;
  Kokkos::View<Vec3 const*, MemorySpace> slide_shift;  ///< (slides, n_modes)
  VectorArray gradient;
  Vec3 const* of_shift;
  Index n_modes, n_chunks;
  double* partial;  ///< (n_modes, n_chunks)

  [[nodiscard]] Index size() const { return n_modes * n_chunks; }
  KOKKOS_INLINE_FUNCTION void operator()(Index item) const {
    Index const d = item / n_chunks, first = (item - d * n_chunks) * amplitude_chunk;
    Index const n = Index(node.extent(0)), n_all = n + Index(sliding.extent(0));
    Index const end = first + amplitude_chunk < n_all ? first + amplitude_chunk : n_all;
    double sum = 0;
    for (Index k = first; k < end; ++k)
      sum += k < n ? dot(shift(k * n_modes + d), gradient[node(k)])
                   : dot(slide_shift(sliding(k - n).slide * n_modes + d), of_shift[k - n]);
    partial[item] = sum;
  }
};

/// out(b) += sum over d of amplitude_d gauge_d(b).
template <class MemorySpace>
struct AddGauges {
  Kokkos::View<Vec3 const*, MemorySpace> gauge;  ///< (n_modes, n_boundary)
  double const* amplitude;
  Index n_boundary;
  int n_modes;
  VectorArray out;
  KOKKOS_INLINE_FUNCTION void operator()(Index b) const {
    Vec3 sum = out[b];
    for (int d = 0; d < n_modes; ++d) sum += amplitude[d] * gauge(d * n_boundary + b);
    out.set(b, sum);
  }
};

}  // namespace gridmorph::kernels
