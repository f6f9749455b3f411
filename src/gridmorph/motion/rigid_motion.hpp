// Rigid motions put together from scaling, rotation and translation.
#pragma once

#include <gridmorph/motion/motion.hpp>

#include <span>

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

/// Several of them one after another, and of each one a share: of its angle, of its translation, and of the logarithm
/// of its scale factors. So half of a turn is a turn by half the angle, twice half of a stretch is the stretch, and a
/// negative share goes the other way. Share 1 is the motion itself, bit for bit; share 0 none. Throws MotionError as
/// above, and for scale factors that are not positive where the share is not 1.
RigidRule make_rigid_steps(std::span<RigidSteps const> steps, double share = 1);

/// Displacement of a point under the rule: (M - I) x + t, exactly t where M is the identity.
Vec3 displacement(RigidRule const& rule, Vec3 const& point);

}  // namespace gridmorph
