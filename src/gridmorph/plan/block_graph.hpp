// The blocks of a plan, what joins them, and the chains through them in their order: what a drawing of a plan shows.
#pragma once

#include <gridmorph/plan/prepare.hpp>

#include <array>
#include <string>
#include <vector>

namespace gridmorph {

struct BlockGraph {
  struct Block {
    std::string name;     ///< zone and nodes of its first piece, 1-based
    int other_zones = 0;  ///< number of zones that it has pieces in besides
    Index cells = 0;
    int chain = -1;  ///< number of the chain that moves it; -1: a rule does, as in regions
    std::vector<std::string>
        patches;  ///< on its outer faces: families, or names where there is none; in alphabetical order
  };
  /// Blocks that have faces in common, a < b, or a == b where a block closes on itself.
  struct Interface {
    int a = -1, b = -1;
    bool periodic = false;
    Index faces = 0;  ///< of cells
  };
  struct Chain {
    int stage = 0;                    ///< in `stages`
    int number = 1;                   ///< in its stage, from 1 on
    std::vector<int> blocks;          ///< from its first end to the last
    std::array<std::string, 2> ends;  ///< ChainPath::ends
    std::string reason;               ///< Stage::description
  };

  std::vector<Block> blocks;
  std::vector<Interface> interfaces;
  std::vector<std::string> stages;  ///< names of stages_of() that have chains of blocks, in order
  std::vector<Chain> chains;        ///< stage by stage
};

/// The graph of the blocks of a prepared morph. Blocks are found once more: O(blocks), and what near fields by
/// thickness read of the mesh.
BlockGraph block_graph(PreparedMorph const& prepared);

}  // namespace gridmorph
