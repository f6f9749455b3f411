// Walks over the node pairs of a link or an interface.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

namespace gridmorph {

/// Calls visit(own node, donor node) for the pairs of a link or an interface, i fastest.
template <class Connection, class Visit>
void for_each_pair(BoundaryMesh const& mesh, Connection const& c, Visit&& visit) {
  Zone const& own = mesh.zones[c.zone];
  Zone const& donor = mesh.zones[c.donor_zone];
  for (int k = c.range.begin[2]; k < c.range.end[2]; ++k)
    for (int j = c.range.begin[1]; j < c.range.end[1]; ++j)
      for (int i = c.range.begin[0]; i < c.range.end[0]; ++i)
        visit(own.node({i, j, k}), donor.node(c.to_donor(Index3{i, j, k})));
}

}  // namespace gridmorph
