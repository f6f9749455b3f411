// Blocks of grid lines in a mesh of hexahedra, or quadrilaterals in the plane, whose file does not say that it has any.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>

#include <string>
#include <vector>

namespace gridmorph {

/// Blocks with what leads back to the elements that they were found in.
struct FoundBlocks {
  Mesh mesh;  ///< blocks "block 1", "block 2", ... with patches as ranges and 1-to-1 interfaces, periodic ones too
  /// (mesh.n_nodes()) the node of the elements at each node of the blocks; in the plane also of the second plane, which
  /// the blocks have as readers give it to them.
  std::vector<Index32> node;
  std::vector<Index32> in_blocks;  ///< (nodes of the elements) a node of the blocks at its place; -1: none
  std::vector<Index32> element;    ///< (mesh.n_cells()) the element that each cell is, block after block, i fastest
  Index n_left = 0;                ///< elements that lie in no block; these are then not in `mesh`
  std::string why_left;  ///< of the first of them: what it is, or what about it is no block; empty where none is
};

/// Finds the blocks of a mesh of hexahedra, or of quadrilaterals in the plane.
///
/// An edge inside that four cells share, or one on the boundary that one cell has or two, is regular; grid lines go
/// through it. From all others sheets of faces begin, each face going on in the one opposite at the next regular edge,
/// to the boundary or back to where they began: they are the limits of blocks (D. Bommes, T. Lempfer, L. Kobbelt,
/// Comput. Graph. Forum 30 (2011) 375, section 2; the base complex). What hangs together without crossing a sheet is a
/// block where the indices i, j, k carried from cell to cell fill a box; what closes on itself, as an O grid does, is
/// cut along a sheet of its own. Nodes that connections declare to be one are one. Nothing is guessed from places:
/// other numbers, orders and orientations of the elements give the same blocks.
///
/// Elements of other types lie in no block. The cost is linear; memory: about 60 bytes per element beside the blocks.
FoundBlocks find_blocks(HostInstance const& host, Mesh const& mesh, UnstructuredTopology const& topology,
                        BoundaryFacePatches const& face_patches);

}  // namespace gridmorph
