#include <gridmorph/wheel/row_pitch.hpp>

#include <gridmorph/geometry/cylindrical.hpp>

#include <numbers>

namespace gridmorph {

namespace {

/// Angles about x, y, z (CGNS SIDS: x first) of a turn; a turn about a coordinate axis keeps its angle as it is.
Vec3 angles_of(Vec3 const& d, RigidTransform const& t, double angle) {
  if (std::abs(d.x) == 1 || std::abs(d.y) == 1 || std::abs(d.z) == 1) return angle * d;
  auto const& m = t.rotation.m;
  return {std::atan2(m[2][1], m[2][2]), std::atan2(-m[2][0], std::hypot(m[0][0], m[1][0])),
          std::atan2(m[1][0], m[0][0])};
}

}  // namespace

void RowPitch::set_directions(Vec3 const& along) {
  direction_ = (1 / norm(along)) * along;
  zero_ = cross(direction_, std::abs(direction_.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0});
  zero_ = (1 / norm(zero_)) * zero_;
  quarter_ = cross(direction_, zero_);
}

Periodic RowPitch::periodic(int pitches) const {
  if (is_straight()) return periodic_translation(double(pitches) * shift_);
  Periodic out;
  out.declared = Turn(axis_, pitches, passages_).transform();
  out.rotation_center = axis_.origin;
  out.rotation_angle_rad = angles_of(direction_, out.declared, 2 * std::numbers::pi * pitches / passages_);
  return out;
}

PlaceInRow RowPitch::place(Vec3 const& p) const {
  Vec3 const q = p - axis_.origin;
  double const a = dot(q, zero_), b = dot(q, quarter_), c = dot(q, direction_);
  if (is_straight()) return {a, b, c / norm(shift_)};
  return {c, std::hypot(a, b), std::atan2(b, a) * passages_ / (2 * std::numbers::pi)};
}

Vec3 RowPitch::share_motion(Vec3 const& x, Vec3 const& a, Vec3 const& b, double w) const {
  if (w == 0 || a == b) return a;
  CylindricalFrame const frame(axis_);
  if (is_straight() || frame.meridional(x).radius == 0) return a + w * (b - a);
  CylindricalMotion const p = frame.motion(x, a), q = frame.motion(x, b);
  return frame.displacement(x, {p.axial + w * (q.axial - p.axial), p.radial + w * (q.radial - p.radial),
                                p.angle_rad + w * (q.angle_rad - p.angle_rad)});
}

}  // namespace gridmorph
