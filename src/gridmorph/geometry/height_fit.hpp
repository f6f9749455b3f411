// The tangent plane of scattered points.
#pragma once

#include <gridmorph/kernels/vec3.hpp>

#include <optional>
#include <span>

namespace gridmorph {

/// Unit normal, at `centre`, of the height function over the plane across `normal` that passes through `centre` and
/// fits the points around it best (weights 1 / distance, local coordinates scaled to unit covariance): a cubic for 12
/// points and more, error O(h^3); a quadratic for 6 and more, O(h^2) (Cazals and Pouget, Estimating differential
/// quantities using polynomial fitting of osculating jets, CAGD 22, 2005). Nothing when the points do not determine it.
/// Cost O(points).
std::optional<Vec3> fit_normal(Vec3 const& centre, Vec3 const& normal, std::span<Vec3 const> around);

}  // namespace gridmorph
