// Facets of patches that know the side which the mesh is on, wherever a morph takes them.
#pragma once

#include <gridmorph/boundary/boundary.hpp>

#include <vector>

namespace gridmorph {

/// Facets by nodes of the mesh. Lines, in the boundary of a 2-D mesh of elements, become strips across their plane,
/// which lies in their middle.
class InwardFacets {
 public:
  InwardFacets() = default;
  /// Nodes that coincide are one. Cost O(nodes of the patches).
  InwardFacets(Boundary const& boundary, std::vector<int> const& patches);

  /// Where the nodes of the mesh are at `x`; right-handed about normals into the mesh.
  [[nodiscard]] FacetList at(Coordinates const& x) const;

 private:
  std::vector<Index> nodes_;
  std::vector<GridFacet> facets_;  ///< places in `nodes_`; of lines two, then -1
  Vec3 across_;                    ///< of lines: half of a strip
};

}  // namespace gridmorph
