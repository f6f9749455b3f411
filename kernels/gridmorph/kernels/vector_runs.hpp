// Kernels that compute vectors for items one after another: what the items share is made once, and vectors are one
// register each where the instruction set of a copy has registers for them (packed_vec3.hpp, instruction_sets.hpp).
#pragma once

#include <gridmorph/kernels/launch.hpp>
#include <gridmorph/kernels/packed_vec3.hpp>

namespace gridmorph::kernels {

/// kernel.run<V>(begin, end) computes items begin <= n < end, the same bits for every V.
template <class Kernel>
concept ComputesRuns = requires(Kernel const& kernel) {
  kernel.template run<Vec3>(Index(), Index());
};

/// Work items of such a kernel.
template <class Kernel, class V, int length>
struct RunPerItem {
  Kernel kernel;
  Index begin, end;

  KOKKOS_INLINE_FUNCTION void operator()(Index item) const {
    Index const from = begin + item * length, to = from + length;
    kernel.template run<V>(from, to < end ? to : end);
  }
};

/// Enqueues items begin <= n < end of a kernel that computes runs of them.
template <class Exec, ComputesRuns Kernel>
void launch(char const* label, Exec const& exec, Index begin, Index end, Kernel const& kernel) {
  using Shape = TileShape<Exec>;
  Index const n_runs = tiles(end - begin, Shape::row);
#ifdef GRIDMORPH_TWO_INSTRUCTION_SETS
  if (Shape::host && uses_avx2())
    return launch(label, exec, 0, n_runs, ByAvx2<RunPerItem<Kernel, WideVec3, Shape::row>>{{kernel, begin, end}});
#endif
  launch(label, exec, 0, n_runs, RunPerItem<Kernel, NativeVec3, Shape::row>{kernel, begin, end});
}

}  // namespace gridmorph::kernels
