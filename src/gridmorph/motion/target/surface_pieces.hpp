// Pieces of a surface of facets between lines that cut it.
#pragma once

#include <gridmorph/boundary/patch_surface.hpp>

#include <set>
#include <utility>
#include <vector>

namespace gridmorph {

/// The number of the piece that each facet belongs to: facets that share an edge belong together unless the edge is
/// among `cuts` (smaller vertex first). Numbered in the order of their first facets. Cost O(facets log facets).
std::vector<int> pieces_between(std::vector<GridFacet> const& facets, std::set<std::pair<int, int>> const& cuts);

}  // namespace gridmorph
