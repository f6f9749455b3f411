// Things that are joined two by two: which hang together.
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace gridmorph {

/// Sets of the numbers 0, 1, ...; each is known by its smallest member, its root. Cost per call: O(log n), in practice
/// O(1).
template <class Number>
class DisjointSets {
 public:
  /// Sets of `count` numbers, every number alone in its own.
  explicit DisjointSets(std::size_t count) : root_(count) { std::iota(root_.begin(), root_.end(), Number(0)); }
  /// Sets as they are in another object, from its roots().
  explicit DisjointSets(std::vector<Number> roots) : root_(std::move(roots)) {}

  [[nodiscard]] Number root(Number n) {
    while (root_[n] != n) n = root_[n] = root_[root_[n]];
    return n;
  }
  void join(Number a, Number b) {
    auto const [low, high] = std::minmax({root(a), root(b)});
    root_[high] = low;
  }
  /// The root of every number.
  [[nodiscard]] std::vector<Number> roots() {
    for (std::size_t n = 0; n < root_.size(); ++n) root_[n] = root(Number(n));
    return root_;
  }
  /// The number of the set of every number; sets are counted from 0 in the order of their roots.
  [[nodiscard]] std::vector<Number> set_numbers() {
    std::vector<Number> out(root_.size());
    Number count = 0;
    for (std::size_t n = 0; n < out.size(); ++n) {
      Number const r = root(Number(n));
      out[n] = r == Number(n) ? count++ : out[r];
    }
    return out;
  }

 private:
  std::vector<Number> root_;
};

}  // namespace gridmorph
