// Which of many processes has which nodes of a mesh of blocks.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <vector>

namespace gridmorph {

/// Deals the cells of a mesh of blocks to n processes, to each about as many: the boxes of nodes of every process.
/// Every cell is in one box; two boxes that share a zone both have the nodes between them.
///
/// Zones follow one another along a Hilbert curve through their middles, so that a process has neighbours. Where it has
/// enough within a zone, this is cut across k or j, along whichever it has more cells, and across i only where there is
/// one cell along both: rows of nodes stay whole. Depends on the mesh alone. Throws ConfigError: n < 1, a mesh of
/// elements. Cost: O(zones log(zones) + n); coordinates of eight nodes per zone are read.
std::vector<std::vector<NodeBox>> deal_zones(BoundaryMesh const& mesh, int n);

}  // namespace gridmorph
