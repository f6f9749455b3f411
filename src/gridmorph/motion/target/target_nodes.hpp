// Node-for-node targets: which point of the target belongs to which node.
#pragma once

#include <gridmorph/boundary/patch_surface.hpp>
#include <gridmorph/motion/target_rule.hpp>

#include <optional>
#include <string>
#include <vector>

namespace gridmorph {

/// Displacement of every vertex when every patch has a grid of its size; nothing if some patch has none. Each grid
/// serves one patch. Directions may be swapped or reversed, and a direction in which patch and grid close on themselves
/// may start anywhere: of all these the one is taken that agrees with the neighbours already placed and moves nodes
/// least (squares), unless another changes the shape far less (a tenth of the squares that the best rigid motion
/// leaves).
///
/// Throws MotionError where patches meet and their grids do not. Cost O(nodes), times the places where a closed grid
/// may start (on at most 2000 of its nodes).
std::optional<std::vector<Vec3>> match_grids(PatchSurface const& surface, std::vector<TargetGrid> const& grids,
                                             Boundary const& boundary, std::string const& name,
                                             std::vector<std::string>& notes);

/// Displacement of every vertex from positions listed patch after patch, i fastest. Throws MotionError when their
/// number is not that of the nodes, or coincident nodes have different targets.
std::vector<Vec3> match_nodes(PatchSurface const& surface, std::vector<Vec3> const& nodes, Boundary const& boundary,
                              std::string const& name);

}  // namespace gridmorph
