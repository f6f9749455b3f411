// Nodes that interfaces declare to be the same point.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <vector>

namespace gridmorph {

/// For each node the smallest number among those that interfaces (periodic ones left out) declare to be the same point; its own
/// where there is none. Interfaces that cannot be are passed over. Cost: O(nodes).
std::vector<Index> coincident_block_nodes(Mesh const& mesh);

}  // namespace gridmorph
