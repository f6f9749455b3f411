// Host lists in the memory of an execution space.
#pragma once

#include <Kokkos_Core.hpp>

#include <string>
#include <vector>

namespace gridmorph::detail {

/// A copy of the list, enqueued: the list must stay until the instance has been fenced.
template <class Exec, class T>
Kokkos::View<T*, typename Exec::memory_space> enqueue_copy(Exec const& exec, std::vector<T> const& host,
                                                           std::string const& label) {
  Kokkos::View<T*, typename Exec::memory_space> const device(
      Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, label), host.size());
  Kokkos::View<T const*, Kokkos::HostSpace, Kokkos::MemoryTraits<Kokkos::Unmanaged>> const from(host.data(),
                                                                                                host.size());
  if (!host.empty()) Kokkos::deep_copy(exec, device, from);
  return device;
}

}  // namespace gridmorph::detail
