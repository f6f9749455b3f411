// A target that goes on beyond the sides of the mesh, cut off there.
#pragma once

#include <gridmorph/geometry/slip_surface.hpp>
#include <gridmorph/geometry/target_tree.hpp>

#include <vector>

namespace gridmorph {

/// The part of a target on the side of the surface that moves of every plane that the mesh ends on: planes among
/// `slides` that nodes of the surface lie on and none crosses, to 1e-6 of its size. Nodes on such a plane stay on it,
/// so that a target which goes on beyond (terrain, a body whose half is meshed) is one that ends there. Edges are cut
/// once, to rounding: what ends on a plane lies on it. A target that ends before, or lies beyond altogether, comes back
/// as it is. Cost O(points + triangles) for each plane that cuts.
TargetTree cut_at_sides(TargetTree target, std::vector<Vec3> const& surface, std::vector<SlipSurface> const& slides);

}  // namespace gridmorph
