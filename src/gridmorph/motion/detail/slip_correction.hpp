// How far points are from slip surfaces, and what keeps them as far. Internal to motion.
#pragma once

#include <gridmorph/geometry/slip_surface.hpp>

namespace gridmorph {

/// Distance of a point from a slip surface, with its sign, the way that nodes are put back on it. Kind axial: 0.
double signed_distance(SlipSurface const& surface, Vec3 const& point);

/// What gives a point that is displaced by u its distance from the surface back: 0 where u keeps it. Kind axial: its
/// axial position.
Vec3 slip_correction(SlipSurface const& surface, Vec3 const& point, Vec3 const& u);

/// Unit normal of the surface beside a point: the direction in which its distance grows.
Vec3 slip_normal(SlipSurface const& surface, Vec3 const& point);

}  // namespace gridmorph
