// Paths along the edges of a target surface that go beside a given line.
#pragma once

#include <gridmorph/motion/target/feature_edges.hpp>

#include <array>
#include <optional>
#include <utility>
#include <vector>

namespace gridmorph {

/// A line of points with the arc length from its start.
class Polyline {
 public:
  explicit Polyline(std::vector<Vec3> points);
  [[nodiscard]] std::vector<Vec3> const& points() const { return points_; }
  [[nodiscard]] double length() const { return length_.back(); }
  /// Share of the whole length at point n.
  [[nodiscard]] double fraction(std::size_t n) const { return length() > 0 ? length_[n] / length() : 0; }
  /// The point at a share of the length; exactly one of the points where their shares agree to 1e-10.
  [[nodiscard]] Vec3 at(double fraction) const;
  [[nodiscard]] double distance_to(Vec3 const& p) const;

 private:
  std::vector<Vec3> points_;
  std::vector<double> length_;
};

/// The edges of a target as a network of roads. Points on edges can be added as places to start from.
class FeatureNetwork {
 public:
  FeatureNetwork(std::vector<Vec3> const& points, std::vector<FeatureEdge> const& edges);

  [[nodiscard]] bool empty() const { return points_.empty(); }
  [[nodiscard]] Vec3 const& point(int place) const { return points_[place]; }
  [[nodiscard]] std::vector<std::vector<int>> const& neighbours() const { return neighbours_; }
  [[nodiscard]] std::vector<Vec3> const& points() const { return points_; }
  /// Closes a place: no way leads through it from now on; ways may begin and end there.
  void close(int place) { closed_[place] = 1; }
  /// The place nearest to p: a vertex, or a point inside an edge, which becomes a vertex; of those that ways from
  /// `start` lead to, where it is given. -1 if there is none. Cost O(edges).
  int nearest_place(Vec3 const& p, int start = -1);
  /// The shortest way from one place to the other, where going far from the guide makes a way longer: at a tenth of the
  /// guide's length beside it twice as long. Nothing if there is no way. Cost O(edges (log edges + points of guide)).
  [[nodiscard]] std::optional<std::vector<int>> path(int from, int to, Polyline const& guide) const;
  /// The edge, as given, on which two neighbouring places lie; smaller vertex first.
  [[nodiscard]] std::pair<int, int> edge_between(int place, int neighbour) const;

 private:
  [[nodiscard]] std::vector<char> reached_from(int place) const;

  std::vector<Vec3> points_;
  std::vector<std::vector<int>> neighbours_;
  std::vector<std::array<int, 2>> on_;  ///< per place: its vertex, twice, or the ends of the edge it is inside of
  std::vector<char> closed_;            ///< per place
};

}  // namespace gridmorph
