// Which chains of blocks are morphed one after another.
#pragma once

#include <gridmorph/plan/options.hpp>

#include <optional>
#include <vector>

namespace gridmorph {

/// A chain by one of its blocks and the axis of that along which it runs. Blocks are numbered by the topology of a mesh
/// and its rules.
struct ChainPlace {
  int block = -1;
  int axis = 0;
  std::optional<Law> law = {};  ///< nothing: as the options say
  auto operator<=>(ChainPlace const&) const = default;
};

/// What decides which of the chains that can be next come first.
enum class ChainChoice {
  rules,         ///< VolumeOptions::priority
  sharp_first,   ///< the smallest angle of their cells, the smallest first
  blunt_first,   ///< the same angle, the largest first
  short_first,   ///< their length over their width, the smallest first
  long_first,    ///< their length over their width, the largest first
  few_blocks,    ///< the number of blocks they run through, the fewest first
  many_blocks,   ///< the number of blocks they run through, the most first
  weakest_ends,  ///< ranks of their ends, the last ones first
};

/// Stages of chains in order, those of the near field left out.
using ChainOrder = std::vector<std::vector<ChainPlace>>;

}  // namespace gridmorph
