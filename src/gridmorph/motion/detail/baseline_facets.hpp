// The baseline mesh's own surface as facets: which patches make up one surface.
#pragma once

#include <gridmorph/boundary/boundary.hpp>

#include <vector>

namespace gridmorph {

/// Patches that go on into one another without a crease along most of the edges they share. Where two groups meet a
/// node is on both surfaces, so it stays on their edge. Cost O(n log n) in the nodes.
std::vector<std::vector<int>> smoothly_joined(Boundary const& boundary, std::vector<int> const& patches,
                                              FacetOptions const& options);

}  // namespace gridmorph
