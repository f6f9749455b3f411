// Nodes that interfaces declare to be the same point.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <vector>

namespace gridmorph {

/// For each node the smallest number among those that interfaces (periodic ones left out) declare to be the same point;
/// its own where there is none. Interfaces that cannot be are passed over. Cost: O(nodes).
std::vector<Index> coincident_block_nodes(Mesh const& mesh);

/// For each node the smallest number among those at its place in a mesh of either kind, with nodes joined that periodic
/// interfaces and connections take onto each other: `one` has the smallest number of each place. Cost: O(nodes).
std::vector<Index> nodes_joined_across_periodic_sides(Mesh const& mesh, std::vector<Index> one);

}  // namespace gridmorph
