// Patches and interfaces of blocks that were found among hexahedra.
#pragma once

#include <gridmorph/mesh/detail/hex_links.hpp>

#include <functional>

namespace gridmorph::detail {

/// Where the cells of a mesh lie in its blocks.
struct CellPlaces {
  std::function<int(Index32 cell)> block;
  std::function<Orientation(Index32 cell)> axes;  ///< of the cell's -> of the block's
  std::function<Index3 const&(Index32 cell)> at;
  std::function<Index3(Index32 cell, int corner)> node;
};

/// Adds to `blocks`, whose zones are there, the patches of the elements' boundary faces and the interfaces between
/// blocks, each in rectangles as large as they come, from the lowest indices on. Cost: cells at limits of blocks.
void add_block_sides(Mesh const& mesh, HexLinks const& links, BoundaryFacePatches const& face_patches,
                     CellPlaces const& places, Mesh& blocks);

}  // namespace gridmorph::detail
