#include <gridmorph/plan/layers.hpp>

#include <algorithm>
#include <cmath>

namespace gridmorph {

namespace {

struct Source {
  double weight;
  Index32 node;
};

/// The sources of largest weight as a row.
void add_row(Index32 node, std::vector<Source>& sources, int most_items, InterpolationOperator& rows) {
  std::sort(sources.begin(), sources.end(), [](Source const& a, Source const& b) {
    return a.weight > b.weight || (a.weight == b.weight && a.node < b.node);
  });
  if (int(sources.size()) > most_items) sources.resize(std::size_t(most_items));
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
                      std::function<double(Index32, Index32)> const& weight, int most_items) {
  constexpr int never = -1;
  std::size_t const n = std::size_t(graph.size());
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
           (distance[std::size_t(a)] == distance[std::size_t(b)] && a < b);
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
      if (nearest < 0 || distance[std::size_t(m)] < distance[std::size_t(nearest)]) nearest = m;
      double const edge = gridmorph::distance(coordinates[node], coordinates[m]);
      if (distance[std::size_t(m)] > distance[std::size_t(node)] - edge / 3) continue;
      sources.push_back({weight(node, m), m});
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
    add_row(node, sources, most_items, rows);
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
