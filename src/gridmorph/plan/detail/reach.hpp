// Which array elements an affine index reaches.
#pragma once

#include <gridmorph/core/index.hpp>

#include <algorithm>

namespace gridmorph::detail {

/// Smallest and largest value of first + stride * step + ..., each step in its own range. Safe for any numbers: sums
/// that leave +-2^60 are within nothing.
class Reach {
 public:
  explicit Reach(Index first) : low_(first), high_(first), valid_(first >= -bound && first <= bound) {}

  /// Adds stride * step for from <= step <= to, both in [0, 2^31).
  Reach& along(Index stride, Index from, Index to) {
    valid_ = valid_ && (to == 0 || (stride >= -bound / to && stride <= bound / to));
    if (!valid_) return *this;
    low_ += std::min(stride * from, stride * to);
    high_ += std::max(stride * from, stride * to);
    valid_ = low_ >= -bound && high_ <= bound;
    return *this;
  }
  /// For n steps from 0.
  Reach& along(Index stride, Index n) { return along(stride, 0, n - 1); }
  [[nodiscard]] bool within(Index begin, Index end) const { return valid_ && low_ >= begin && high_ < end; }

 private:
  static constexpr Index bound = Index(1) << 60;
  Index low_, high_;
  bool valid_;
};

}  // namespace gridmorph::detail
