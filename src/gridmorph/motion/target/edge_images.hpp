// Where the edges of a surface go on a target: corners to corners, edges to edges by arc length.
#pragma once

#include <gridmorph/geometry/target_tree.hpp>
#include <gridmorph/motion/target/feature_edges.hpp>

#include <functional>
#include <set>
#include <utility>
#include <vector>

namespace gridmorph {

/// Edges of a surface that run around and meet no other: the rim of a hole, the end of a tube.
struct FeatureLoop {
  std::vector<int> vertices;  ///< in order around, each once
  Vec3 middle;                ///< of the line, by length
  double length = 0;
  bool boundary = false;  ///< the surface ends there; otherwise a crease
};

/// The loops of edges; `neighbours` as feature_neighbours(), `is_boundary(a, b)` of two of them. Cost O(edges log
/// edges).
std::vector<FeatureLoop> feature_loops(std::vector<Vec3> const& points, std::vector<std::vector<int>> const& neighbours,
                                       std::function<bool(int a, int b)> const& is_boundary);

/// The partner of each loop of `from` among `to`, -1 for none, no partner twice: both boundary or both crease, their
/// lengths apart by a factor of two at most, their middles by `farthest` at most. Nearest first, and then so that no
/// exchange of two partners lessens the sum of the squares of the distances: a common shift of all, however long beside
/// the loops, changes no pair. Cost O(from x to), and of up to 2000 loops their square.
std::vector<int> pair_loops(std::vector<FeatureLoop> const& from, std::vector<FeatureLoop> const& to, double farthest);

struct EdgeImages {
  std::vector<char> known;                  ///< per vertex
  std::vector<Vec3> image;                  ///< per vertex; of known ones
  std::set<std::pair<int, int>> edges;      ///< edges of the surface that have an image, smaller vertex first
  std::set<std::pair<int, int>> on_target;  ///< edges of the target that they lie on, smaller vertex first
  std::function<Vec3(Vec3 const&)> guess;   ///< where points between the edges go, roughly
  int mapped = 0, unmapped = 0;             ///< lines of edges with and without a counterpart on the target
};

/// Maps every chain of feature edges of the surface that has a counterpart on the target. `guess` is a rough idea of
/// where points of the surface go. Corners are where other than two edges meet, or two at more than 45 degrees; they
/// are paired nearest first. A chain goes to the way between the images of its ends that stays beside it and leads
/// through no other corner's image, with equal shares of arc length; a closed one to the loop beside it, turned so that
/// its nodes move least. A chain whose image would be much farther than the target itself, or of another length (by
/// more than half or double), has no counterpart. Lines around that meet no other, as the rims of holes, are paired one
/// to one first (pair_loops()): one goes to its partner, wherever the next edge is.
EdgeImages map_edges(std::vector<Vec3> const& points, std::vector<FeatureEdge> const& edges, TargetTree const& target,
                     std::vector<FeatureEdge> const& target_edges, double size,
                     std::function<Vec3(Vec3 const&)> const& guess);

}  // namespace gridmorph
