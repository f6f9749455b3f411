// What chains whose ends turn need besides: where their ends, sides and lines of the near field are in the baseline.
#pragma once

#include <gridmorph/plan/blocks/stage_builder.hpp>

namespace gridmorph {

/// Positions of the ends and known sides of chain `number` of a stage, in the chain's frame. Its ends turn about
/// themselves.
void add_turn_positions(PlanContext const& context, Chain const& chain, ChainLayout const& layout, int number,
                        Stage& stage);

/// The lines of a near field's chain, each with the root that it stands on.
void add_near_field_lines(PlanContext const& context, Chain const& chain, ChainLayout const& layout, int number,
                          Stage& stage);

/// Leaves out the outer edges of near fields that make no share of the turn: those fields have one end that turns.
void leave_out_outer_edges_at_rest(WallRoots const& roots, Stage& stage);

}  // namespace gridmorph
