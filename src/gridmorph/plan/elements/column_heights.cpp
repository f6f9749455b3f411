#include <gridmorph/plan/elements/column_heights.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace gridmorph {

double room_in_gap(double gap, double motion) { return std::min(gap / 3, std::max(gap - 2 * motion, gap / 10)); }

std::vector<double> gaps_ahead(Coordinates const& coordinates, Columns const& columns,
                               NearestSource const& from_other) {
  std::vector<double> gap(columns.height.size(), std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k < columns.node.size(); ++k) {
    Index32 const root = columns.root[k];
    double const d = from_other.distance[std::size_t(root)];
    if (!std::isfinite(d)) continue;
    Vec3 const along = coordinates[columns.node[k]] - coordinates[root];
    Vec3 const way = coordinates[from_other.source[std::size_t(root)]] - coordinates[root];
    // Nodes of a column are in order: the highest has the last word.
    gap[std::size_t(root)] = dot(way, along) > 0.5 * d * norm(along) ? d : std::numeric_limits<double>::infinity();
  }
  return gap;
}

std::vector<double> smooth_rises(NodeGraph const& graph, Columns const& columns, std::vector<double> const& most) {
  constexpr int sweeps_of_least = 3, sweeps_of_mean = 20;
  std::vector<Index32> walls;
  std::vector<double> rise = columns.full_rise;
  for (std::size_t n = 0; n < rise.size(); ++n)
    if (rise[n] > 0) {
      walls.push_back(Index32(n));
      rise[n] = std::min(rise[n], most[n]);
    }
  std::vector<double> next = rise;
  for (int s = 0; s < sweeps_of_least + sweeps_of_mean; ++s) {
    for (Index32 const n : walls) {
      double sum = rise[std::size_t(n)], least = sum;
      int count = 1;
      for (Index32 const m : graph.neighbours[n])
        if (columns.full_rise[std::size_t(m)] > 0) {
          sum += rise[std::size_t(m)];
          least = std::min(least, rise[std::size_t(m)]);
          ++count;
        }
      next[std::size_t(n)] = s < sweeps_of_least ? least : sum / count;
    }
    std::swap(rise, next);
  }
  return rise;
}

Columns cut(Columns const& columns, std::vector<double> const& rise) {
  Columns out;
  out.full_rise = rise;
  out.height = columns.height;
  for (std::size_t n = 0; n < rise.size(); ++n)
    if (columns.full_rise[n] > 0) out.height[n] *= rise[n] / columns.full_rise[n];
  // Rises are means of what neighbours have: columns that all end alike must not lose their ends to round-off.
  constexpr double allowed = 1e-3;
  std::vector<double> below(rise.size(), 0);
  for (std::size_t k = 0; k < columns.node.size(); ++k) {
    std::size_t const root = std::size_t(columns.root[k]);
    double const above = columns.rise[k], layer = above - std::exchange(below[root], above);
    if (above > rise[root] + allowed * layer) continue;
    out.node.push_back(columns.node[k]);
    out.root.push_back(columns.root[k]);
    out.below.push_back(columns.below[k]);
    out.above_wall.push_back(columns.above_wall[k]);
    out.rise.push_back(above);
  }
  return out;
}

}  // namespace gridmorph
