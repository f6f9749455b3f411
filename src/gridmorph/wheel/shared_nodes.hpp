// Nodes that coincide in a wheel: within a passage, and between neighbouring ones.
#pragma once

#include <gridmorph/wheel/rows.hpp>

#include <vector>

namespace gridmorph {

/// The nodes of all links, in groups. Node n of passage p is the same point of
/// the wheel as every other node m of its group in passage p + offset(n) -
/// offset(m). Passages count upwards with the pitch of their row.
class SharedNodes {
 public:
  struct Member {
    Index node = 0;
    int group = 0;
    int offset = 0;
  };

  /// periodic = false: plain links alone, so that all offsets are zero. Cost: O(n log n) in the nodes of links.
  SharedNodes(PassageLinks const& links, WheelRows const& rows, bool periodic);

  [[nodiscard]] std::vector<Member> const& members() const { return members_; }  ///< ascending by node
  [[nodiscard]] int n_groups() const { return int(on_axis_.size()); }
  /// A point on the axis: it is the same in every passage, and offsets mean nothing.
  [[nodiscard]] bool on_axis(int group) const { return on_axis_[group] != 0; }
  /// nullptr for nodes of no link.
  [[nodiscard]] Member const* find(Index node) const;

 private:
  std::vector<Member> members_;
  std::vector<char> on_axis_;
};

}  // namespace gridmorph
