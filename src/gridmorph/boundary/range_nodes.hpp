// Nodes of index ranges.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

namespace gridmorph {

/// Calls f(flat node number) for the nodes of a range of a block, i fastest.
template <class F>
void for_each_node(Zone const& zone, IndexRange const& range, F const& f) {
  for (int k = range.begin[2]; k < range.end[2]; ++k)
    for (int j = range.begin[1]; j < range.end[1]; ++j)
      for (int i = range.begin[0]; i < range.end[0]; ++i) f(zone.node({i, j, k}));
}

/// Whether two ranges of one block have nodes in common.
inline bool overlap(IndexRange const& a, IndexRange const& b) {
  for (int d = 0; d < 3; ++d)
    if (a.begin[d] >= b.end[d] || b.begin[d] >= a.end[d]) return false;
  return true;
}

}  // namespace gridmorph
