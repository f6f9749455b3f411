// What a guard moved nodes by, as a linear function of the boundary's displacement u:
//
//   a_d = sum over boundary nodes b of g_d(b) . u(b),    u(n) += sum over d of a_d s_d(n)
//
// The sum over the boundary runs over chunks of its nodes, one work item for each and d, then over the chunks in their
// order: the same bits for any number of threads. Points on slip surfaces go back onto them (slip_edge.hpp). A shift
// that is zero leaves the node's bits.
//
// Cost: 24 bytes of g and of u per boundary node and d; per node that moves 24 of s for each d, and 48 of its vector.
#pragma once

#include <gridmorph/kernels/field.hpp>
#include <gridmorph/kernels/launch.hpp>
#include <gridmorph/kernels/node_copy.hpp>
#include <gridmorph/kernels/slip_edge.hpp>
#include <gridmorph/kernels/vector_array.hpp>

namespace gridmorph::kernels {

constexpr Index amplitude_chunk = 256;  ///< boundary nodes

/// The part of a_d that chunk c has, for each item (d, c).
template <class MemorySpace>
struct PartialAmplitudes {
  Kokkos::View<Vec3 const*, MemorySpace> gauge;  ///< (n_modes, n_boundary)
  VectorArray boundary;
  Index n_boundary, n_chunks;
  double* partial;  ///< (n_modes, n_chunks)

  [[nodiscard]] Index size() const { return n_boundary > 0 ? Index(gauge.extent(0)) / n_boundary * n_chunks : 0; }
  KOKKOS_INLINE_FUNCTION void operator()(Index item) const {
    Index const d = item / n_chunks, first = (item - d * n_chunks) * amplitude_chunk;
    Index const end = first + amplitude_chunk < n_boundary ? first + amplitude_chunk : n_boundary;
    double sum = 0;
    for (Index b = first; b < end; ++b) sum += dot(gauge(d * n_boundary + b), boundary[b]);
    partial[item] = sum;
  }
};

/// Sums the amplitude a_d of item d from its parts.
struct SumAmplitudes {
  double const* partial;
  Index n_chunks;
  double* amplitude;
  KOKKOS_INLINE_FUNCTION void operator()(Index d) const {
    double sum = 0;
    for (Index c = 0; c < n_chunks; ++c) sum += partial[d * n_chunks + c];
    amplitude[d] = sum;
  }
};

/// sum over d of a_d s_d(item)
template <class MemorySpace>
struct ShiftOf {
  Kokkos::View<Vec3 const*, MemorySpace> shift;  ///< (items, n_modes)
  double const* amplitude;
  int n_modes;
  KOKKOS_INLINE_FUNCTION Vec3 operator()(Index item) const {
    Vec3 sum;
    for (int d = 0; d < n_modes; ++d) sum += amplitude[d] * shift(item * n_modes + d);
    return sum;
  }
};

template <class MemorySpace>
struct AddShifts {
  Kokkos::View<Index const*, MemorySpace> node;
  ShiftOf<MemorySpace> shift;
  VectorArray out;

  [[nodiscard]] Index size() const { return Index(node.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    if (Vec3 const s = shift(k); !(s == Vec3{})) out.set(node(k), moved(out[node(k)], s));
  }
};

/// A point of a mesh of blocks that slides: where its displacement is, and what it slides on in the frame of one of its
/// nodes.
struct SlidingShift {
  Index slot;               ///< of the skeleton
  Index node;               ///< in whose frame surfaces and shifts are
  std::int32_t to_node;     ///< frame of the slot -> that frame, -1: the same
  std::int32_t surface[3];  ///< those after the last are -1
  double own_offset[3];
  Vec3 position;  ///< of the node in the baseline
};

/// One of the nodes at a point that slides.
struct SlidingNode {
  Index node;
  std::int32_t slide;    ///< which point
  std::int32_t to_node;  ///< frame of the slot -> frame of this node, -1: the same
};

/// Adds the shifts of nodes that slide. Rate: `out` has rates, u changes by `rate` and the shift by that of
/// `rate_shift`.
template <class MemorySpace, bool Rate>
struct AddSlidingShifts {
  Kokkos::View<SlidingNode const*, MemorySpace> nodes;
  Kokkos::View<SlidingShift const*, MemorySpace> slides;
  Kokkos::View<SlipSurfaceView const*, MemorySpace> surfaces;
  Kokkos::View<Mat3 const*, MemorySpace> matrices;
  ShiftOf<MemorySpace> shift, rate_shift;
  Field<double const> u, rate;  ///< of the skeleton
  VectorArray out;

  [[nodiscard]] Index size() const { return Index(nodes.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    SlidingNode const& at = nodes(k);
    SlidingShift const& slide = slides(at.slide);
    Vec3 const s = shift(at.slide), s_rate = Rate ? rate_shift(at.slide) : Vec3{};
    if (s == Vec3{} && s_rate == Vec3{}) return;
    Vec3 const before = in_frame(slide.to_node, u[slide.slot]);
    Vec3 const rate_before = Rate ? in_frame(slide.to_node, rate[slide.slot]) : Vec3{};
    Vec3 wanted = before + s, wanted_rate = rate_before + s_rate;
    constrain(slide, wanted, wanted_rate);
    Vec3 const more = Rate ? wanted_rate - rate_before : wanted - before;
    Vec3 const of_slot = slide.to_node < 0 ? more : transpose(matrices(slide.to_node)) * more;
    out.set(at.node, moved(out[at.node], in_frame(at.to_node, of_slot)));
  }

  /// The rate with which a point that slides moves where what it is asked to does by `rate`, in the frame of
  /// SlidingShift::node.
  KOKKOS_INLINE_FUNCTION Vec3 rate_at(Index slide, Vec3 rate) const {
    Vec3 wanted = in_frame(slides(slide).to_node, u[slides(slide).slot]) + shift(slide);
    constrain(slides(slide), wanted, rate);
    return rate;
  }
  KOKKOS_INLINE_FUNCTION Vec3 in_frame(std::int32_t matrix, Vec3 const& v) const {
    return matrix < 0 ? v : matrices(matrix) * v;
  }

 private:
  KOKKOS_INLINE_FUNCTION void constrain(SlidingShift const& slide, Vec3& wanted, Vec3& rate) const {
    int const count = slide.surface[1] < 0 ? 1 : slide.surface[2] < 0 ? 2 : 3;
    constrain_to_all<Rate>(
        count, [&](int m) -> SlipSurfaceView const& { return surfaces(slide.surface[m]); },
        [&](int m) { return slide.own_offset[m]; }, slide.position, wanted, rate);
  }
};

}  // namespace gridmorph::kernels
