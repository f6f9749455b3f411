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

}  // namespace gridmorph::kernels
