// What the boundary of a mesh of blocks says to its plan: what patches rank as where the file does not say, poles
// (faces collapsed to a line that no rule moves, whose coinciding nodes must move as one), and nodes of two zones at
// one place that no interface joins.
#pragma once

#include <gridmorph/boundary/links.hpp>
#include <gridmorph/motion/boundary_motion.hpp>
#include <gridmorph/plan/blocks/boundary.hpp>
#include <gridmorph/plan/options.hpp>

#include <optional>
#include <string>
#include <vector>

namespace gridmorph {

/// What each patch ranks as in the plan: the kind that its file gives. A patch of kind `other` (families without a
/// type, side files, open faces) is judged by what is done to it and by its cells:
///   circumferential-slide  inflow upstream of the blade, outflow downstream
///   follow                 periodic
///   any other explicit rule but `fixed`, or named as a wall of a boundary layer: wall
///   fixed                  wall where most of its cells say so, other elsewhere
/// Cells are those of a viscous wall where the edge off the wall is at most a fifth of the root of the face's area, and
/// one of the seven beyond is half as long again: patches of one name and rule are judged together, so cuts of zones do
/// not matter. What was taken for a wall by its cells is said in a note. Values of rules are not looked at: a plan
/// serves any amplitude. Cost: eight cells from every node of patches of kind `other` that are fixed.
std::vector<PatchKind> ranked_kinds(Mesh const& mesh, Links const& links, BoundaryMotion const& surface,
                                    std::vector<BoundaryLayer> const& layers, std::vector<std::string>& notes);

/// A stage that gives pole faces their displacement before any volume line ends on them: linear in arc length along the
/// pole between its known ends, constant from the only known end. Poles without a known end stay where they are
/// (boundary nodes that no rule asks for: displacement zero) and are listed in plan.notes. Nothing when the mesh has no
/// such faces.
std::optional<Stage> pole_stage(PlanContext const& context, ResolvedMotion const& motion,
                                std::vector<std::string> const& kind_order, Known& known, Plan& plan);

/// Says in a note of the plan how many nodes of patches coincide with nodes of another zone (coincidence_tolerance())
/// that they share no displacement with, and where the first are: without an interface each zone goes its own way
/// there. Nodes of connections that do not match node to node are left out, as they are to slide, and those that one
/// rule displaces on both sides. Call with the plan's skeleton complete. Cost O(n log n) in the nodes of patches.
void note_loose_nodes(Mesh const& mesh, BoundaryRequests const& boundary, Plan& plan);

}  // namespace gridmorph
