#include <gridmorph/plan/elements/wall_distance.hpp>

#include <limits>

namespace gridmorph {

NearestSource nearest_source(Coordinates const& coordinates, NodeGraph const& graph,
                             std::vector<Index32> const& sources) {
  NearestSource out;
  std::size_t const n = std::size_t(graph.size());
  out.source.assign(n, -1);
  out.distance.assign(n, std::numeric_limits<double>::infinity());
  std::vector<Index32> order;
  order.reserve(n);
  for (Index32 const s : sources)
    if (out.source[std::size_t(s)] < 0) {
      out.source[std::size_t(s)] = s;
      out.distance[std::size_t(s)] = 0;
      order.push_back(s);
    }
  std::size_t const first = order.size();
  std::vector<std::uint8_t> listed(n, 0);
  for (Index32 const s : order) listed[std::size_t(s)] = 1;

  auto const improve = [&](Index32 at) {
    Vec3 const x = coordinates[at];
    for (Index32 const m : graph.neighbours[at]) {
      Index32 const s = out.source[std::size_t(m)];
      if (s < 0 || s == out.source[std::size_t(at)]) continue;
      double const d = distance(x, coordinates[s]);
      if (d < out.distance[std::size_t(at)] ||
          (d == out.distance[std::size_t(at)] && s < out.source[std::size_t(at)])) {
        out.distance[std::size_t(at)] = d;
        out.source[std::size_t(at)] = s;
      }
    }
  };
  for (std::size_t k = 0; k < order.size(); ++k) {
    Index32 const at = order[k];
    if (k >= first) improve(at);
    for (Index32 const m : graph.neighbours[at])
      if (!listed[std::size_t(m)]) {
        listed[std::size_t(m)] = 1;
        order.push_back(m);
      }
  }
  for (std::size_t k = order.size(); k-- > first;) improve(order[k]);
  for (std::size_t k = first; k < order.size(); ++k) improve(order[k]);
  return out;
}

}  // namespace gridmorph
