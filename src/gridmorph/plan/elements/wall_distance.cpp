#include <gridmorph/plan/elements/wall_distance.hpp>
#include <gridmorph/plan/place_order.hpp>

#include <limits>

namespace gridmorph {

namespace {

/// What a node knows of its nearest source.
struct Found {
  Index32 source = -1;
  double distance = std::numeric_limits<double>::infinity();
};

}  // namespace

NearestSource nearest_source(Coordinates const& coordinates, NodeGraph const& graph,
                             std::vector<Index32> const& sources) {
  NearestSource out;
  std::size_t const n = std::size_t(graph.size());
  out.source.assign(n, -1);
  out.distance.assign(n, std::numeric_limits<double>::infinity());
  PlaceOrder const is_before(coordinates);
  auto const best_of_neighbours = [&](Index32 at) {
    Found best{out.source[std::size_t(at)], out.distance[std::size_t(at)]};
    Vec3 const x = coordinates[at];
    for (Index32 const m : graph.neighbours[at]) {
      Index32 const s = out.source[std::size_t(m)];
      if (s < 0 || s == best.source) continue;
      double const d = distance(x, coordinates[s]);
      // Sources as far but for round-off go by their places.
      constexpr double clear = 1e-4;
      if (d > best.distance * (1 + clear)) continue;
      if (d < best.distance * (1 - clear) || PlaceOrder::is_less(d, best.distance) ||
          (!PlaceOrder::is_less(best.distance, d) && is_before(s, best.source)))
        best = {s, d};
    }
    return best;
  };
  // All nodes of a sweep look at what was known before it.
  std::vector<Index32> at, next;
  std::vector<Found> found;
  std::vector<std::uint8_t> listed(n, 0);
  auto const take = [&] {
    for (std::size_t k = 0; k < at.size(); ++k) {
      out.source[std::size_t(at[k])] = found[k].source;
      out.distance[std::size_t(at[k])] = found[k].distance;
    }
  };
  for (Index32 const s : sources)
    if (out.source[std::size_t(s)] < 0) {
      out.source[std::size_t(s)] = s;
      out.distance[std::size_t(s)] = 0;
      listed[std::size_t(s)] = 1;
      at.push_back(s);
    }
  std::vector<Index32> all;
  while (!at.empty()) {
    next.clear();
    for (Index32 const node : at)
      for (Index32 const m : graph.neighbours[node])
        if (!listed[std::size_t(m)]) {
          listed[std::size_t(m)] = 1;
          next.push_back(m);
        }
    std::swap(at, next);
    found.clear();
    for (Index32 const node : at) found.push_back(best_of_neighbours(node));
    take();
    all.insert(all.end(), at.begin(), at.end());
  }
  // Then those beside which something became known, until nothing does.
  at = all;
  listed.assign(n, 0);
  while (!at.empty()) {
    next.clear();
    found.clear();
    for (Index32 const node : at)
      if (Found const best = best_of_neighbours(node); best.source != out.source[std::size_t(node)]) {
        next.push_back(node);
        found.push_back(best);
      }
    std::swap(at, next);
    take();
    next.clear();
    for (Index32 const node : at)
      for (Index32 const m : graph.neighbours[node])
        if (out.distance[std::size_t(m)] > 0 && !listed[std::size_t(m)]) {
          listed[std::size_t(m)] = 1;
          next.push_back(m);
        }
    for (Index32 const node : next) listed[std::size_t(node)] = 0;
    std::swap(at, next);
  }
  return out;
}

}  // namespace gridmorph
