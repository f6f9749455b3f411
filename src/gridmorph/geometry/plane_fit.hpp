// The plane nearest to a set of points.
#pragma once

#include <gridmorph/kernels/vec3.hpp>

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

}  // namespace gridmorph
