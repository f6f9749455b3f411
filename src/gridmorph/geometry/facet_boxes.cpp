#include <gridmorph/geometry/facet_boxes.hpp>

#include <algorithm>
#include <numeric>

namespace gridmorph {
namespace {

double component(Vec3 const& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

void include(Vec3 const& p, Vec3& low, Vec3& high) {
  low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
  high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
}

}  // namespace

FacetBoxes::FacetBoxes(std::vector<Vec3> const& points, std::vector<Facet> const& facets) : order(facets.size()) {
  constexpr int per_leaf = 4;
  std::iota(order.begin(), order.end(), 0);
  std::vector<Vec3> centre;
  for (Facet const& f : facets) {
    Vec3 sum;
    for (int q = 0; q < f.n_corners(); ++q) sum += points[f.corner[q]];
    centre.push_back((1.0 / f.n_corners()) * sum);
  }
  struct Part {
    int box, begin, end;
  };
  std::vector<Part> pending{{0, 0, int(facets.size())}};
  boxes.resize(1);
  while (!pending.empty()) {
    auto const [number, begin, end] = pending.back();
    pending.pop_back();
    Vec3 const start = points[facets[order[begin]].corner[0]];
    FacetBox box{start, start, begin, end - begin};
    Vec3 low = centre[order[begin]], high = low;
    for (int n = begin; n < end; ++n) {
      Facet const& f = facets[order[n]];
      for (int q = 0; q < f.n_corners(); ++q) include(points[f.corner[q]], box.low, box.high);
      include(centre[order[n]], low, high);
    }
    if (end - begin > per_leaf) {
      Vec3 const extent = high - low;
      int axis = extent.y > extent.x ? 1 : 0;
      if (extent.z > component(extent, axis)) axis = 2;
      int const middle = begin + (end - begin) / 2;
      std::nth_element(order.begin() + begin, order.begin() + middle, order.begin() + end, [&](int a, int b) {
        double const x = component(centre[a], axis), y = component(centre[b], axis);
        return x != y ? x < y : a < b;
      });
      box.first = int(boxes.size());
      box.count = 0;
      pending.push_back({box.first, begin, middle});
      pending.push_back({box.first + 1, middle, end});
      boxes.resize(boxes.size() + 2);
    } else {
      std::sort(order.begin() + begin, order.begin() + end);
    }
    boxes[number] = box;
  }
}

}  // namespace gridmorph
