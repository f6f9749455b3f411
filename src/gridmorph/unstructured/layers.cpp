#include <gridmorph/unstructured/layers.hpp>

#include <algorithm>
#include <array>

namespace gridmorph {

LayerRows make_layers(NodeGraph const& graph, std::vector<std::uint8_t> const& seeds,
                      std::vector<std::uint8_t> const& wanted, std::function<double(Number, Number)> const& weight,
                      int most_layers, int most_items) {
  LayerRows out;
  std::size_t const n = std::size_t(graph.size());
  constexpr int never = -1;
  std::vector<int> layer(n, never);
  std::vector<Number> front;
  for (std::size_t k = 0; k < n; ++k)
    if (seeds[k]) {
      layer[k] = 0;
      front.push_back(Number(k));
    }
  struct Source {
    double weight;
    Number node;
  };
  std::vector<Source> sources;
  std::vector<Number> items;
  std::vector<double> weights;
  for (int l = 1; l <= most_layers && !front.empty(); ++l) {
    std::vector<Number> next;
    for (Number const at : front)
      for (Number const m : graph.neighbours[at])
        if (layer[std::size_t(m)] == never && wanted[std::size_t(m)]) {
          layer[std::size_t(m)] = l;
          next.push_back(m);
        }
    std::sort(next.begin(), next.end());
    for (Number const node : next) {
      sources.clear();
      for (Number const m : graph.neighbours[node])
        if (layer[std::size_t(m)] == l - 1) sources.push_back({weight(node, m), m});
      std::sort(sources.begin(), sources.end(), [](Source const& a, Source const& b) {
        return a.weight > b.weight || (a.weight == b.weight && a.node < b.node);
      });
      if (int(sources.size()) > most_items) sources.resize(std::size_t(most_items));
      items.clear();
      weights.clear();
      for (Source const& s : sources) {
        items.push_back(s.node);
        weights.push_back(s.weight);
      }
      out.rows.add(node, items, weights);
    }
    if (!next.empty()) out.level.push_back(out.rows.size());
    front = std::move(next);
  }
  return out;
}

}  // namespace gridmorph
