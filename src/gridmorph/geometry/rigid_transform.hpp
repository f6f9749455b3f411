// Rotations and translations: periodic copies and rigid motions; the line that a machine turns about.
#pragma once

#include <gridmorph/kernels/vec3.hpp>

namespace gridmorph {

/// Axis of the machine (or any axis of rotation); direction need not be normalised.
struct Axis {
  Vec3 origin{0, 0, 0};
  Vec3 direction{1, 0, 0};
};

/// x' = rotation * x + translation.
struct RigidTransform {
  Mat3 rotation;
  Vec3 translation;

  [[nodiscard]] Vec3 operator()(Vec3 const& x) const;
  [[nodiscard]] RigidTransform inverse() const;
  /// The transform that applies first this one, then `next`.
  [[nodiscard]] RigidTransform then(RigidTransform const& next) const;
};

/// Rotation by angle_rad about the unit vector direction (Rodrigues), right-handed.
Mat3 rotation_matrix(Vec3 const& direction, double angle_rad);

/// Rotation about the line through origin along direction (need not be normalised).
RigidTransform rotation_about(Vec3 const& origin, Vec3 const& direction, double angle_rad);

}  // namespace gridmorph
