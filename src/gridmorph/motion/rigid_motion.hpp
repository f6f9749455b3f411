// Rigid motions put together from scaling, rotation and translation.
#pragma once

#include <gridmorph/motion/motion.hpp>

namespace gridmorph {

/// What case files and callers give; the order of application is fixed: scale, then rotate, then translate.
struct RigidSteps {
  Vec3 scale{1, 1, 1};         ///< factors along x, y, z
  Vec3 scale_center{0, 0, 0};  ///< the point that scaling leaves in place
  double angle_rad = 0;        ///< right-handed about `axis`
  Axis axis{};                 ///< the line that the rotation leaves in place
  Vec3 translation{0, 0, 0};   ///< length units of the mesh
};

/// x' = R (S (x - c) + c - o) + o + t  with c the scale centre, o the axis origin. A step that does nothing contributes
/// exactly nothing: pure translations displace every node by exactly t. Throws MotionError when a number is not finite,
/// a scale factor is zero, or the axis has no direction.
RigidRule make_rigid(RigidSteps const& steps);

/// Displacement of a point under the rule: (M - I) x + t, exactly t where M is the identity.
Vec3 displacement(RigidRule const& rule, Vec3 const& point);

}  // namespace gridmorph
