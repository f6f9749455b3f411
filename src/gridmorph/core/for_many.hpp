// A loop for host code that does not know whether its work is small or large; internal.
#pragma once

#include <gridmorph/core/for_all.hpp>

#include <string>

namespace gridmorph::detail {

/// for_all(), but on the calling thread alone where there are too few to be shared out. Calls cost 50 nanoseconds or
/// more each.
template <class Function>
void for_many(HostInstance const& host, std::string const& label, Index count, Function const& f) {
  constexpr Index many = 1000;
  if (count >= many) return for_all(host, label, count, f);
  for (Index n = 0; n < count; ++n) f(n);
}

}  // namespace gridmorph::detail
