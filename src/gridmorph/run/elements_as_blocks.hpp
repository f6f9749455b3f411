// Hexahedra of a file that are morphed as the blocks found among them.
#pragma once

#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/quality/indexed_mesh.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace gridmorph::cli {

/// Whether blocks can be found at all: hexahedra, or quadrilaterals in the plane, of first order and nothing else.
/// Cost: a look at the types.
bool may_have_blocks(Mesh const& elements);

/// The elements as the file has them, and the way from their blocks back to them.
class ElementsAsBlocks {
 public:
  /// Which grid lines will do. In a mesh that was paved, limits of blocks run through nearly every row of cells, and
  /// its elements are better off as elements when it is morphed.
  enum class Lines : std::uint8_t { any, long_ones };

  /// Takes the mesh out of `elements`, and what belongs to it as one of elements goes; where they are no blocks it
  /// leaves them as they are. Cost: find_blocks().
  ElementsAsBlocks(IndexedMesh&& elements, Lines lines);

  /// Why the elements are no blocks: which lies in none; empty where all lie in one.
  [[nodiscard]] std::string const& why_none() const { return why_none_; }

  /// The blocks, once; a note of theirs says how many there are.
  [[nodiscard]] Mesh take_blocks() { return std::move(blocks_); }
  [[nodiscard]] Mesh const& elements() const { return elements_; }
  /// (blocks) the zone that the elements of a block lie in; of those that have some in several zones the first one's.
  [[nodiscard]] std::vector<int> const& zone_of_block() const { return zone_of_block_; }

  /// What the file gets: nodes that are no corner of any element stay.
  [[nodiscard]] Coordinates coordinates(Coordinates const& of_blocks) const;
  [[nodiscard]] OutputFields fields(OutputFields const& of_blocks) const;

 private:
  Mesh elements_, blocks_;
  std::string why_none_;
  int across_ = -1;                  ///< the component of coordinates that meshes in the plane keep
  std::vector<Index32> node_;        ///< (blocks' nodes) the node of the elements, of those that are one the first
  std::vector<Index32> block_node_;  ///< (elements' nodes) a node of the blocks that lies there; -1: none
  std::vector<Index32> element_;     ///< (cells of the blocks)
  std::vector<int> zone_of_block_;
};

}  // namespace gridmorph::cli
