// Host tables of the transfinite correction of one chain.
#pragma once

#include <gridmorph/plan/blocks/chain_tables.hpp>

namespace gridmorph {

/// Appends the side tables of chain number `number` (the last in stage.lines) when any of its sides, or an edge or
/// corner on them, is known; leaves the chain a plain sweep otherwise. Cost: O(nodes on the chain's surface).
void add_side_tables(PlanContext const& context, Chain const& chain, ChainLayout const& layout, Known const& known,
                     int number, Stage& stage);

}  // namespace gridmorph
