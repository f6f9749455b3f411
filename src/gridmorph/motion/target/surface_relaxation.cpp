#include <gridmorph/motion/target/surface_spread.hpp>

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

/// Neighbours along the surface, with weights that sum to one; none for nodes whose neighbours all lie on them.
std::vector<std::vector<Neighbour>> neighbours_of(PatchSurface const& surface) {
  auto const next = surface.neighbours();
  std::vector<std::vector<Neighbour>> out(surface.points.size());
  for (std::size_t v = 0; v < out.size(); ++v) {
    double sum = 0;
    for (int const n : next[v])
      if (double const apart = distance(surface.points[v], surface.points[n]); apart > 0) {
        out[v].push_back({n, 1 / apart});
        sum += 1 / apart;
      }
    for (Neighbour& n : out[v]) n.weight /= sum;
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
