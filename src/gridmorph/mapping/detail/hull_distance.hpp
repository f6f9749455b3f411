// How far the origin lies outside of a few points. Internal.
#pragma once

#include <gridmorph/kernels/vec3.hpp>

#include <vector>

namespace gridmorph::mapping {

/// The point of the convex hull that is closest to the origin; the zero vector when the origin is inside, or outside by
/// less than `tolerance`. The points may lie in a plane or on a line. Cost O(n) inside, O(n^3) outside: for
/// neighbourhoods.
Vec3 closest_in_hull(std::vector<Vec3> const& points, double tolerance);

}  // namespace gridmorph::mapping
