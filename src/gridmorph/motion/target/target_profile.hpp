// Mapping the boundary of a 2-D mesh onto a profile.
#pragma once

#include <gridmorph/boundary/patch_surface.hpp>
#include <gridmorph/motion/target_rule.hpp>

#include <string>
#include <vector>

namespace gridmorph {

/// Displacement of every vertex of lines in a plane z = constant onto the profile of the target: its sections where it
/// has some, laid into that plane, otherwise the cut of its facets with it. Corners go to corners and the lines between
/// them to the way between their images, with equal shares of arc length; a closed line without corners is turned so
/// that its nodes move least, an open one goes to an open one from end to end (edge_images.hpp). What has no
/// counterpart goes to the closest point. A profile of points around a closed line is closed.
///
/// Throws MotionError when sections do not lie across z and when the plane meets no facet. Cost O(vertices log points).
std::vector<Vec3> project_to_profile(PatchSurface const& surface, TargetGeometry const& target, std::string const& name,
                                     std::vector<std::string>& notes);

}  // namespace gridmorph
