// Rotations found in other things: in deformations, in displacements of points.
#pragma once

#include <gridmorph/geometry/rigid_transform.hpp>

#include <optional>
#include <span>

namespace gridmorph {

/// The rotation R that makes the trace of R^T m greatest, and so |R - m| smallest: of a deformation with a positive
/// determinant its polar rotation. The unit quaternion is the eigenvector of the greatest eigenvalue of a symmetric 4x4
/// matrix of sums of entries of m (Horn, "Closed-form solution of absolute orientation using unit quaternions", JOSA A
/// 4 (1987)). Symmetric positive matrices give exactly the identity.
Mat3 nearest_rotation(Mat3 const& m);

/// Angle times axis of a rotation; the identity gives exactly zero.
Vec3 rotation_vector(Mat3 const& rotation);
/// The rotation by |v| about v.
Mat3 rotation_by(Vec3 const& v);

/// The rigid transform that maps from[n] onto to[n] best in the least-squares sense; for points on a line one of those
/// that do. As many points in both, one at least. Cost: O(points).
RigidTransform fit_rigid_transform(std::span<Vec3 const> from, std::span<Vec3 const> to);

/// Points that move like a rigid body, as nearly as they do: x -> to + rotation (x - from).
struct RigidFit {
  Vec3 from, to;  ///< means of the points, before and after
  Mat3 rotation;
};

/// The displacement that the fitted motion gives a point at x.
inline Vec3 displacement(RigidFit const& fit, Vec3 const& x) {
  Vec3 const arm = x - fit.from;
  return (fit.rotation * arm - arm) + (fit.to - fit.from);
}

/// The rigid motion that fits best to what takes points from `before` to `after`; nothing where it is not the only one
/// (points on a line), and for a motion that mirrors the points. `weights`: how much each point counts, none negative
/// and some positive; all alike where there are none.
std::optional<RigidFit> rigid_fit(std::span<Vec3 const> before, std::span<Vec3 const> after,
                                  std::span<double const> weights = {});

}  // namespace gridmorph
