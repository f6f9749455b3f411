#include <gridmorph/geometry/facet_boxes.hpp>
#include <gridmorph/kernels/box_tree.hpp>
#include <gridmorph/kernels/vec3.hpp>

#include <algorithm>
#include <numeric>

namespace gridmorph {
namespace {

int n_corners(std::array<int, 4> const& facet) { return facet[3] < 0 ? 3 : 4; }

}  // namespace

FacetBoxes::FacetBoxes(std::vector<Vec3> const& points, std::vector<std::array<int, 4>> const& facets)
    : order(facets.size()) {
  if (facets.empty()) return;
  constexpr int per_leaf = 4;
  std::iota(order.begin(), order.end(), 0);
  std::vector<Vec3> centre;
  for (auto const& f : facets) {
    Vec3 sum;
    for (int q = 0; q < n_corners(f); ++q) sum += points[f[q]];
    centre.push_back((1.0 / n_corners(f)) * sum);
  }
  struct Part {
    int box, begin, end;
  };
  std::vector<Part> pending{{0, 0, int(facets.size())}};
  boxes.resize(1);
  while (!pending.empty()) {
    auto const [number, begin, end] = pending.back();
    pending.pop_back();
    Box of_corners, of_centres;
    for (int n = begin; n < end; ++n) {
      auto const& f = facets[order[n]];
      for (int q = 0; q < n_corners(f); ++q) of_corners.include(points[f[q]]);
      of_centres.include(centre[order[n]]);
    }
    kernels::FacetBox box{of_corners.low, of_corners.high, begin, end - begin};
    if (end - begin > per_leaf) {
      Vec3 const extent = of_centres.high - of_centres.low;
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
