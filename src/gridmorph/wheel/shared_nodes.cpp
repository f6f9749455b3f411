#include <gridmorph/wheel/shared_nodes.hpp>

#include <algorithm>
#include <numeric>

namespace gridmorph {

namespace {

/// Union-find whose members know how many passages they are ahead of their root: (n, p) is the point (root, p +
/// offset).
class Unions {
 public:
  explicit Unions(std::size_t n) : parent_(n), offset_(n, 0), axis_(n, 0) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  struct Place {
    int root, offset;
  };
  Place find(int n) {
    int root = n, offset = 0;
    while (parent_[root] != root) {
      offset += offset_[root];
      root = parent_[root];
    }
    for (int m = n, rest = offset; m != root;) {  // path compression
      int const next = parent_[m], step = offset_[m];
      parent_[m] = root;
      offset_[m] = rest;
      rest -= step;
      m = next;
    }
    return {root, offset};
  }

  /// (a, p) is (b, p - pitches).
  void join(int a, int b, int pitches, RowPitch const& pitch) {
    Place const x = find(a), y = find(b);
    int const shift = y.offset - pitches - x.offset;  // (root of a, t) is (root of b, t + shift)
    if (x.root == y.root) {
      if (!pitch.comes_round(shift)) axis_[x.root] = 1;
      return;
    }
    // The smaller number stays the root, so that the result does not depend on the order of the links.
    if (y.root < x.root) {
      parent_[x.root] = y.root;
      offset_[x.root] = shift;
      axis_[y.root] |= axis_[x.root];
    } else {
      parent_[y.root] = x.root;
      offset_[y.root] = -shift;
      axis_[x.root] |= axis_[y.root];
    }
  }
  [[nodiscard]] char axis(int root) const { return axis_[root]; }

 private:
  std::vector<int> parent_, offset_;
  std::vector<char> axis_;
};

}  // namespace

SharedNodes::SharedNodes(PassageLinks const& links, WheelRows const& rows, bool periodic) {
  std::vector<Index> nodes;
  for (PassageLink const& link : links.all)
    if (periodic || !link.periodic)
      for (auto const& pair : link.pairs) nodes.push_back(pair[0]);
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  auto const number = [&](Index n) { return int(std::lower_bound(nodes.begin(), nodes.end(), n) - nodes.begin()); };

  Unions unions(nodes.size());
  for (std::size_t l = 0; l < links.all.size(); ++l) {
    PassageLink const& link = links.all[l];
    if (link.periodic && !periodic) continue;
    RowPitch const& pitch = rows.rows[rows.row_of_zone[link.zone]].pitch;
    for (auto const& [own, donor] : link.pairs) unions.join(number(own), number(donor), rows.pitches_of_link[l], pitch);
  }

  std::vector<int> group(nodes.size(), -1);
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    auto const [root, offset] = unions.find(int(n));
    if (group[root] < 0) {
      group[root] = int(on_axis_.size());
      on_axis_.push_back(unions.axis(root));
    }
    members_.push_back({nodes[n], group[root], offset});
  }
}

SharedNodes::Member const* SharedNodes::find(Index node) const {
  auto const at =
      std::lower_bound(members_.begin(), members_.end(), node, [](Member const& m, Index n) { return m.node < n; });
  return at != members_.end() && at->node == node ? &*at : nullptr;
}

}  // namespace gridmorph
