// A loop over all cores for host code; internal.
#pragma once

#include <gridmorph/core/index.hpp>
#include <gridmorph/kernels/kokkos_compat.hpp>

#include <Kokkos_Core.hpp>

#include <string>

namespace gridmorph::detail {

/// Calls f(n) for 0 <= n < count on the default host execution space, and waits; f writes nothing that another n writes. In
/// equal shares, for small work.
template <class Function>
void for_all(std::string const& label, Index count, Function const& f) {
  using Exec = Kokkos::DefaultHostExecutionSpace;
  Exec const exec;
  Kokkos::parallel_for(label, Kokkos::RangePolicy<Exec, Kokkos::IndexType<Index>>(exec, 0, count), f);
  compat::fence(exec, (label + " (read by the host)").c_str());
}

/// The same one by one as cores become free, for large work.
template <class Function>
void for_all_parts(std::string const& label, Index count, Function const& f) {
  using Exec = Kokkos::DefaultHostExecutionSpace;
  using Policy = Kokkos::RangePolicy<Exec, Kokkos::IndexType<Index>, Kokkos::Schedule<Kokkos::Dynamic>>;
  Exec const exec;
  Kokkos::parallel_for(label, Policy(exec, 0, count, Kokkos::ChunkSize(1)), f);
  compat::fence(exec, (label + " (read by the host)").c_str());
}

}  // namespace gridmorph::detail
