// Edges of a surface that run around and meet no other: rims of holes, ends of tubes.
#pragma once

#include <gridmorph/motion/target/feature_edges.hpp>

#include <functional>
#include <vector>

namespace gridmorph {

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

}  // namespace gridmorph
