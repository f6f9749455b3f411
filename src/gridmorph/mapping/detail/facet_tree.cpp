#include <gridmorph/mapping/detail/facet_tree.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

namespace gridmorph::casefile {

namespace {

constexpr std::int32_t leaf_size = 4;
/// Halving a list of 2^31 facets needs fewer levels; every level leaves at most one box to visit.
constexpr std::size_t deepest = 64;

double component(Vec3 const& v, int c) { return c == 0 ? v.x : c == 1 ? v.y : v.z; }
Vec3 smaller(Vec3 const& a, Vec3 const& b) { return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}; }
Vec3 larger(Vec3 const& a, Vec3 const& b) { return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}; }

}  // namespace

double FacetTree::Box::squared_distance(Vec3 const& q) const {
  auto const outside = [](double v, double from, double to) { return std::max({from - v, v - to, 0.0}); };
  double const x = outside(q.x, low.x, high.x), y = outside(q.y, low.y, high.y), z = outside(q.z, low.z, high.z);
  return x * x + y * y + z * z;
}

// A bilinear surface lies inside the hull of its corners, so that boxes around corners hold the elements.
FacetTree::FacetTree(std::vector<FacetShape> facets, std::vector<std::vector<Vec3>> const& corners)
    : facets_(std::move(facets)), order_(facets_.size()) {
  std::vector<Vec3> low, high;
  for (auto const& points : corners) {
    low.push_back(points.front());
    high.push_back(points.front());
    for (Vec3 const& p : points) {
      low.back() = smaller(low.back(), p);
      high.back() = larger(high.back(), p);
    }
  }
  std::iota(order_.begin(), order_.end(), 0);
  build(low, high, 0, std::int32_t(order_.size()));
}

std::int32_t FacetTree::build(std::vector<Vec3> const& low, std::vector<Vec3> const& high, std::int32_t begin,
                              std::int32_t end) {
  Box box;
  box.begin = begin;
  box.end = end;
  box.low = low[order_[begin]];
  box.high = high[order_[begin]];
  for (std::int32_t n = begin; n < end; ++n) {
    box.low = smaller(box.low, low[order_[n]]);
    box.high = larger(box.high, high[order_[n]]);
  }
  std::int32_t const number = std::int32_t(boxes_.size());
  boxes_.push_back(box);
  if (end - begin <= leaf_size) return number;
  Vec3 const size = box.high - box.low;
  int const axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  std::int32_t const middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](std::int32_t a, std::int32_t b) {
                     double const ca = component(low[a], axis) + component(high[a], axis);
                     double const cb = component(low[b], axis) + component(high[b], axis);
                     return ca != cb ? ca < cb : a < b;
                   });
  std::int32_t const left = build(low, high, begin, middle), right = build(low, high, middle, end);
  boxes_[number].left = left;
  boxes_[number].right = right;
  return number;
}

FacetTree::Hit FacetTree::closest(Vec3 const& q) const {
  Hit best;
  best.point.squared = std::numeric_limits<double>::max();
  std::array<std::int32_t, 2 * deepest> waiting{};
  std::size_t n_waiting = 1;
  while (n_waiting > 0) {
    Box const& box = boxes_[waiting[--n_waiting]];
    if (box.squared_distance(q) > best.point.squared) continue;
    if (box.left < 0) {
      for (std::int32_t n = box.begin; n < box.end; ++n) {
        FacetPoint const p = facets_[order_[n]].closest(q);
        if (p.squared < best.point.squared || (p.squared == best.point.squared && order_[n] < best.facet))
          best = {order_[n], p};
      }
      continue;
    }
    bool const left_first = boxes_[box.left].squared_distance(q) <= boxes_[box.right].squared_distance(q);
    waiting[n_waiting++] = left_first ? box.right : box.left;
    waiting[n_waiting++] = left_first ? box.left : box.right;
  }
  return best;
}

}  // namespace gridmorph::casefile
