// Where the nodes of a wall's line go when the corner that it begins in is filled; and the ball that rolls along the
// corner and touches both of its walls: what a fillet of constant or varying radius is the envelope of.
#pragma once

#include <gridmorph/geometry/arc_curve.hpp>
#include <gridmorph/geometry/slip_surface.hpp>

#include <array>
#include <optional>
#include <vector>

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
  [[nodiscard]] Vec3 contact(int wall) const { return centre + radius * to_contact[wall]; }
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

/// A line of wall nodes from the corner, as far as it may be changed.
struct WallLine {
  ArcCurve curve;
  int layers = 0;    ///< cells that the corner takes from it: node `layers` comes to lie in the new corner
  double reach = 0;  ///< arc length beyond which nothing moves

  [[nodiscard]] double taken() const { return curve.arc(std::size_t(layers)); }
  /// The share of the corner in a node: 1 at the new corner, 0 from `reach` on: 1 - c1((s - taken) / (reach - taken)),
  /// c1(t) = t^2 (3 - 2 t).
  [[nodiscard]] double share(int node) const;
};

/// A node of the wall in its new place.
struct WallPlace {
  Vec3 point;
  Vec3 normal;           ///< unit, into the mesh
  bool rounded = false;  ///< on the arc
};

/// All balls along a corner. Where it stays sharp they have no radius and lie in its nodes.
struct BallRow {
  std::vector<Ball> balls;
  bool closed = false;  ///< the first follows on the last

  /// The ball `steps` from one; none beyond an end.
  [[nodiscard]] Ball const* from(int number, int steps) const;

  /// The point on the fillet between the arcs of the stations around `station`, at a share of their ways from the
  /// middle to wall 0 or 1.
  [[nodiscard]] Vec3 point(double station, int wall, double share) const;
  /// The normal at point(), into the mesh; zero where all around is sharp.
  [[nodiscard]] Vec3 normal(double station, int wall, double share) const;
};

/// Where the way of a wall's line over the fillet ends: on the curve of contacts with that wall.
struct FilletEdge {
  double station = 0;  ///< of the corner: lines that lean come to it elsewhere than they begin
  double arc = 0;      ///< along the line, of the point nearest to the edge [length]
  Vec3 beside;         ///< from there to the edge
  double way = 0;      ///< along the fillet, from the middle of its arc [length]
};

/// One node of the corner with the lines of both walls.
struct CornerStation {
  int number = 0;                ///< in the row
  std::array<WallLine, 2> line;  ///< blade, end wall
  std::array<FacetSurface const*, 2> surface{nullptr, nullptr};
  std::array<Vec3, 2> into_mesh;  ///< off both walls, unit
  Vec3 inner;                     ///< where the layers of both walls end: the line in which three blocks meet
  Vec3 along;                     ///< the corner, unit, as the row goes
  BallRow const* row = nullptr;
  std::array<FilletEdge, 2> edge;  ///< blade, end wall

  [[nodiscard]] Ball const& ball() const { return row->balls[number]; }
  [[nodiscard]] bool sharp() const { return ball().radius == 0; }
  /// Finds the edges, once the row is whole.
  void find_edges();
  /// The place of the middle of the new corner.
  [[nodiscard]] WallPlace middle() const;
  /// The place of a node `layers` or more of a wall. It goes by arc length: with s that of the node, d what the fillet
  /// is shorter than the corner (edge.arc - edge.way; 0 where it is sharp), g its share,
  ///
  ///     t = (s - d) - g (s_layers - d),
  ///
  /// counted from the middle of the arc: over the fillet up to edge.way, then along the line, and beside it as its edge
  /// is, fading to `reach`. Directions keep the lean of the lines along the corner.
  [[nodiscard]] WallPlace place(int wall, int node, Vec3 const& off_wall) const;

 private:
  [[nodiscard]] Vec3 mitre() const;
  [[nodiscard]] Vec3 leaning(Vec3 const& normal, double share, Vec3 const& off_wall) const;
};

}  // namespace gridmorph
