// Coordinates of nodes that other ranks have; internal.
#pragma once

#include <gridmorph/mesh/distribution.hpp>
#include <gridmorph/mesh/mesh.hpp>

#include <span>

namespace gridmorph {

/// The coordinates of the nodes of all boxes, box after box, i fastest, each from its home. `own` (n_nodes() of the
/// distribution) are those of the rank's parts. Collective; each rank names its own boxes, or none.
///
/// Throws MeshError, on all ranks: a box that leaves its zone, coordinates that are not those of the parts.
/// Cost: one sparse exchange each way, of 28 bytes per box that is divided among homes and 24 per node that another
/// rank has. Memory beside the result: 24 bytes per node that goes or comes.
[[nodiscard]] Coordinates fetch_nodes(Distribution const& distribution, Coordinates const& own,
                                      std::span<NodeBox const> boxes);

}  // namespace gridmorph
