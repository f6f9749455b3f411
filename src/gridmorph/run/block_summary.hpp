// The blocks that plans are made on, before any motion is known: for inspect.
#pragma once

#include <gridmorph/boundary/links.hpp>
#include <gridmorph/mesh/mesh.hpp>

#include <array>
#include <string>
#include <vector>

namespace gridmorph::cli {

struct BlockSummary {
  Index3 extent{};    ///< nodes along the block's own i, j, k (its first piece's)
  std::string where;  ///< "zone 'Zone 1' [1:13, 1:48, 1:20]", its first piece
  int pieces = 0;
  std::array<std::string, 6> faces;  ///< what is on i_min ... k_max: patch, "periodic NAME", or "block N" (1-based)
};

struct BlocksSummary {
  int pieces = 0;
  std::vector<BlockSummary> blocks;
};

/// Cuts and merges with one label per selector of a case file (`label_of_patch`). `mesh` must be connected and covered.
BlocksSummary summarize_blocks(Mesh const& mesh, Links const& links, std::vector<int> const& label_of_patch);

}  // namespace gridmorph::cli
