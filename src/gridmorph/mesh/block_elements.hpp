// Blocks as elements: what as_hexahedra() makes of a mesh, and readers of the blocks that stand beside zones of
// elements.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

namespace gridmorph {

/// Appends the cells of a block to the last zone of the mesh, i fastest: hexahedra, or quadrilaterals where the block
/// has one node along a direction. The numbers of the nodes are the block's. Left-handed blocks (more cells of negative
/// than of positive volume, or area about plane_normal()) are turned: bottom for top, or back to front. `coordinates`:
/// those of the block at least.
void add_cells(Mesh& mesh, Zone const& block, Coordinates const& coordinates);

/// Appends the quadrilaterals of a range of nodes on a face of a block, or the edges where the block has one node along
/// a direction. What the range has beyond the block is passed over (the second plane of a 2-D mesh that the block does
/// not have).
void add_faces(Zone const& block, IndexRange const& range, CsrGraph& faces);

/// A patch of a block as one of elements: faces instead of the range.
Patch as_faces(Mesh const& mesh, Patch patch);

/// The nodes that an interface joins, one by one; nodes beyond the block are passed over likewise.
Connection node_pairs(Mesh const& mesh, Interface1to1 const& face);

}  // namespace gridmorph
