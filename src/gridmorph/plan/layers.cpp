#include <gridmorph/core/sort_keys.hpp>
#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/plan/layers.hpp>
#include <gridmorph/plan/make_rows.hpp>
#include <gridmorph/plan/place_order.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

namespace gridmorph {

namespace {

struct Source {
  double weight;
  Index32 node;
};

/// How much a source counts by how far it is below, over the length of the edge: not at all up to 0.28, whole from 0.38
/// on. Without a step, so that round-off in coordinates stays small.
double share_of_slope(double slope) {
  double const s = std::clamp((slope - 0.28) / 0.1, 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

/// The source of largest weight first: the one that a row keeps in double precision.
void add_row(Index32 node, PlaceOrder const& is_before, std::vector<Source>& sources, InterpolationOperator& rows) {
  double largest = 0;
  for (Source const& s : sources) largest = std::max(largest, s.weight);
  // Shares of the largest have no unit.
  std::sort(sources.begin(), sources.end(), [&](Source const& a, Source const& b) {
    double const v = PlaceOrder::rounded(a.weight / largest), w = PlaceOrder::rounded(b.weight / largest);
    return v > w || (v == w && is_before(a.node, b.node));
  });
  double sum = 0;
  for (Source const& s : sources) sum += s.weight;
  rows.target.push_back(node);
  for (Source const& s : sources) {
    rows.item.push_back(s.node);
    rows.weight.push_back(float(s.weight / sum));
  }
  rows.first.push_back(Index(rows.item.size()));
}

/// A number that grows with `a`.
std::uint64_t sort_key(double a) {
  constexpr std::uint64_t sign = std::uint64_t(1) << 63;
  auto const bits = std::bit_cast<std::uint64_t>(a + 0.0);  // zeros have one sign
  return (bits & sign) != 0 ? ~bits : bits | sign;
}

/// Nodes in the order of their distance, then of their place.
std::vector<Index32> sorted(HostInstance const& host, std::vector<Index32> const& nodes,
                            std::vector<double> const& distance, PlaceOrder const& is_before) {
  std::vector<Index32> out(nodes.size());
  host.visit([&](auto const& exec) {
    detail::KeyedIndices<Kokkos::HostSpace> const list(nodes.size(), "gridmorph::make_layers");
    detail::for_all(host, "gridmorph::make_layers::keys", std::ssize(nodes), [&](Index k) {
      list.number(k) = nodes[k];
      list.key(k) = sort_key(distance[nodes[k]]);
    });
    auto const by_key = detail::sort_keys(exec, list);
    compat::fence(exec, "gridmorph::make_layers (read by the host)");
    std::copy_n(by_key.number.data(), nodes.size(), out.begin());
    for (std::size_t begin = 0, end; begin < out.size(); begin = end) {
      for (end = begin + 1; end < out.size() && by_key.key(end) == by_key.key(begin); ++end) {
      }
      if (end - begin > 1) std::sort(out.begin() + std::ptrdiff_t(begin), out.begin() + std::ptrdiff_t(end), is_before);
    }
  });
  return out;
}

/// The order in which nodes get their rows.
struct Turns {
  static constexpr Index32 never = std::numeric_limits<Index32>::max();
  std::vector<Index32> node;  ///< one after another
  std::vector<Index32> of;    ///< (n_nodes) 0: a seed; 1 + place in `node`
};

/// Nodes from near to far, each when a neighbour has had its turn: one that lies nearest among its neighbours though it
/// is no seed (the straight way to its wall leads through other walls) waits for them.
Turns take_turns(NodeGraph const& graph, std::vector<std::uint8_t> const& seeds, std::vector<Index32> order) {
  Turns out;
  out.of.resize(seeds.size());
  for (std::size_t n = 0; n < seeds.size(); ++n) out.of[n] = seeds[n] != 0 ? 0 : Turns::never;
  out.node.reserve(order.size());
  while (!order.empty()) {
    std::vector<Index32> waiting;
    for (Index32 const node : order) {
      auto const around = graph.neighbours[node];
      if (std::any_of(around.begin(), around.end(), [&](Index32 m) { return out.of[m] != Turns::never; })) {
        out.node.push_back(node);
        out.of[node] = Index32(out.node.size());
      } else {
        waiting.push_back(node);
      }
    }
    if (waiting.size() == order.size()) break;
    order = std::move(waiting);
  }
  return out;
}

}  // namespace

LayerRows make_layers(HostInstance const& host, NodeGraph const& graph, Coordinates const& coordinates,
                      std::vector<std::uint8_t> const& seeds, std::vector<std::uint8_t> const& wanted,
                      std::vector<double> const& distance, std::function<double(Index32, Index32)> const& weight) {
  PlaceOrder const is_before(coordinates);
  std::vector<Index32> nodes;
  for (std::size_t n = 0; n < std::size_t(graph.size()); ++n)
    if (!seeds[n] && wanted[n] && std::isfinite(distance[n])) nodes.push_back(Index32(n));
  Turns const turns = take_turns(graph, seeds, sorted(host, nodes, distance, is_before));
  // From neighbours that had their turn before.
  auto const make = [&, sources = std::vector<Source>()](Index k, InterpolationOperator& out) mutable {
    Index32 const node = turns.node[k];
    sources.clear();
    Index32 nearest = -1;
    double least = 0;
    for (Index32 const m : graph.neighbours[node]) {
      if (turns.of[m] > k) continue;
      double const away = is_before.rounded_steps(distance[m]);
      if (nearest < 0 || away < least || (away == least && is_before(m, nearest))) {
        nearest = m;
        least = away;
      }
      double const edge = gridmorph::distance(coordinates[node], coordinates[m]);
      double const share = share_of_slope((distance[node] - distance[m]) / edge);
      if (share > 0) sources.push_back({share * weight(node, m), m});
    }
    if (sources.empty()) sources.push_back({1, nearest});
    add_row(node, is_before, sources, out);
  };
  InterpolationOperator const rows = make_rows(host, "gridmorph::make_layers::rows", std::ssize(turns.node), make);
  // A row's layer follows the highest one of its sources, whose rows come before it.
  std::vector<int> layer(seeds.size(), 0);
  std::vector<Index> count{0};
  for (Index r = 0; r < rows.size(); ++r) {
    int highest = 0;
    for (Index k = rows.first[r]; k < rows.first[r + 1]; ++k) highest = std::max(highest, layer[rows.item[k]]);
    layer[rows.target[r]] = highest + 1;
    if (highest + 1 == std::ssize(count)) count.push_back(0);
    ++count[highest + 1];
  }
  LayerRows out;
  out.level.resize(count.size());
  std::partial_sum(count.begin(), count.end(), out.level.begin());
  // Rows layer by layer, each in the order of distance.
  std::vector<Index> next(out.level.begin(), out.level.end()), order(std::size_t(rows.size()));
  for (Index r = 0; r < rows.size(); ++r) order[next[std::size_t(layer[rows.target[r]]) - 1]++] = r;
  out.rows = gathered(host, rows, order);
  return out;
}

}  // namespace gridmorph
