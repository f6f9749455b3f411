// A morph of blocks stopped after each of its stages (paper, Figures 12 and 13).
#pragma once

#include <gridmorph/plan/first_stages.hpp>

#include <functional>
#include <span>

namespace gridmorph {

/// Calls visit(done, positions) for every stage of the plan in their order, with all nodes [length] as they are then:
/// those that it and the stages before have reached are where they belong, all others where the baseline has them. The
/// last one is the morph itself, bit for bit. boundary: displacements of Plan::boundary_nodes [length].
///
/// Cost: a copy of the plan, a Morpher and a morph per stage; memory for one of each. Morphers that are there already
/// are not touched.
void morph_stage_by_stage(Plan const& plan, Coordinates const& baseline, std::span<Vec3 const> boundary,
                          std::function<void(StagesDone const&, Coordinates const&)> const& visit);

}  // namespace gridmorph
