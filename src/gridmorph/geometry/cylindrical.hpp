// Positions and motions as a machine sees them: along its axis, away from it, and around it; in a linear cascade along
// the flow, along the span, and along the pitch; in a plane across the axis away from it, along it, and around it.
#pragma once

#include <gridmorph/geometry/rigid_transform.hpp>
#include <gridmorph/kernels/row_frame.hpp>

#include <cmath>

namespace gridmorph {

/// Where a point is in the meridional plane; the angle about the axis is left out, so that whatever is computed from it
/// is the same for every periodic copy.
struct MeridionalPoint {
  double axial = 0;
  double radius = 0;
};

/// A displacement in cylindrical components: lengths, and an angle right-handed about the axis (linear cascades: a
/// length along the pitch).
struct CylindricalMotion {
  double axial = 0;
  double radial = 0;
  double angle_rad = 0;
};

/// The frame of a machine's axis, or of a linear cascade: blades side by side along a straight line, what an annulus
/// becomes when its radius grows without limit. There axial position, radius and angle are the positions along the axis
/// (the way of the flow), along the span = pitch x axis, and along the pitch, all lengths from the origin. In a plane
/// across the axis, whose flow goes in or out, axial position and radius change places: the one is the distance from
/// the axis, the other the position along it.
class CylindricalFrame {
 public:
  explicit CylindricalFrame(Axis const& axis) {
    row_.origin = axis.origin;
    row_.direction = (1 / norm(axis.direction)) * axis.direction;
  }
  /// The frame of a linear cascade, whose blades stand along `pitch`. Precondition: the pitch is across the axis.
  CylindricalFrame(Axis const& axis, Vec3 const& pitch) : CylindricalFrame(axis) {
    row_.pitch = (1 / norm(pitch)) * pitch;
    row_.span = cross(row_.pitch, row_.direction);
    row_.is_linear = true;
  }
  /// The frame of a row in a plane across the axis.
  static CylindricalFrame in_plane(Axis const& axis) {
    CylindricalFrame out(axis);
    out.plane_ = true;
    return out;
  }

  /// Whether blades stand along a straight line.
  [[nodiscard]] bool is_linear() const { return row_.is_linear; }
  /// Whether the flow stays in a plane across the axis.
  [[nodiscard]] bool is_plane() const { return plane_; }
  /// Unit vectors along the pitch and the span of a linear cascade.
  [[nodiscard]] Vec3 const& pitch() const { return row_.pitch; }
  [[nodiscard]] Vec3 const& span() const { return row_.span; }

  /// As kernels take it: along the axis, away from it and around it, in a plane across it too.
  [[nodiscard]] kernels::RowFrame const& row() const { return row_; }
  [[nodiscard]] Vec3 const& origin() const { return row_.origin; }
  [[nodiscard]] Vec3 const& direction() const { return row_.direction; }

  [[nodiscard]] MeridionalPoint meridional(Vec3 const& p) const {
    Vec3 const d = p - row_.origin;
    double const a = dot(d, row_.direction);
    if (row_.is_linear) return {a, dot(d, row_.span)};
    double const r = norm(d - a * row_.direction);
    return plane_ ? MeridionalPoint{r, a} : MeridionalPoint{a, r};
  }
  /// Length along the circumference per angle: the distance from the axis; 1 in a linear cascade, whose angles are
  /// lengths.
  [[nodiscard]] double length_of_angle(Vec3 const& p) const {
    if (row_.is_linear) return 1;
    MeridionalPoint const m = meridional(p);
    return plane_ ? m.axial : m.radius;
  }

  /// What displacement u does to point p. Every component is a product with u, so that u = 0 gives exact zeros.
  [[nodiscard]] CylindricalMotion motion(Vec3 const& p, Vec3 const& u) const {
    if (u == Vec3{0, 0, 0}) return {};
    if (row_.is_linear) return {dot(u, row_.direction), dot(u, row_.span), dot(u, row_.pitch)};
    Vec3 const d = p - row_.origin;
    Vec3 const q = d - dot(d, row_.direction) * row_.direction;
    double const axial = dot(u, row_.direction);
    Vec3 const v = u - axial * row_.direction;
    double const radii = norm(q) + norm(q + v);
    double const radial = radii > 0 ? (2 * dot(q, v) + dot(v, v)) / radii : 0.0;
    return swapped({axial, radial, std::atan2(dot(row_.direction, cross(q, v)), dot(q, q) + dot(q, v))});
  }

  /// The displacement of p that has these components: the inverse of motion(). Exactly zero for zero components; an
  /// angle alone keeps axial position and radius to round-off.
  [[nodiscard]] Vec3 displacement(Vec3 const& p, CylindricalMotion const& components) const {
    CylindricalMotion const m = swapped(components);
    if (row_.is_linear) return m.axial * row_.direction + m.radial * row_.span + m.angle_rad * row_.pitch;
    Vec3 const d = p - row_.origin;
    Vec3 const q = d - dot(d, row_.direction) * row_.direction;
    double const s = std::sin(m.angle_rad), half = std::sin(0.5 * m.angle_rad);
    Vec3 u = s * cross(row_.direction, q) + (-2 * half * half) * q;  // (R - I) q, with 1 - cos = 2 sin^2(angle / 2)
    if (m.radial != 0) {
      double const r = norm(q);
      if (r > 0) u += (m.radial / r) * (q + u);
    }
    if (m.axial != 0) u += m.axial * row_.direction;
    return u;
  }

 private:
  /// Turns components in a plane into those about the axis, and back: in a plane axial and radial change places.
  [[nodiscard]] CylindricalMotion swapped(CylindricalMotion const& m) const {
    return plane_ ? CylindricalMotion{m.radial, m.axial, m.angle_rad} : m;
  }

  kernels::RowFrame row_;
  bool plane_ = false;
};

}  // namespace gridmorph
