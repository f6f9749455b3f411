// Which chains of blocks are morphed one after another.
#pragma once

#include <gridmorph/plan/options.hpp>

#include <optional>
#include <vector>

namespace gridmorph {

/// A chain by one of its blocks and the axis of that along which it runs. Blocks are numbered by the topology of a mesh and its rules.
struct ChainPlace {
  int block = -1;
  int axis = 0;
  std::optional<Law> law = {};  ///< nothing: as the options say
  friend auto operator<=>(ChainPlace const&, ChainPlace const&) = default;
};

/// Stages of chains in order, those of the near field left out.
using ChainOrder = std::vector<std::vector<ChainPlace>>;

}  // namespace gridmorph
