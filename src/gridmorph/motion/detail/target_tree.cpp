#include <gridmorph/motion/detail/target_tree.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace gridmorph {

namespace {

constexpr int most_in_leaf = 4;

double component(Vec3 const& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

double squared_distance(Vec3 const& p, Vec3 const& lo, Vec3 const& hi) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    double const v = component(p, axis);
    double const d = std::max({component(lo, axis) - v, v - component(hi, axis), 0.0});
    sum += d * d;
  }
  return sum;
}

}  // namespace

Vec3 closest_on_triangle(Vec3 const& p, Vec3 const& a, Vec3 const& b, Vec3 const& c) {
  Vec3 const ab = b - a, ac = c - a, ap = p - a;
  double const d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  Vec3 const bp = p - b;
  double const d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  double const vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + (d1 / (d1 - d3)) * ab;
  Vec3 const cp = p - c;
  double const d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  double const vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + (d2 / (d2 - d6)) * ac;
  double const va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return b + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (c - b);
  double const share = 1 / (va + vb + vc);
  return a + (vb * share) * ab + (vc * share) * ac;
}

TargetTree::TargetTree(std::vector<Vec3> points, std::vector<std::array<int, 3>> triangles)
    : points_(std::move(points)), triangles_(std::move(triangles)), order_(triangles_.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  std::vector<Vec3> centres;
  centres.reserve(triangles_.size());
  for (auto const& t : triangles_) centres.push_back((1.0 / 3) * (points_[t[0]] + points_[t[1]] + points_[t[2]]));
  if (!triangles_.empty()) build(0, int(triangles_.size()), centres);
}

int TargetTree::build(int begin, int end, std::vector<Vec3> const& centres) {
  int const own = int(boxes_.size());
  Vec3 lo = points_[triangles_[order_[begin]][0]], hi = lo, first = centres[order_[begin]], last = first;
  for (int n = begin; n < end; ++n) {
    Vec3 const& m = centres[order_[n]];
    first = {std::min(first.x, m.x), std::min(first.y, m.y), std::min(first.z, m.z)};
    last = {std::max(last.x, m.x), std::max(last.y, m.y), std::max(last.z, m.z)};
    for (int const v : triangles_[order_[n]]) {
      Vec3 const& p = points_[v];
      lo = {std::min(lo.x, p.x), std::min(lo.y, p.y), std::min(lo.z, p.z)};
      hi = {std::max(hi.x, p.x), std::max(hi.y, p.y), std::max(hi.z, p.z)};
    }
  }
  boxes_.push_back({lo, hi, begin, end, -1});
  if (end - begin <= most_in_leaf) return own;
  Vec3 const extent = last - first;
  int const axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  int const middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end, [&](int a, int b) {
    return std::pair(component(centres[a], axis), a) < std::pair(component(centres[b], axis), b);
  });
  build(begin, middle, centres);
  int const right = build(middle, end, centres);
  boxes_[own].right = right;
  return own;
}

Vec3 TargetTree::normal(int triangle) const {
  auto const& t = triangles_[triangle];
  return cross(points_[t[1]] - points_[t[0]], points_[t[2]] - points_[t[0]]);
}

template <class Accept>
TargetTree::Hit TargetTree::search(Vec3 const& p, Accept const& accept) const {
  Hit best;
  double nearest = std::numeric_limits<double>::infinity();
  std::vector<std::pair<double, int>> waiting;
  if (!boxes_.empty()) waiting.emplace_back(squared_distance(p, boxes_[0].lo, boxes_[0].hi), 0);
  while (!waiting.empty()) {
    auto const [away, b] = waiting.back();
    waiting.pop_back();
    if (away > nearest) continue;
    Box const& box = boxes_[b];
    if (box.right >= 0) {
      int const left = b + 1, right = box.right;
      double const dl = squared_distance(p, boxes_[left].lo, boxes_[left].hi);
      double const dr = squared_distance(p, boxes_[right].lo, boxes_[right].hi);
      if (dl < dr) {
        waiting.emplace_back(dr, right);
        waiting.emplace_back(dl, left);
      } else {
        waiting.emplace_back(dl, left);
        waiting.emplace_back(dr, right);
      }
      continue;
    }
    for (int n = box.begin; n < box.end; ++n) {
      int const t = order_[n];
      if (!accept(t)) continue;
      auto const& [i, j, k] = triangles_[t];
      Vec3 const q = closest_on_triangle(p, points_[i], points_[j], points_[k]);
      double const d = dot(q - p, q - p);
      if (d < nearest || (d == nearest && t < best.triangle)) {
        nearest = d;
        best = {t, q, 0};
      }
    }
  }
  if (best.triangle >= 0) best.distance = std::sqrt(nearest);
  return best;
}

TargetTree::Hit TargetTree::closest(Vec3 const& p) const {
  return search(p, [](int) { return true; });
}

TargetTree::Hit TargetTree::closest_of(Vec3 const& p, std::function<bool(int triangle)> const& accept) const {
  return search(p, accept);
}

TargetTree::Hit TargetTree::closest_facing(Vec3 const& p, Vec3 const& direction) const {
  return search(p, [&](int t) { return dot(normal(t), direction) > 0; });
}

}  // namespace gridmorph
