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
    double const d = from_other.distance[root];
    if (!std::isfinite(d)) continue;
    Vec3 const along = coordinates[columns.node[k]] - coordinates[root];
    Vec3 const way = coordinates[from_other.source[root]] - coordinates[root];
    // Nodes of a column are in order: the highest has the last word.
    gap[root] = dot(way, along) > 0.5 * d * norm(along) ? d : std::numeric_limits<double>::infinity();
  }
  return gap;
}

namespace {

/// Values made smooth by the least of the neighbours, then by means, at the wall nodes where columns stand.
std::vector<double> smooth(NodeGraph const& graph, std::vector<double> const& whole, std::vector<double> const& most) {
  constexpr int sweeps_of_least = 3, sweeps_of_mean = 20;
  std::vector<Index32> walls;
  std::vector<double> end = whole;
  for (std::size_t n = 0; n < end.size(); ++n)
    if (end[n] > 0) {
      walls.push_back(Index32(n));
      end[n] = std::min(end[n], most[n]);
    }
  std::vector<double> next = end;
  for (int s = 0; s < sweeps_of_least + sweeps_of_mean; ++s) {
    for (Index32 const n : walls) {
      double sum = end[n], least = sum;
      int count = 1;
      for (Index32 const m : graph.neighbours[n])
        if (whole[m] > 0) {
          sum += end[m];
          least = std::min(least, end[m]);
          ++count;
        }
      next[n] = s < sweeps_of_least ? least : sum / count;
    }
    std::swap(end, next);
  }
  return end;
}

}  // namespace

ColumnEnds smooth_ends(NodeGraph const& graph, Columns const& columns, std::vector<double> const& most,
                       std::vector<double> const& longest) {
  ColumnEnds out{smooth(graph, columns.height, most), smooth(graph, columns.full_rise, most)};
  auto const shorten = [&](std::size_t n, double share, ColumnEnds const& of) {
    out.height[n] = share * of.height[n];
    out.rise[n] = share * of.rise[n];
  };
  ColumnEnds const whole{columns.height, columns.full_rise};
  for (std::size_t n = 0; n < out.height.size(); ++n)
    if (columns.height[n] > 0 && columns.full_rise[n] > 0)
      shorten(n, std::max(out.height[n] / columns.height[n], out.rise[n] / columns.full_rise[n]), whole);
  if (longest.empty()) return out;
  auto const held = smooth(graph, out.height, longest);
  ColumnEnds const before = out;
  for (std::size_t n = 0; n < held.size(); ++n)
    if (before.height[n] > held[n]) shorten(n, held[n] / before.height[n], before);
  return out;
}

Columns kept_nodes(Columns const& columns, std::function<bool(std::size_t)> const& keep) {
  Columns out;
  out.height = columns.height;
  out.full_rise = columns.full_rise;
  for (std::size_t k = 0; k < columns.node.size(); ++k) {
    if (!keep(k)) continue;
    out.node.push_back(columns.node[k]);
    out.root.push_back(columns.root[k]);
    out.below.push_back(columns.below[k]);
    out.above_wall.push_back(columns.above_wall[k]);
    out.rise.push_back(columns.rise[k]);
  }
  return out;
}

Columns cut(Columns const& columns, ColumnEnds const& ends) {
  // Ends are means of what neighbours have: columns that all end alike must not lose their ends to round-off.
  constexpr double allowed = 1e-3;
  std::vector<double> below(ends.height.size(), 0), risen = below;
  Columns out = kept_nodes(columns, [&](std::size_t k) {
    std::size_t const root = std::size_t(columns.root[k]);
    double const above = columns.above_wall[k], layer = above - std::exchange(below[root], above);
    double const rise = columns.rise[k], step = rise - std::exchange(risen[root], rise);
    return !(above > ends.height[root] + allowed * layer && rise > ends.rise[root] + allowed * step);
  });
  out.height = ends.height;
  out.full_rise = ends.rise;
  return out;
}

}  // namespace gridmorph
