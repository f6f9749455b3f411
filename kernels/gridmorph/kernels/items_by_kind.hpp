// Items of several kinds. A kernel that leaves out what its items have not needs a fraction of the registers, and so a
// GPU runs several times as many of them at once: there items are sorted by kind and each kind has a kernel. The host
// has one kernel for all.
#pragma once

#include <gridmorph/kernels/launch.hpp>

#include <cstddef>
#include <utility>

namespace gridmorph::kernels {

/// Ascending items, those of kind k from first[k] to first[k + 1]; what has no kind comes before, with the first.
/// Kind: an enumeration whose last is `any`.
template <class Kind>
struct ItemsByKind {
  static constexpr int n_kinds = int(Kind::any) + 1;
  Index first[n_kinds + 1] = {};

  /// Counts n more of a kind.
  void add(Kind kind, Index n) {
    for (int k = int(kind) + 1; k <= n_kinds; ++k) first[k] += n;
  }
};

/// kernel(item) of all items; on a GPU by kernel.of_kind<k>(), whose results for items of kind k are the same.
template <class Exec, class Kind, class Kernel>
void launch_by_kind(char const* label, Exec const& exec, ItemsByKind<Kind> const& items, Kernel const& kernel) {
  constexpr int n_kinds = ItemsByKind<Kind>::n_kinds;
  if constexpr (TileShape<Exec>::host) {
    launch(label, exec, 0, items.first[n_kinds], kernel);
  } else {
    auto const each = [&]<std::size_t... k>(std::index_sequence<k...>) {
      (launch(label, exec, k == 0 ? 0 : items.first[k], items.first[k + 1], kernel.template of_kind<Kind(k)>()), ...);
    };
    each(std::make_index_sequence<n_kinds>());
  }
}

}  // namespace gridmorph::kernels
