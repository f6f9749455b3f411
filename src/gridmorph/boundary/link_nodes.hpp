// Walks over the node pairs of a link.
#pragma once

#include <gridmorph/boundary/links.hpp>
#include <gridmorph/boundary/patch_points.hpp>

namespace gridmorph {

/// Calls visit(own node, donor node) for the pairs of a link, i fastest.
template <class Visit>
void for_each_pair(Mesh const& mesh, Link const& link, Visit&& visit) {
  Zone const& own = mesh.zones[link.zone];
  Zone const& donor = mesh.zones[link.donor_zone];
  for_each_node(own, link.range, [&](Index n) { visit(n, donor.node(link.to_donor(own.index(n)))); });
}

}  // namespace gridmorph
