#include <gridmorph/motion/target/feature_edges.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

namespace gridmorph {

namespace {

constexpr double sharp_turn = 0.7071067811865476;  // cosine of 45 degrees

/// One side of a facet; it runs from a to b if `forward`.
struct Side {
  int a, b, facet;
  bool forward;
};

}  // namespace

std::vector<FeatureEdge> find_feature_edges(std::vector<Vec3> const& points, std::vector<GridFacet> const& facets,
                                            double crease_angle_deg) {
  std::vector<Side> sides;
  for (std::size_t n = 0; n < facets.size(); ++n) {
    int const corners = facets[n][3] < 0 ? 3 : 4;
    for (int c = 0; c < corners; ++c) {
      int const a = facets[n][c], b = facets[n][(c + 1) % corners];
      sides.push_back({std::min(a, b), std::max(a, b), int(n), a < b});
    }
  }
  std::sort(sides.begin(), sides.end(), [](Side const& s, Side const& t) {
    return s.a != t.a ? s.a < t.a : s.b != t.b ? s.b < t.b : s.facet < t.facet;
  });
  double const flat = std::cos(crease_angle_deg * std::numbers::pi / 180);
  std::vector<FeatureEdge> edges;
  for (std::size_t begin = 0; begin < sides.size();) {
    std::size_t end = begin + 1;
    while (end < sides.size() && sides[end].a == sides[begin].a && sides[end].b == sides[begin].b) ++end;
    bool feature = end - begin != 2;
    if (!feature) {
      Side const &s = sides[begin], &t = sides[begin + 1];
      Vec3 const n = facet_normal(points, facets[s.facet]), m = facet_normal(points, facets[t.facet]);
      double const sense =
          s.forward == t.forward ? -1 : 1;  // neighbours that turn alike run opposite ways along the side
      double const lengths = norm(n) * norm(m);
      feature = lengths > 0 && sense * dot(n, m) < flat * lengths;
    }
    if (feature) edges.push_back({sides[begin].a, sides[begin].b, end - begin == 1});
    begin = end;
  }
  return edges;
}

std::vector<std::vector<int>> feature_neighbours(std::size_t n_points, std::vector<FeatureEdge> const& edges) {
  std::vector<std::vector<int>> out(n_points);
  for (FeatureEdge const& e : edges) {
    out[e.a].push_back(e.b);
    out[e.b].push_back(e.a);
  }
  return out;
}

bool turns_sharply(std::vector<Vec3> const& points, std::vector<std::vector<int>> const& neighbours, int vertex) {
  auto const& n = neighbours[vertex];
  if (n.size() != 2) return false;
  Vec3 const in = points[vertex] - points[n[0]], out = points[n[1]] - points[vertex];
  return dot(in, out) < sharp_turn * norm(in) * norm(out);
}

std::vector<FeatureChain> feature_chains(std::vector<std::vector<int>> const& neighbours,
                                         std::vector<char> const& corner) {
  std::set<std::pair<int, int>> used;
  std::vector<FeatureChain> chains;
  auto const ends = [&](int v) { return neighbours[v].size() != 2 || corner[v] != 0; };
  auto const walk = [&](int start, int next) {
    if (!used.insert(std::minmax(start, next)).second) return;
    FeatureChain chain{{start, next}};
    while (!ends(next) && next != start) {
      auto const& n = neighbours[next];
      int const before = chain.vertices[chain.vertices.size() - 2];
      int const after = n[0] == before ? n[1] : n[0];
      used.insert(std::minmax(next, after));
      chain.vertices.push_back(next = after);
    }
    chains.push_back(std::move(chain));
  };
  for (int v = 0; v < int(neighbours.size()); ++v)
    if (ends(v))
      for (int const n : neighbours[v]) walk(v, n);
  for (int v = 0; v < int(neighbours.size()); ++v)
    if (!ends(v)) walk(v, neighbours[v][0]);
  return chains;
}

}  // namespace gridmorph
