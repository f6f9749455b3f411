// How kernels are launched: one function for all of them.
#pragma once

#include <gridmorph/kernels/grid_line.hpp>
#include <gridmorph/kernels/instruction_sets.hpp>
#include <gridmorph/kernels/tile.hpp>

#include <Kokkos_Core.hpp>

namespace gridmorph::kernels {

/// Enqueues kernel(begin) ... kernel(end - 1) on an instance; nothing where there are none. On the host kernels that
/// ask for it run by the widest instruction set that the machine has (instruction_sets.hpp).
template <class Exec, class Kernel>
void launch(char const* label, Exec const& exec, Index begin, Index end, Kernel const& kernel) {
  if (begin >= end) return;
  Kokkos::RangePolicy<Exec, Kokkos::IndexType<Index>> const policy(exec, begin, end);
  if constexpr (TileShape<Exec>::host)
    with_instruction_set(kernel, [&](auto const& copy) { Kokkos::parallel_for(label, policy, copy); });
  else
    Kokkos::parallel_for(label, policy, kernel);
}

/// Enqueues all items of a kernel that counts them itself.
template <class Exec, class Kernel>
void launch(char const* label, Exec const& exec, Kernel const& kernel) {
  launch(label, exec, 0, kernel.size(), kernel);
}

}  // namespace gridmorph::kernels
