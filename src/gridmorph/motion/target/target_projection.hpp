// Mapping onto a target surface that shares nothing with the mesh but its shape.
#pragma once

#include <gridmorph/boundary/patch_surface.hpp>
#include <gridmorph/geometry/target_tree.hpp>

#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph {

/// The number of the piece that each facet belongs to: facets that share an edge belong together unless the edge is
/// among `cuts` (smaller vertex first). Numbered in the order of their first facets. Cost O(facets log facets).
std::vector<int> pieces_between(std::vector<GridFacet> const& facets, std::set<std::pair<int, int>> const& cuts);

/// Nodes of patches that stay, and of a surface that goes to a target which passes them no farther off than this share
/// of its size, stay.
inline constexpr double held_within = 1e-6;

/// A rough idea of where the surface goes: nowhere, or along with its bounding box when the target is clearly
/// elsewhere.
std::function<Vec3(Vec3 const&)> rough_guess(std::vector<Vec3> const& points, TargetTree const& target);

/// Displacement of every vertex of the surface onto the target:
///  1. edges (boundary, creases) to the target's edges by arc length (edge_images.hpp);
///  2. the affine displacement that fits theirs best carries everything else along;
///  3. what it misses on the edges is spread over each patch: corners of patches inside the surface by inverse distance
///     to the fourth power, then sides linearly by arc length, then transfinite interpolation (Gordon and Hall 1973);
///  4. every node not on an edge goes to the closest point of the target that faces the same way.
/// A vertex that lies on the target within round-off and is asked to stay, stays exactly; one of `held` (one per
/// vertex) stays where it lies on the target to held_within of the size of the surface. Cost O(vertices (log facets +
/// corners inside the surface)).
std::vector<Vec3> project_to_target(PatchSurface const& surface, TargetTree const& target,
                                    std::vector<char> const& held, double crease_angle_deg, std::string const& name,
                                    std::vector<std::string>& notes);

}  // namespace gridmorph
