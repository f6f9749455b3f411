// Rows of an InterpolationOperator made on all threads; internal.
#pragma once

#include <gridmorph/core/for_all.hpp>
#include <gridmorph/plan/interpolation_operator.hpp>

#include <algorithm>
#include <span>
#include <string>
#include <vector>

namespace gridmorph {

/// The rows of several operators as one, one after another.
InterpolationOperator joined(HostInstance const& host, std::span<InterpolationOperator const> parts);
/// The rows that `order` names.
InterpolationOperator gathered(HostInstance const& host, InterpolationOperator const& rows,
                               std::span<Index const> order);

/// The rows that make(k, rows) adds for 0 <= k < count, in this order whatever the number of threads is. Every part
/// calls a copy of `make`, which may keep room of its own. Cost besides: rows are copied once.
template <class Make>
InterpolationOperator make_rows(HostInstance const& host, std::string const& label, Index count, Make const& make) {
  constexpr Index part = 512;
  std::vector<InterpolationOperator> parts((count + part - 1) / part);
  detail::for_all_parts(host, label, std::ssize(parts), [&](Index p) {
    auto own = make;  // with its own room
    for (Index k = p * part; k < std::min(count, (p + 1) * part); ++k) own(k, parts[p]);
  });
  return joined(host, parts);
}

}  // namespace gridmorph
