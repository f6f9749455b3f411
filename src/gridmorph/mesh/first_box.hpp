// Which of several boxes that may overlap is the first to hold an index (i, j, k); internal.
#pragma once

#include <gridmorph/core/index.hpp>

#include <span>
#include <vector>

namespace gridmorph::detail {

/// A region divided by planes until each piece is in one box, or in none: of boxes that overlap the earlier one has
/// what they share.
///
/// Cost: n boxes that lie beside one another, with planes or layers in common, take O(n) memory and O(n log^2 n) time,
/// a look-up O(log n). Boxes that cross one another can take more, up to the pieces that their planes cut them into.
class FirstBox {
 public:
  static constexpr int none = -1;

  /// Boxes are named by their places in the list; what lies outside of the region does not count.
  FirstBox(IndexRange const& region, std::span<IndexRange const> boxes);

  /// The first box that holds p, or none.
  [[nodiscard]] int operator()(Index3 const& p) const;
  /// Calls f(box, piece) for pieces that together make up `range`, a part of the region, in an order that depends on
  /// the boxes alone.
  template <class Function>
  void visit(IndexRange const& range, Function const& f) const {
    if (range.size() > 0) visit(0, range, f);
  }

 private:
  /// A plane between the indices below and those from `plane` on, or a box.
  struct Node {
    int axis;          ///< of the plane; none: a box, or none
    int plane_or_box;  ///< the lower side follows its node
    int upper;         ///< node of the upper side
  };

  void divide(IndexRange const& region, std::vector<int> const& boxes, std::span<IndexRange const> all);

  template <class Function>
  void visit(int n, IndexRange const& range, Function const& f) const {
    auto const [axis, plane_or_box, upper] = nodes_[n];
    if (axis == none) return f(plane_or_box, range);
    if (range.end[axis] <= plane_or_box) return visit(n + 1, range, f);
    if (range.begin[axis] >= plane_or_box) return visit(upper, range, f);
    IndexRange below = range, above = range;
    below.end[axis] = above.begin[axis] = plane_or_box;
    visit(n + 1, below, f);
    visit(upper, above, f);
  }

  IndexRange region_;
  std::vector<Node> nodes_;
};

}  // namespace gridmorph::detail
