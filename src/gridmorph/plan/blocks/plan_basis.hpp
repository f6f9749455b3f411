// What is found out before chains are put in order, and plans made on it: of the mesh itself, or of some of its grid
// lines.
#pragma once

#include <gridmorph/plan/blocks/chain_laws.hpp>
#include <gridmorph/plan/blocks/gaps.hpp>
#include <gridmorph/plan/blocks/grid_lengths.hpp>
#include <gridmorph/plan/blocks/near_field.hpp>
#include <gridmorph/plan/blocks/priority.hpp>
#include <gridmorph/plan/make_plan.hpp>

#include <string>
#include <vector>

namespace gridmorph {

struct PlanBasis {
  Mesh const& mesh;
  std::vector<std::string> notes;
  std::vector<PatchKind> kinds;   ///< what patches rank as
  std::vector<EndKind> ends;      ///< the same, but those that the priority names apart
  std::vector<NearField> fields;  ///< of `mesh`, in its cells
  ChainLaws laws;
  MergeLimits limits;
  Topology topology;
  Gaps gaps;
};

/// The basis of plans of a mesh by these rules and options. Borrows the mesh. Throws as make_plan() does.
PlanBasis plan_basis(Mesh const& mesh, Links const& links, BoundaryMotion const& surface, PlanOptions const& options);

/// The grid lines that tables are made of: a mesh with the zones, patches, pieces and blocks of the basis in the same
/// order, and how long its edges are.
struct PlanLines {
  Mesh const& mesh;
  Topology const& topology;
  GridLengths lengths;
};

/// The plan of these lines. What coordinates decide (kinds, near fields, ranks) is decided on the mesh of the basis,
/// whose angles `priority` keeps; `first` as in make_plan(); `next`: gets what the stage after those could be, in the
/// order of ranks; `choice`: of the chains of stages that are not given.
PlannedMorph build_plan(PlanBasis const& basis, Priority& priority, PlanLines const& lines,
                        BoundaryMotion const& surface, PlanOptions const& options, ChainOrder const& first,
                        ChainOrder* next = nullptr, ChainChoice choice = ChainChoice::rules);

}  // namespace gridmorph
