#include <gridmorph/motion/detail/surface_relaxation.hpp>

#include <algorithm>
#include <limits>
#include <utility>

namespace gridmorph {

namespace {

constexpr int most_sweeps = 200;
constexpr double damping = 0.7;   // of 1; undamped sweeps leave what alternates from node to node as it is
constexpr double at_rest = 1e-3;  // of the distance to the nearest neighbour

struct Neighbour {
  int vertex;
  double weight;
};

/// Neighbours along grid lines, with weights that sum to one; none for nodes whose neighbours all lie on them.
std::vector<std::vector<Neighbour>> neighbours_of(PatchSurface const& surface) {
  std::vector<std::vector<Neighbour>> out(surface.points.size());
  auto const join = [&](int a, int b) {
    double const apart = distance(surface.points[a], surface.points[b]);
    if (!(apart > 0)) return;
    out[a].push_back({b, 1 / apart});
    out[b].push_back({a, 1 / apart});
  };
  for (PatchGrid const& grid : surface.grids)
    for (int b = 0; b < grid.extent[1]; ++b)
      for (int a = 0; a < grid.extent[0]; ++a) {
        if (a + 1 < grid.extent[0]) join(grid.at(a, b), grid.at(a + 1, b));
        if (b + 1 < grid.extent[1]) join(grid.at(a, b), grid.at(a, b + 1));
      }
  for (auto& list : out) {
    std::sort(list.begin(), list.end(), [](Neighbour const& m, Neighbour const& n) { return m.vertex < n.vertex; });
    auto const same = [](Neighbour const& m, Neighbour const& n) { return m.vertex == n.vertex; };
    list.erase(std::unique(list.begin(), list.end(), same), list.end());
    double sum = 0;
    for (Neighbour const& n : list) sum += n.weight;
    for (Neighbour& n : list) n.weight /= sum;
  }
  return out;
}

}  // namespace

std::vector<Vec3> relax(PatchSurface const& surface, std::vector<char> const& known, std::vector<Vec3> const& wanted,
                        std::vector<Vec3> start, std::function<Vec3(int vertex, Vec3 const& point)> const& place) {
  auto const neighbours = neighbours_of(surface);
  std::size_t const n_points = surface.points.size();
  std::vector<double> rest(n_points, 0);
  for (std::size_t v = 0; v < n_points; ++v) {
    double nearest = std::numeric_limits<double>::infinity();
    for (Neighbour const& n : neighbours[v])
      nearest = std::min(nearest, distance(surface.points[v], surface.points[n.vertex]));
    rest[v] = neighbours[v].empty() ? 0 : at_rest * nearest;
  }
  std::vector<Vec3> added(n_points), asked(n_points), out = std::move(start);
  for (std::size_t v = 0; v < n_points; ++v) added[v] = out[v] - wanted[v];
  // What was asked for last is placed already.
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    bool moving = false;
    std::vector<Vec3> const before = added;
    for (std::size_t v = 0; v < n_points; ++v) {
      if (known[v] != 0 || neighbours[v].empty()) continue;
      Vec3 mean;
      for (Neighbour const& n : neighbours[v]) mean += n.weight * before[n.vertex];
      Vec3 const ask = (1 - damping) * before[v] + damping * mean;
      if (sweep > 0 && distance(ask, asked[v]) <= 0.1 * rest[v]) continue;
      asked[v] = ask;
      Vec3 const at = place(int(v), wanted[v] + ask);
      moving = moving || distance(at, out[v]) > rest[v];
      out[v] = at;
      added[v] = at - wanted[v];
    }
    if (!moving) break;
  }
  return out;
}

}  // namespace gridmorph
