#include <gridmorph/geometry/target_tree.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace gridmorph {

Vec3 closest_on_triangle(Vec3 const& p, Vec3 const& a, Vec3 const& b, Vec3 const& c) {
  double to_b = 0, to_c = 0;
  nearest_on_triangle(p, a, b, c, to_b, to_c);
  // Along a side from one of its ends, so that corners come back to the bit.
  if (to_c == 0) return to_b == 0 ? a : to_b == 1 ? b : a + to_b * (b - a);
  if (to_c == 1) return c;
  if (to_b == 0) return a + to_c * (c - a);
  if (to_b == 1 - to_c) return b + to_c * (c - b);
  return a + to_b * (b - a) + to_c * (c - a);
}

TargetTree::TargetTree(std::vector<Vec3> points, std::vector<std::array<int, 3>> triangles)
    : points_(std::move(points)), triangles_(std::move(triangles)) {
  std::vector<std::array<int, 4>> facets;
  for (auto const& t : triangles_) facets.push_back({t[0], t[1], t[2], -1});
  tree_ = FacetBoxes(points_, facets);
}

Vec3 TargetTree::normal(int triangle) const {
  auto const& t = triangles_[triangle];
  return cross(points_[t[1]] - points_[t[0]], points_[t[2]] - points_[t[0]]);
}

template <class Accept>
TargetTree::Hit TargetTree::search(Vec3 const& p, Accept const& accept, double within) const {
  Hit best;
  double nearest = within * within;
  auto const look = [&](int t) {
    if (!accept(t)) return;
    auto const& [i, j, k] = triangles_[t];
    Vec3 const q = closest_on_triangle(p, points_[i], points_[j], points_[k]);
    double const d = dot(q - p, q - p);
    if (d < nearest || (d == nearest && t < best.triangle)) {
      nearest = d;
      best = {t, q, 0};
    }
  };
  tree_.for_each_nearer(p, look, [&] { return nearest; });
  if (best.triangle >= 0) best.distance = std::sqrt(nearest);
  return best;
}

TargetTree::Hit TargetTree::closest(Vec3 const& p) const {
  return search(p, [](int) { return true; });
}

TargetTree::Hit TargetTree::closest_within(Vec3 const& p, double distance) const {
  return search(
      p, [](int) { return true; }, distance);
}

TargetTree::Hit TargetTree::closest_of(Vec3 const& p, std::function<bool(int triangle)> const& accept) const {
  return search(p, accept);
}

TargetTree::Hit TargetTree::closest_facing(Vec3 const& p, Vec3 const& direction) const {
  return search(p, [&](int t) { return dot(normal(t), direction) > 0; });
}

}  // namespace gridmorph
