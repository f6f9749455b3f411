// Rotations found in other things: in deformations, in displacements of points.
#pragma once

#include <gridmorph/geometry/rigid_transform.hpp>

#include <optional>
#include <span>

namespace gridmorph {

Mat3 from_columns(Vec3 const& a, Vec3 const& b, Vec3 const& c);

/// Determinants and products of two rows each: cofactor(a) = det(a) transpose(inverse(a)), for singular matrices too.
Mat3 cofactor(Mat3 const& a);
double determinant(Mat3 const& a);
/// Inverse of a matrix whose determinant is not zero.
Mat3 inverse(Mat3 const& a);

/// The rotation of a deformation with a positive determinant: Newton's iteration X <- (X + X^-T) / 2 (N. J. Higham,
/// "Computing the polar decomposition - with applications", SIAM J. Sci. Stat. Comput. 7 (1986)).
Mat3 polar_rotation(Mat3 x);

/// Angle times axis of a rotation; the identity gives exactly zero.
Vec3 rotation_vector(Mat3 const& rotation);
/// The rotation by |v| about v.
Mat3 rotation_by(Vec3 const& v);

/// Points that move like a rigid body, as nearly as they do: x -> to + rotation (x - from).
struct RigidFit {
  Vec3 from, to;  ///< means of the points, before and after
  Mat3 rotation;
};

/// The rotation is the polar one of H / |H| + cofactor(H / |H|), H the sum of (x' - to)(x - from)^T; the second part adds the
/// normal where all points lie in a plane, and changes nothing where they move rigidly. Nothing for points on a line, and for
/// a motion that mirrors them. Cost: O(points).
std::optional<RigidFit> rigid_fit(std::span<Vec3 const> before, std::span<Vec3 const> after);

}  // namespace gridmorph
