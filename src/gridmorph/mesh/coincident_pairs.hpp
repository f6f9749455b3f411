// Nodes of different zones at the same place.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <functional>
#include <utility>
#include <vector>

namespace gridmorph {

/// All pairs (first < second) of the nodes given, each once in the list, that lie in different zones within `tolerance`
/// of each other; ascending. Cost O(n log n) while few nodes are that close along an oblique line.
std::vector<std::pair<Index, Index>> coincident_pairs(Coordinates const& coordinates, std::vector<Index> const& nodes,
                                                      std::function<int(Index node)> const& zone, double tolerance);

}  // namespace gridmorph
