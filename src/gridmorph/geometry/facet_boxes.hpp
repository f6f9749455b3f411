// The tree over facets.
#pragma once

#include <gridmorph/kernels/facet_tree.hpp>

#include <array>
#include <utility>
#include <vector>

namespace gridmorph {

/// Boxes over facets, and the order in which their leaves list them: order[n] is the facet at place n. Halved
/// along the longest side of the box of their centres, so that the depth is that of a balanced tree, whatever they are.
/// Depends on positions alone, ties on facet numbers. Cost O(n log n).
struct FacetBoxes {
  std::vector<kernels::FacetBox> boxes;
  std::vector<int> order;

  FacetBoxes() = default;
  /// Corners of the facets, four or (the last is -1) three.
  FacetBoxes(std::vector<Vec3> const& points, std::vector<std::array<int, 4>> const& facets);

  /// Calls look(facet) in about the order of the distances of the facets' boxes from p, as long as those are not larger
  /// than limit(), the square of the best distance so far. Host.
  template <class Look, class Limit>
  void for_each_nearer(Vec3 const& p, Look const& look, Limit const& limit) const {
    for_each_nearer(look, limit, [&](int box) { return boxes[box].distance2(p); });
  }
  /// The same with squares of distances, or less, of one's own: away2(box).
  template <class Look, class Limit, class Away>
  void for_each_nearer(Look const& look, Limit const& limit, Away const& away2) const {
    // One per level that was passed, and two.
    std::array<std::pair<double, int>, kernels::FacetTreeView::max_depth + 1> waiting;
    std::size_t n_waiting = 0;
    auto const wait = [&](std::pair<double, int> const& at) {
      if (!(at.first > limit())) waiting[n_waiting++] = at;
    };
    auto const at = [&](int box) { return std::pair{double(away2(box)), box}; };
    if (!boxes.empty()) wait(at(0));
    while (n_waiting > 0) {
      auto const [away, b] = waiting[--n_waiting];
      if (away > limit()) continue;
      kernels::FacetBox const& box = boxes[b];
      for (int n = box.first; n < box.first + box.count; ++n) look(order[n]);
      if (box.count > 0) continue;
      // The nearer one is looked at first.
      auto const one = at(box.first), other = at(box.first + 1);
      wait(one.first < other.first ? other : one);
      wait(one.first < other.first ? one : other);
    }
  }
};

}  // namespace gridmorph
