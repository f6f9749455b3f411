// The plane nearest to a set of points, and the tangent plane of scattered ones.
#pragma once

#include <gridmorph/kernels/vec3.hpp>

#include <optional>
#include <span>

namespace gridmorph {

struct PlaneFit {
  Vec3 origin;             ///< centre of the points
  Vec3 normal;             ///< unit
  double deviation = 0;    ///< largest distance of a point from the plane
  double extent = 0;       ///< largest distance of a point from the centre
  bool determined = true;  ///< false when the points lie on one line (or are one): any plane through it fits
};

/// The plane by least squares: its normal is the eigenvector of the smallest eigenvalue of the covariance (exact for
/// points on a coordinate plane). Precondition: points is not empty. Cost O(points).
PlaneFit fit_plane(std::span<Vec3 const> points);

/// Largest distance of the points from the plane.
double deviation_from_plane(std::span<Vec3 const> points, Vec3 const& origin, Vec3 const& normal);

/// Unit normal, at `centre`, of the height function over the plane across `normal` that passes through `centre` and
/// fits the points around it best (weights 1 / distance, local coordinates scaled to unit covariance): a cubic for 12
/// points and more, error O(h^3); a quadratic for 6 and more, O(h^2) (Cazals and Pouget, Estimating differential
/// quantities using polynomial fitting of osculating jets, CAGD 22, 2005). Nothing when the points do not determine it.
/// Cost O(points).
std::optional<Vec3> fit_normal(Vec3 const& centre, Vec3 const& normal, std::span<Vec3 const> around);

}  // namespace gridmorph
