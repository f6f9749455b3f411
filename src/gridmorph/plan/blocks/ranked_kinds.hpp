// What a patch ranks as where its file does not say.
#pragma once

#include <gridmorph/boundary/links.hpp>
#include <gridmorph/motion/boundary_motion.hpp>
#include <gridmorph/plan/options.hpp>

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

}  // namespace gridmorph
