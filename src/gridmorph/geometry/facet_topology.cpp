#include <gridmorph/geometry/facet_topology.hpp>

#include <gridmorph/core/error.hpp>
#include <gridmorph/geometry/point_numbers.hpp>
#include <gridmorph/kernels/box_tree.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <string>
#include <tuple>

namespace gridmorph {
namespace {

bool before(Vec3 const& a, Vec3 const& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }

void check(FacetList const& list) {
  for (std::size_t f = 0; f < list.facets.size(); ++f)
    for (int q = 0; q < 4; ++q) {
      int const c = list.facets[f][q];
      if ((c < 0 || c >= int(list.points.size())) && !(q == 3 && c == -1))
        throw MotionError("facet " + std::to_string(f + 1) + " names the point " + std::to_string(c + 1) + " of " +
                          std::to_string(list.points.size()) + "; correct the list of facets");
    }
  for (std::size_t n = 0; n < list.points.size(); ++n)
    if (Vec3 const& p = list.points[n]; !std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
      throw MotionError("point " + std::to_string(n + 1) + " of a surface is not finite; correct its coordinates");
}

/// The representative of each point: the first in lexicographic order of those that coincide.
std::vector<int> coincident(FacetList const& list, double tolerance) {
  std::size_t const n = list.points.size();
  // Never across more than a tenth of an edge, however small the edges are.
  std::vector<double> reach(n, tolerance);
  for (auto const& facet : list.facets) {
    int const size = facet[3] < 0 ? 3 : 4;
    for (int q = 0; q < size; ++q) {
      int const a = facet[q], b = facet[(q + 1) % size];
      double const length = distance(list.points[a], list.points[b]);
      if (length == 0) continue;
      for (int const end : {a, b}) reach[end] = std::min(reach[end], 0.1 * length);
    }
  }
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return before(list.points[a], list.points[b]); });

  PointNumbers kept(tolerance);
  std::vector<int> representative(n);
  for (int const i : order) {
    int found = -1;
    kept.for_each_near(list.points[i], [&](Vec3 const& p, int k) {
      double const apart = distance(p, list.points[i]);
      bool const one = apart == 0 || apart <= std::min(reach[i], reach[k]);
      if (one && (found < 0 || before(p, list.points[found]))) found = k;
    });
    representative[i] = found < 0 ? i : found;
    if (found < 0) kept.add(list.points[i], i);
  }
  return representative;
}

/// The corners of a facet without repeated ones, starting at the lowest number and going towards the lower of its
/// neighbours; fewer than three corners: empty.
std::vector<int> in_order(std::vector<int> corners) {
  for (std::size_t q = 0; q < corners.size() && corners.size() > 1;)
    if (corners[q] == corners[(q + 1) % corners.size()])
      corners.erase(corners.begin() + std::ptrdiff_t(q));
    else
      ++q;
  if (corners.size() < 3 || (corners.size() == 4 && (corners[0] == corners[2] || corners[1] == corners[3]))) return {};
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  if (corners.back() < corners[1]) std::reverse(corners.begin() + 1, corners.end());
  return corners;
}

}  // namespace

FacetTopology::FacetTopology(FacetList const& list, FacetOptions const& options) {
  check(list);
  weld(list, options.weld);
  find_edges();
  orient();
  find_creases(options.crease_angle_rad);
}

Vec3 FacetTopology::area(int facet) const {
  auto const& c = facets[facet];
  return cross(points[c[2]] - points[c[0]], points[c[3] < 0 ? c[2] : c[3]] - points[c[1]]);
}

void FacetTopology::weld(FacetList const& list, double relative) {
  Box box;
  for (Vec3 const& p : list.points) box.include(p);
  double const size = list.points.empty() ? 0 : distance(box.low, box.high);
  std::vector<int> const representative = coincident(list, relative * size);
  std::vector<int> kept;
  std::vector<char> used(list.points.size(), 0);
  for (auto const& facet : list.facets)
    for (int const c : facet)
      if (c >= 0) used[representative[c]] = 1;
  for (int n = 0; n < int(list.points.size()); ++n)
    if (used[n]) kept.push_back(n);
  std::sort(kept.begin(), kept.end(), [&](int a, int b) { return before(list.points[a], list.points[b]); });
  std::vector<int> number(list.points.size(), -1);
  for (int const n : kept) {
    number[n] = int(points.size());
    points.push_back(list.points[n]);
  }
  std::vector<std::pair<std::vector<int>, int>> good;
  for (int f = 0; f < int(list.facets.size()); ++f) {
    std::vector<int> corners;
    for (int const c : list.facets[f])
      if (c >= 0) corners.push_back(number[representative[c]]);
    if (corners = in_order(std::move(corners)); !corners.empty()) good.emplace_back(std::move(corners), f);
  }
  std::sort(good.begin(), good.end());
  good.erase(std::unique(good.begin(), good.end(), [](auto const& a, auto const& b) { return a.first == b.first; }),
             good.end());
  for (auto const& [c, number_in_list] : good) {
    facets.push_back({c[0], c[1], c[2], c.size() == 4 ? c[3] : -1});
    source.push_back(number_in_list);
  }
  if (facets.empty())
    throw MotionError("of " + std::to_string(list.facets.size()) +
                      " facets none has an area; a surface needs at least one triangle or quadrilateral");
}

void FacetTopology::find_edges() {
  struct Use {
    int low, high, facet, place;
  };
  std::vector<Use> uses;
  facets_of_point.resize(points.size());
  edges_of_point.resize(points.size());
  for (int f = 0; f < int(facets.size()); ++f)
    for (int q = 0; q < n_corners(f); ++q) {
      int const a = facets[f][q], b = facets[f][(q + 1) % n_corners(f)];
      uses.push_back({std::min(a, b), std::max(a, b), f, q});
      facets_of_point[a].push_back(f);
    }
  std::sort(uses.begin(), uses.end(), [](Use const& a, Use const& b) {
    return std::tie(a.low, a.high, a.facet, a.place) < std::tie(b.low, b.high, b.facet, b.place);
  });
  edges_of_facet.assign(facets.size(), {-1, -1, -1, -1});
  for (std::size_t m = 0; m < uses.size();) {
    std::size_t end = m;
    while (end < uses.size() && uses[end].low == uses[m].low && uses[end].high == uses[m].high) ++end;
    int const number = int(edges.size());
    FacetEdge edge{{uses[m].low, uses[m].high}, {-1, -1}, {-1, -1}};
    for (std::size_t k = m; k < end; ++k) {
      edges_of_facet[uses[k].facet][uses[k].place] = number;
      if (end - m > 2) continue;
      edge.facet[k - m] = uses[k].facet;
      edge.place[k - m] = uses[k].place;
    }
    for (int const p : edge.point) edges_of_point[p].push_back(number);
    edges.push_back(edge);
    m = end;
  }
}

void FacetTopology::orient() {
  // Turned facets have their edges renumbered at the end; until then `turned` says how they run.
  std::vector<char> seen(facets.size(), 0), turned(facets.size(), 0);
  std::vector<int> pending;
  for (int seed = 0; seed < int(facets.size()); ++seed) {
    if (seen[seed]) continue;
    seen[seed] = 1;
    pending.push_back(seed);
    while (!pending.empty()) {
      int const f = pending.back();
      pending.pop_back();
      for (int q = 0; q < n_corners(f); ++q) {
        FacetEdge const& edge = edges[edges_of_facet[f][q]];
        if (edge.facet[1] < 0) continue;
        int const side = edge.facet[0] == f ? 1 : 0, g = edge.facet[side];
        if (seen[g]) continue;
        seen[g] = 1;
        bool const alike = facets[f][q] == facets[g][edge.place[side]];  // both run the same way along their edge
        turned[g] = char(turned[f] ^ char(alike));
        pending.push_back(g);
      }
    }
  }
  for (int f = 0; f < int(facets.size()); ++f) {
    if (!turned[f]) continue;
    int const size = n_corners(f);
    std::reverse(facets[f].begin() + 1, facets[f].begin() + size);
    std::reverse(edges_of_facet[f].begin(), edges_of_facet[f].begin() + size);
    for (int q = 0; q < size; ++q) {
      FacetEdge& edge = edges[edges_of_facet[f][q]];
      for (int side = 0; side < 2; ++side)
        if (edge.facet[side] == f) edge.place[side] = q;
    }
  }
}

void FacetTopology::find_creases(double angle_rad) {
  double const least = std::cos(angle_rad);
  for (FacetEdge& edge : edges) {
    if (edge.facet[1] < 0) continue;
    Vec3 const a = area(edge.facet[0]), b = area(edge.facet[1]);
    double const sizes = norm(a) * norm(b);
    // Not orientable: the two run alike along the edge.
    bool const alike = facets[edge.facet[0]][edge.place[0]] == facets[edge.facet[1]][edge.place[1]];
    edge.crease = alike || (sizes > 0 && dot(a, b) < least * sizes);
  }
}

}  // namespace gridmorph
