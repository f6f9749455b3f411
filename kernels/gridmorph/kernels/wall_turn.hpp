// How walls turn, and what stands on them turns with them.
#pragma once

#include <gridmorph/kernels/vec3.hpp>

#include <cmath>

namespace gridmorph::kernels {

/// The smallest rotation that takes direction `before` to `after`, as axis times angle [rad]; zero where either is zero, where they
/// are the same, and where they are opposite (no one axis).
KOKKOS_INLINE_FUNCTION Vec3 turn_between(Vec3 const& before, Vec3 const& after) {
  using std::atan2;
  Vec3 const c = cross(before, after);
  double const sine = norm(c), cosine = dot(before, after);
  if (!(sine > 0)) return {};
  return (atan2(sine, cosine) / sine) * c;
}

/// v turned by `share` of a rotation given as axis times angle, minus v (Rodrigues): exactly zero where the angle is.
/// R v - v = sin(a) k x v + (1 - cos(a)) k x (k x v)
KOKKOS_INLINE_FUNCTION Vec3 turned_by(Vec3 const& turn, double share, Vec3 const& v) {
  using std::cos;
  using std::sin;
  double const angle = norm(turn);
  if (!(angle > 0)) return {};
  Vec3 const k = (1 / angle) * turn, kv = cross(k, v);
  double const a = share * angle, half = sin(0.5 * a);
  return sin(a) * kv + (2 * half * half) * cross(k, kv);
}

/// A rotation given as axis times angle, minus the identity: the gradient of the displacement of what turns rigidly.
KOKKOS_INLINE_FUNCTION Mat3 turn_gradient(Vec3 const& turn) {
  Vec3 const x = turned_by(turn, 1, {1, 0, 0}), y = turned_by(turn, 1, {0, 1, 0}), z = turned_by(turn, 1, {0, 0, 1});
  return {{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}};
}

/// First one rotation, then the other, both as axis times angle; exactly zero where both are. By unit quaternions.
KOKKOS_INLINE_FUNCTION Vec3 turn_then(Vec3 const& first, Vec3 const& next) {
  using std::atan2;
  using std::cos;
  using std::sin;
  double const a = norm(first), b = norm(next);
  if (!(a > 0)) return next;
  if (!(b > 0)) return first;
  double const p = cos(0.5 * a), q = cos(0.5 * b);
  Vec3 const v = (sin(0.5 * a) / a) * first, w = (sin(0.5 * b) / b) * next;
  double real = p * q - dot(v, w);
  Vec3 imaginary = p * w + q * v + cross(w, v);
  if (real < 0) {
    real = -real;
    imaginary = -imaginary;
  }
  double const sine = norm(imaginary);
  return sine > 0 ? (2 * atan2(sine, real) / sine) * imaginary : Vec3{};
}

}  // namespace gridmorph::kernels
