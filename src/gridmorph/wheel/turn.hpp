// Turns about the machine axis by equal parts of a full turn, as a wheel of passages needs them.
#pragma once

#include <gridmorph/geometry/rigid_transform.hpp>
#include <gridmorph/motion/motion.hpp>

#include <cmath>

namespace gridmorph {

/// The turn by step / steps of 360 degrees, right-handed about the axis. No turn and quarter turns are exact: cosine
/// and sine come from an angle of at most 45 degrees, and no turn gives back a point bit for bit.
class Turn {
 public:
  /// Any step, negative ones and full turns too; steps > 0.
  Turn(Axis const& axis, int step, int steps);

  [[nodiscard]] bool nothing() const { return step_ == 0; }

  /// x' = o + a + cos (q - a) + sin (d x q), with q = x - o and a its part along the unit direction d.
  [[nodiscard]] Vec3 operator()(Vec3 const& x) const {
    if (step_ == 0) return x;
    Vec3 const q = x - origin_;
    Vec3 const along = dot(q, direction_) * direction_;
    return origin_ + (along + (cosine_ * (q - along) + sine_ * cross(direction_, q)));
  }

  [[nodiscard]] RigidTransform transform() const;

 private:
  Vec3 origin_, direction_;
  int step_ = 0;
  double cosine_ = 1, sine_ = 0;
};

}  // namespace gridmorph
