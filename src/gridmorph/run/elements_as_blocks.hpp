// Hexahedra of a file that are morphed as the blocks found among them.
#pragma once

#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/mesh/mesh.hpp>

#include <vector>

namespace gridmorph::cli {

/// The elements as the file has them, and the way from their blocks back to them.
class ElementsAsBlocks {
 public:
  /// Throws MeshError where an element lies in no block, and says which.
  explicit ElementsAsBlocks(Mesh elements);

  /// The blocks, once; a note of theirs says how many there are.
  [[nodiscard]] Mesh take_blocks() { return std::move(blocks_); }
  [[nodiscard]] Mesh const& elements() const { return elements_; }

  /// What the file gets: nodes that are no corner of any element stay.
  [[nodiscard]] Coordinates coordinates(Coordinates const& of_blocks) const;
  [[nodiscard]] OutputFields fields(OutputFields const& of_blocks) const;

 private:
  Mesh elements_, blocks_;
  std::vector<Index32> representative_;  ///< coincident_nodes() of the elements
  std::vector<Index32> block_node_;      ///< (elements' nodes) a node of the blocks that lies there; -1: none
  std::vector<Index32> element_;         ///< (cells of the blocks)
};

}  // namespace gridmorph::cli
