#include <gridmorph/plan/layers.hpp>
#include <gridmorph/plan/place_order.hpp>

#include <algorithm>
#include <cmath>

namespace gridmorph {

namespace {

struct Source {
  double weight;
  Index32 node;
};

/// How much a source counts by how far it is below, over the length of the edge: not at all up to 0.28, whole from 0.38 on. Without a step, so
/// that round-off in coordinates stays small.
double share_of_slope(double slope) {
  double const s = std::clamp((slope - 0.28) / 0.1, 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

/// The source of largest weight first: the one that a row keeps in double precision.
void add_row(Index32 node, PlaceOrder const& is_before, std::vector<Source>& sources, InterpolationOperator& rows) {
  std::sort(sources.begin(), sources.end(), [&](Source const& a, Source const& b) {
    double const v = PlaceOrder::rounded(a.weight), w = PlaceOrder::rounded(b.weight);
    return v > w || (v == w && is_before(a.node, b.node));
  });
  std::vector<Index32> items;
  std::vector<double> weights;
  for (Source const& s : sources) {
    items.push_back(s.node);
    weights.push_back(s.weight);
  }
  rows.add(node, items, weights);
}

}  // namespace

LayerRows make_layers(NodeGraph const& graph, Coordinates const& coordinates, std::vector<std::uint8_t> const& seeds,
                      std::vector<std::uint8_t> const& wanted, std::vector<double> const& distance,
                      std::function<double(Index32, Index32)> const& weight) {
  constexpr int never = -1;
  std::size_t const n = std::size_t(graph.size());
  PlaceOrder const is_before(coordinates);
  std::vector<int> layer(n, never);
  std::vector<Index32> order;
  for (std::size_t k = 0; k < n; ++k) {
    if (seeds[k])
      layer[k] = 0;
    else if (wanted[k] && std::isfinite(distance[k]))
      order.push_back(Index32(k));
  }
  std::sort(order.begin(), order.end(), [&](Index32 a, Index32 b) {
    return distance[std::size_t(a)] < distance[std::size_t(b)] ||
           (distance[std::size_t(a)] == distance[std::size_t(b)] && is_before(a, b));
  });
  InterpolationOperator rows;
  std::vector<int> row_layer;
  std::vector<Source> sources;
  int last = 0;
  auto const try_node = [&](Index32 node) {
    sources.clear();
    int highest = 0;
    Index32 nearest = -1;
    for (Index32 const m : graph.neighbours[node]) {
      // Nodes that come later in the order have no layer yet.
      if (layer[std::size_t(m)] == never) continue;
      if (nearest < 0 || PlaceOrder::is_less(distance[std::size_t(m)], distance[std::size_t(nearest)]) ||
          (!PlaceOrder::is_less(distance[std::size_t(nearest)], distance[std::size_t(m)]) && is_before(m, nearest)))
        nearest = m;
      double const edge = gridmorph::distance(coordinates[node], coordinates[m]);
      double const share = share_of_slope((distance[std::size_t(node)] - distance[std::size_t(m)]) / edge);
      if (share <= 0) continue;
      sources.push_back({share * weight(node, m), m});
      highest = std::max(highest, layer[std::size_t(m)]);
    }
    if (sources.empty() && nearest >= 0) {
      sources.push_back({1, nearest});
      highest = layer[std::size_t(nearest)];
    }
    if (sources.empty()) return false;
    layer[std::size_t(node)] = highest + 1;
    last = std::max(last, highest + 1);
    row_layer.push_back(highest + 1);
    add_row(node, is_before, sources, rows);
    return true;
  };
  // A node that lies nearest among its neighbours though it is no seed (the straight way to its wall leads through other walls)
  // waits for them.
  while (!order.empty()) {
    std::vector<Index32> waiting;
    for (Index32 const node : order)
      if (!try_node(node)) waiting.push_back(node);
    if (waiting.size() == order.size()) break;
    order = std::move(waiting);
  }
  // Rows layer by layer, each in the order of distance.
  std::vector<std::vector<Index>> rows_of(std::size_t(last) + 1);
  for (Index r = 0; r < rows.size(); ++r) rows_of[std::size_t(row_layer[std::size_t(r)])].push_back(r);
  LayerRows out;
  for (int l = 1; l <= last; ++l) {
    for (Index const r : rows_of[std::size_t(l)]) {
      out.rows.target.push_back(rows.target[std::size_t(r)]);
      auto const from = rows.first[std::size_t(r)], to = rows.first[std::size_t(r) + 1];
      out.rows.item.insert(out.rows.item.end(), rows.item.begin() + from, rows.item.begin() + to);
      out.rows.weight.insert(out.rows.weight.end(), rows.weight.begin() + from, rows.weight.begin() + to);
      out.rows.first.push_back(Index(out.rows.item.size()));
    }
    out.level.push_back(out.rows.size());
  }
  return out;
}

}  // namespace gridmorph
