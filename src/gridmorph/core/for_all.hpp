// A loop over an instance of the host, for host code; internal.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/core/index.hpp>
#include <gridmorph/kernels/kokkos_compat.hpp>

#include <Kokkos_Core.hpp>

#include <string>
#include <type_traits>

namespace gridmorph::detail {

/// Calls f(n) for 0 <= n < count on the instance, and waits; f writes nothing that another n writes. In equal shares, for
/// small work.
template <class Function>
void for_all(HostInstance const& host, std::string const& label, Index count, Function const& f) {
  host.visit([&](auto const& exec) {
    using Exec = std::decay_t<decltype(exec)>;
    Kokkos::parallel_for(label, Kokkos::RangePolicy<Exec, Kokkos::IndexType<Index>>(exec, 0, count), f);
    compat::fence(exec, (label + " (read by the host)").c_str());
  });
}

/// The same one by one as cores become free, for large work.
template <class Function>
void for_all_parts(HostInstance const& host, std::string const& label, Index count, Function const& f) {
  host.visit([&](auto const& exec) {
    using Exec = std::decay_t<decltype(exec)>;
    using Policy = Kokkos::RangePolicy<Exec, Kokkos::IndexType<Index>, Kokkos::Schedule<Kokkos::Dynamic>>;
    Kokkos::parallel_for(label, Policy(exec, 0, count, Kokkos::ChunkSize(1)), f);
    compat::fence(exec, (label + " (read by the host)").c_str());
  });
}

}  // namespace gridmorph::detail
