// Gradients of copies, handed back to what they were copied from: the transposes of node_copy.hpp and slip_end.hpp.
//
// Cost: 24 bytes read per copy with 12 of tables, 24 written per source; per slip end 48 bytes, 144 of tables, and its
// surface once.
#pragma once

#include <gridmorph/kernels/field.hpp>
#include <gridmorph/kernels/launch.hpp>
#include <gridmorph/kernels/slip_end.hpp>
#include <gridmorph/kernels/transposed_slip.hpp>
#include <gridmorph/kernels/transposed_turns.hpp>

namespace gridmorph::kernels {

/// The copies of each source, those of entry n from first(n) on; matrix: of the copy, -1: none.
template <class MemorySpace>
struct CopiesOf {
  Kokkos::View<Index const*, MemorySpace> source, first, copy;
  Kokkos::View<std::int32_t const*, MemorySpace> matrix;
};

/// gradient(source) = or += the sum of matrix^T gradient(copy). One item per source.
template <class MemorySpace, bool Add, class Copies>
struct CopyBack {
  CopiesOf<MemorySpace> of;
  Kokkos::View<Mat3 const*, MemorySpace> matrices;
  Copies copies;
  Field<double> sources;

  [[nodiscard]] Index size() const { return Index(of.source.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const {
    Index const source = of.source(n);
    Vec3 sum = Add ? sources[source] : Vec3{};
    for (Index m = of.first(n); m < of.first(n + 1); ++m) {
      Vec3 const g = copies[of.copy(m)];
      sum += of.matrix(m) < 0 ? g : transpose(matrices(of.matrix(m))) * g;
    }
    sources.set(source, sum);
  }
};
template <bool Add, class Exec, class Copies>
void copy_back(char const* label, Exec const& exec, CopiesOf<typename Exec::memory_space> const& of,
               Kokkos::View<Mat3 const*, typename Exec::memory_space> const& matrices, Copies const& copies,
               Field<double> const& sources) {
  launch(label, exec, CopyBack<typename Exec::memory_space, Add, Copies>{of, matrices, copies, sources});
}

/// gradient(n) = that of the slot of boundary node n.
template <class MemorySpace>
struct GatherBoundary {
  Kokkos::View<Index const*, MemorySpace> slots;
  Field<double const> gradient;
  VectorArray out;

  [[nodiscard]] Index size() const { return Index(slots.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const { out.set(n, gradient[slots(n)]); }
};

/// Displacements of the ends of a pass, kept for its transpose: later passes change those of their slots.
template <class MemorySpace>
struct KeepSlipEnds {
  Kokkos::View<SlipEnd const*, MemorySpace> ends;
  Field<double const> u;
  Field<double> kept;  ///< per end

  [[nodiscard]] Index size() const { return Index(ends.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const { kept.set(n, u[ends(n).slot]); }
};

/// Gradient of the displacement of a slip end's slot, by way of its end value.
template <class MemorySpace>
struct SlipEndBySlot {
  SlipEndValues<MemorySpace, false> values;
  Field<double const> kept;      ///< per end
  Field<double const> gradient;  ///< of end values

  KOKKOS_INLINE_FUNCTION Vec3 operator()(Index item, Index) const {
    SlipEnd const& end = values.ends(item);
    SlipEndBaseline const& baseline = values.baselines(item);
    auto const surface = [&](int m) -> SlipSurfaceView const& { return values.surfaces(end.surface[m]); };
    auto const own = [&](int m) { return baseline.own_offset[m]; };
    int const count = end.surface[1] < 0 ? 1 : end.surface[2] < 0 ? 2 : 3;
    Vec3 const u = in_frame(end.to_node, kept[item]), g = back(end.to_chain, gradient[end.value]);
    return back(end.to_node, constrained_gradient(count, surface, own, baseline.position, u, g) - g);
  }

 private:
  KOKKOS_INLINE_FUNCTION Vec3 in_frame(std::int32_t matrix, Vec3 const& v) const {
    return matrix < 0 ? v : values.matrices(matrix) * v;
  }
  KOKKOS_INLINE_FUNCTION Vec3 back(std::int32_t matrix, Vec3 const& v) const {
    return matrix < 0 ? v : transpose(values.matrices(matrix)) * v;
  }
};

}  // namespace gridmorph::kernels
