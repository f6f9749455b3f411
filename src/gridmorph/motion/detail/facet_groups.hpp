// The baseline mesh's own surface as facets: which patches make up one surface, and the planes that a patch lies on
// where it lies on several.
#pragma once

#include <gridmorph/boundary/boundary.hpp>

#include <vector>

namespace gridmorph {

/// Patches that go on into one another without a crease along most of the edges they share. Where two groups meet a
/// node is on both surfaces, so it stays on their edge. Cost O(n log n) in the nodes.
std::vector<std::vector<int>> smoothly_joined(Boundary const& boundary, std::vector<int> const& patches,
                                              FacetOptions const& options);

/// Nodes of a patch of elements, ascending, by pieces: faces (lines, in a plane mesh) that share an edge (a node)
/// belong together where they are within 30 degrees of one another; whether a piece is a plane is the caller's to see.
/// Nodes where pieces meet are in each of them. Pieces in the order of their first faces; none of patches of blocks,
/// whose faces are grids. Cost O(faces log faces).
std::vector<std::vector<Index>> flat_pieces(Boundary const& boundary, int patch);

}  // namespace gridmorph
