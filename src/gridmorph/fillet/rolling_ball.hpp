// The ball that rolls along a corner and touches both of its walls: what a fillet of constant or varying radius is the
// envelope of.
#pragma once

#include <gridmorph/geometry/arc_curve.hpp>
#include <gridmorph/geometry/slip_surface.hpp>

#include <array>
#include <optional>

namespace gridmorph {

/// A ball in its place. Its arc from one contact to the other is split where both halves are equally long.
struct Ball {
  double radius = 0;
  Vec3 centre;
  std::array<Vec3, 2> to_contact;  ///< unit, from the centre; blade, end wall
  Vec3 to_middle;                  ///< unit, from the centre to the middle of the arc
  double half_angle_rad = 0;
  double blade_arc = 0;  ///< of the contact along the blade's line, from the corner [length]

  /// Length of the arc between its middle and a contact.
  [[nodiscard]] double half_arc() const { return radius * half_angle_rad; }
  /// The direction from the centre to the arc, unit; `share`: of the way from its middle to the contact with wall 0 or
  /// 1.
  [[nodiscard]] Vec3 to_arc(int wall, double share) const;
  [[nodiscard]] Vec3 contact(int wall) const { return centre + radius * to_contact[std::size_t(wall)]; }
};

/// A corner between two walls at one of its nodes.
struct CornerWalls {
  std::array<FacetSurface const*, 2> surface;  ///< blade, end wall
  ArcCurve const* blade_line;                  ///< along the blade, away from the corner
  std::array<Vec3, 2> into_mesh;               ///< off each wall, roughly
};

/// The ball that touches the blade on its line and the end wall where that is: the first one away from the corner,
///
///     c(s) = b(s) + r n_b(s),   (c(s) - f(c)) . n_w(f(c)) = r,
///
/// b the blade's line, f the foot on the end wall; s by bisection. Nothing where none is found before the end of the
/// line. Cost: some sixty feet, each O(log facets).
std::optional<Ball> rolling_ball(CornerWalls const& walls, double radius);

/// Arc length of the point of a line nearest to p, at least 0.
double nearest_arc(ArcCurve const& line, Vec3 const& p);

}  // namespace gridmorph
