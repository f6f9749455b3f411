// What directions a blade row has: along its axis, away from it and around it.
#pragma once

#include <gridmorph/kernels/vec3.hpp>

#include <Kokkos_Core.hpp>

namespace gridmorph::kernels {

/// The unit vectors at a place.
struct RowBasis {
  Vec3 along, away, around;
  double radius = 0;  ///< 0: on the axis nothing leads away from it, and what goes along it is all there is

  [[nodiscard]] KOKKOS_INLINE_FUNCTION Vec3 components(Vec3 const& u) const {
    return {dot(along, u), dot(away, u), dot(around, u)};
  }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION Vec3 vector(Vec3 const& c) const {
    return c.x * along + c.y * away + c.z * around;
  }
};

/// The frame of a blade row, of an annulus or of a linear cascade.
struct RowFrame {
  Vec3 origin, direction;  ///< direction: unit, along the axis
  Vec3 span, pitch;        ///< unit, of a linear cascade
  bool is_linear = false;

  friend bool operator==(RowFrame const&, RowFrame const&) = default;
  /// In a linear cascade that is the same everywhere, and no place is on the axis.
  [[nodiscard]] KOKKOS_INLINE_FUNCTION RowBasis basis(Vec3 const& x) const {
    if (is_linear) return {direction, span, pitch, 1};
    Vec3 const d = x - origin;
    Vec3 const q = d - dot(d, direction) * direction;
    double const r = norm(q);
    if (!(r > 0)) return {direction, Vec3{}, Vec3{}, 0};
    Vec3 const away = (1 / r) * q;
    return {direction, away, cross(direction, away), r};
  }
};

}  // namespace gridmorph::kernels
