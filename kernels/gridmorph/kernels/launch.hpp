// How kernels are launched: one function for all of them.
#pragma once

#include <gridmorph/kernels/grid_line.hpp>

#include <Kokkos_Core.hpp>

namespace gridmorph::kernels {

/// Enqueues kernel(begin) ... kernel(end - 1) on an instance; nothing where there are none.
template <class Exec, class Kernel>
void launch(char const* label, Exec const& exec, Index begin, Index end, Kernel const& kernel) {
  if (begin < end)
    Kokkos::parallel_for(label, Kokkos::RangePolicy<Exec, Kokkos::IndexType<Index>>(exec, begin, end), kernel);
}

/// Enqueues all items of a kernel that counts them itself.
template <class Exec, class Kernel>
void launch(char const* label, Exec const& exec, Kernel const& kernel) {
  launch(label, exec, 0, kernel.size(), kernel);
}

}  // namespace gridmorph::kernels
