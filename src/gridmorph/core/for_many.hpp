// A loop for host code that does not know whether its work is small or large; internal.
#pragma once

#include <gridmorph/core/for_all.hpp>

#include <string>

namespace gridmorph::detail {

inline constexpr Index many = 1000;  ///< calls that are worth the start of a loop on all cores

/// for_all(), but on the calling thread alone where there are too few to be shared out. Calls cost 50 nanoseconds or
/// more each.
template <class Function>
void for_many(HostInstance const& host, std::string const& label, Index count, Function const& f) {
  if (count >= many) return for_all(host, label, count, f);
  for (Index n = 0; n < count; ++n) f(n);
}
/// The same on the default instance where Kokkos runs: surfaces and motions may be made before it does.
template <class Function>
void for_many(std::string const& label, Index count, Function const& f) {
  if (count >= many && Kokkos::is_initialized()) return for_all(HostInstance(), label, count, f);
  for (Index n = 0; n < count; ++n) f(n);
}

}  // namespace gridmorph::detail
