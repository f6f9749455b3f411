#include <gridmorph/motion/rigid_motion.hpp>

#include <gridmorph/core/error.hpp>
#include <gridmorph/geometry/rigid_transform.hpp>

#include <cmath>

namespace gridmorph {

namespace {

bool finite(Vec3 const& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

}  // namespace

RigidRule make_rigid(RigidSteps const& s) {
  if (!finite(s.scale) || !finite(s.scale_center) || !finite(s.axis.origin) || !finite(s.axis.direction) ||
      !finite(s.translation) || !std::isfinite(s.angle_rad))
    throw MotionError(
        "rigid motion: a number is not finite; give finite "
        "scale, angle, axis and translation");
  if (s.scale.x == 0 || s.scale.y == 0 || s.scale.z == 0)
    throw MotionError(
        "rigid motion: a scale factor is 0, which flattens the "
        "patch; factors are 1 for no scaling");

  RigidRule rule;
  if (!(s.scale == Vec3{1, 1, 1})) {
    rule.matrix = {{{s.scale.x, 0, 0}, {0, s.scale.y, 0}, {0, 0, s.scale.z}}};
    rule.translation = s.scale_center - rule.matrix * s.scale_center;
  }
  if (s.angle_rad != 0) {
    if (!(norm(s.axis.direction) > 0))
      throw MotionError(
          "rigid motion: the rotation axis has direction (0, 0, "
          "0); give a direction");
    RigidTransform const turn = rotation_about(s.axis.origin, s.axis.direction, s.angle_rad);
    rule.matrix = turn.rotation * rule.matrix;
    rule.translation = turn(rule.translation);
  }
  rule.translation = rule.translation + s.translation;
  return rule;
}

RigidRule make_rigid_steps(std::span<RigidSteps const> steps, double share) {
  RigidRule all;
  for (RigidSteps step : steps) {
    if (share != 1) {
      if (!(step.scale.x > 0 && step.scale.y > 0 && step.scale.z > 0))
        throw MotionError("rigid motion: a scale factor is not positive, so that there is no part of the scaling");
      step.scale = {std::pow(step.scale.x, share), std::pow(step.scale.y, share), std::pow(step.scale.z, share)};
      step.angle_rad *= share;
      step.translation = share * step.translation;
    }
    RigidRule const next = make_rigid(step);
    all = {next.matrix * all.matrix, next.matrix * all.translation + next.translation};
  }
  return all;
}

Vec3 displacement(RigidRule const& rule, Vec3 const& point) {
  // m_ii - 1 is exact for 0.5 <= m_ii <= 2, so nothing is lost against M x - x, and the identity gives exact zeros.
  Mat3 d = rule.matrix;
  for (int i = 0; i < 3; ++i) d.m[i][i] -= 1;
  return d * point + rule.translation;
}

}  // namespace gridmorph
