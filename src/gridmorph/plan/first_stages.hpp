// A plan as far as some of its stages, for looking at a mesh on its way; and in which stage each cell has its turn.
#pragma once

#include <gridmorph/plan/plan.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace gridmorph {

/// How far a morph of blocks has come.
struct StagesDone {
  std::string name;         ///< of the last one: "boundary", "near field", "iteration 1", "slip surfaces", ...
  std::size_t stages = 0;   ///< of Plan::stages that are done
  std::size_t spreads = 0;  ///< of Plan::spreads
};

/// Everything that a morph does, one after another: the boundary, every stage, every pass over slip surfaces.
std::vector<StagesDone> stages_of(Plan const& plan);

/// The plan that ends there. Nodes that none of these stages reaches are not written, or stay where they are: every
/// slot of the skeleton that the motion does not give is one more boundary node, behind those of `plan`, whose
/// displacement has to be given as zero (its entry in boundary_nodes is -1). All stages done, it is the morph of `plan`
/// bit for bit. Cost: a copy of the plan.
Plan first_stages(Plan const& plan, StagesDone const& done);

/// Where cells have their turn, numbered as first_cells() does.
struct StagesOfCells {
  std::vector<int> stage;      ///< number in stages_of(); 0: none moves it but the rules, as in regions
  std::vector<int> chain;      ///< 1, 2, ... in the order of Stage::description; 0: none
  std::vector<int> direction;  ///< index direction of its zone along which the chain runs, 1 to 3; 0: none
};
StagesOfCells stages_of_cells(Mesh const& mesh, Plan const& plan);

}  // namespace gridmorph
