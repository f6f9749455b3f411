// What lies beyond periodic connections.
#pragma once

#include <gridmorph/boundary/boundary.hpp>

#include <vector>

namespace gridmorph {

/// Where the periodic connections that touch patches carry these, one pitch either way, each copy once. Transforms are
/// those of Boundary::periodic_transforms(). Cost O(nodes of the patches) per connection.
std::vector<RigidTransform> periodic_copies(Boundary const& boundary, std::vector<int> const& patches);

/// Patches of zones that hang together by connections, and where the periodic ones among these carry them, whether or
/// not they touch these patches.
struct PatchesOfRow {
  std::vector<int> patches;
  std::vector<RigidTransform> copies;
};
std::vector<PatchesOfRow> patches_by_row(Boundary const& boundary, std::vector<int> const& patches);

/// Facets and their copies.
FacetList with_copies(FacetList const& own, std::vector<RigidTransform> const& copies);

}  // namespace gridmorph
