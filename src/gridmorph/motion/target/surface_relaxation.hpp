// Puts the nodes of a surface onto a target without losing their order.
#pragma once

#include <gridmorph/boundary/patch_surface.hpp>

#include <functional>
#include <vector>

namespace gridmorph {

/// Where the nodes of a surface end that shall go to `wanted` smoothly, and to where `place` puts a point exactly (on a
/// target; as it is, for no target). What that adds to wanted, c = x - wanted, is made smooth along the surface: every
/// sweep replaces c by the mean of its neighbours' along grid lines (sides of faces), weighted by one over their
/// distance, and places wanted + c again. So a node goes straight to the target where the target is smooth and near,
/// and where closest points heap up (beside sharp edges that bulge) the nodes spread again as `wanted` has them. Begins
/// with `start`, where known nodes stay. Damped Jacobi sweeps, so the numbering does not matter; at most 200, ended
/// when no node moves by more than a thousandth of the distance to its neighbours. Cost O(nodes) calls of `place` per
/// sweep, fewer where nothing changes any more.
std::vector<Vec3> relax(PatchSurface const& surface, std::vector<char> const& known, std::vector<Vec3> const& wanted,
                        std::vector<Vec3> start, std::function<Vec3(int vertex, Vec3 const& point)> const& place);

}  // namespace gridmorph
