#include <gridmorph/motion/target/edge_images.hpp>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace gridmorph {

namespace {

void measure(FeatureLoop& loop, std::vector<Vec3> const& points) {
  Vec3 sum;
  for (std::size_t n = 0; n < loop.vertices.size(); ++n) {
    Vec3 const& a = points[loop.vertices[n]];
    Vec3 const& b = points[loop.vertices[(n + 1) % loop.vertices.size()]];
    loop.length += distance(a, b);
    sum += (0.5 * distance(a, b)) * (a + b);
  }
  loop.middle = loop.length > 0 ? (1 / loop.length) * sum : points[loop.vertices.front()];
}

bool alike(FeatureLoop const& a, FeatureLoop const& b) {
  return a.boundary == b.boundary && a.length < 2 * b.length && b.length < 2 * a.length;
}

double squared_distance(FeatureLoop const& a, FeatureLoop const& b) {
  return dot(b.middle - a.middle, b.middle - a.middle);
}

std::vector<int> nearest_first(std::vector<FeatureLoop> const& from, std::vector<FeatureLoop> const& to,
                               double farthest) {
  struct Pair {
    double cost;
    int own, other;
  };
  std::vector<Pair> pairs;
  for (std::size_t a = 0; a < from.size(); ++a)
    for (std::size_t b = 0; b < to.size(); ++b)
      if (double const cost = squared_distance(from[a], to[b]); alike(from[a], to[b]) && cost <= farthest * farthest)
        pairs.push_back({cost, int(a), int(b)});
  std::sort(pairs.begin(), pairs.end(), [](Pair const& a, Pair const& b) {
    return a.cost != b.cost ? a.cost < b.cost : a.own != b.own ? a.own < b.own : a.other < b.other;
  });
  std::vector<int> partner(from.size(), -1);
  std::vector<char> taken(to.size(), 0);
  for (Pair const& pair : pairs) {
    if (partner[pair.own] >= 0 || taken[pair.other] != 0) continue;
    partner[pair.own] = pair.other;
    taken[pair.other] = 1;
  }
  return partner;
}

/// Exchanges the partners of two loops where that brings them nearer together; whether it did.
bool exchange(std::vector<FeatureLoop> const& from, std::vector<FeatureLoop> const& to, int& one, int& other,
              std::size_t a, std::size_t b) {
  if (one < 0 || other < 0) return false;
  FeatureLoop const &p = to[one], &q = to[other];
  if (!alike(from[a], q) || !alike(from[b], p)) return false;
  double const now = squared_distance(from[a], p) + squared_distance(from[b], q);
  double const then = squared_distance(from[a], q) + squared_distance(from[b], p);
  constexpr double rounding = 1e-12;
  if (!(then < (1 - rounding) * now)) return false;
  std::swap(one, other);
  return true;
}

}  // namespace

std::vector<FeatureLoop> feature_loops(std::vector<Vec3> const& points, std::vector<std::vector<int>> const& neighbours,
                                       std::function<bool(int a, int b)> const& is_boundary) {
  std::vector<FeatureLoop> out;
  for (FeatureChain& chain : feature_chains(neighbours, std::vector<char>(neighbours.size(), 0))) {
    if (!chain.closed() || neighbours[chain.vertices.front()].size() != 2) continue;
    FeatureLoop loop;
    loop.boundary = is_boundary(chain.vertices[0], chain.vertices[1]);
    chain.vertices.pop_back();
    loop.vertices = std::move(chain.vertices);
    measure(loop, points);
    out.push_back(std::move(loop));
  }
  return out;
}

std::vector<int> pair_loops(std::vector<FeatureLoop> const& from, std::vector<FeatureLoop> const& to, double farthest) {
  std::vector<int> partner = nearest_first(from, to, farthest);
  bool exchanged = from.size() <= 2000;
  for (int pass = 0; exchanged && pass < 20; ++pass) {
    exchanged = false;
    for (std::size_t a = 0; a < partner.size(); ++a)
      for (std::size_t b = 0; b < a; ++b) exchanged = exchange(from, to, partner[a], partner[b], a, b) || exchanged;
  }
  return partner;
}

}  // namespace gridmorph
