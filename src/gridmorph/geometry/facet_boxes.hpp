// The tree over facets.
#pragma once

#include <gridmorph/kernels/facet_tree.hpp>

#include <vector>

namespace gridmorph {

/// Boxes over the flat facets, and the order in which their leaves list them: order[n] is the facet at place n. Halved
/// along the longest side of the box of their centres, so that the depth is that of a balanced tree, whatever they are.
/// Depends on positions alone, ties on facet numbers. Cost O(n log n).
struct FacetBoxes {
  std::vector<FacetBox> boxes;
  std::vector<int> order;

  FacetBoxes(std::vector<Vec3> const& points, std::vector<Facet> const& facets);
};

}  // namespace gridmorph
