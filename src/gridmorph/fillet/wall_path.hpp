// Where the nodes of a wall's line go when the corner that it begins in is filled.
#pragma once

#include <gridmorph/fillet/rolling_ball.hpp>

#include <array>
#include <vector>

namespace gridmorph {

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

  [[nodiscard]] Ball const& ball() const { return row->balls[std::size_t(number)]; }
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
