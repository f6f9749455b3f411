// Walks over the nodes of a zone range and over the node pairs of a link.
#pragma once

#include <gridmorph/topology/links.hpp>

namespace gridmorph {

/// Calls visit(node) for the nodes of a range, i fastest.
template <class Visit>
void for_each_node(Zone const& zone, IndexRange const& range, Visit&& visit) {
  for (int k = range.begin[2]; k < range.end[2]; ++k)
    for (int j = range.begin[1]; j < range.end[1]; ++j)
      for (int i = range.begin[0]; i < range.end[0]; ++i) visit(zone.node({i, j, k}));
}

/// Calls visit(own node, donor node) for the pairs of a link, i fastest.
template <class Visit>
void for_each_pair(Mesh const& mesh, Link const& link, Visit&& visit) {
  Zone const& own = mesh.zones[link.zone];
  Zone const& donor = mesh.zones[link.donor_zone];
  for_each_node(own, link.range, [&](Index n) { visit(n, donor.node(link.to_donor(own.index(n)))); });
}

}  // namespace gridmorph
