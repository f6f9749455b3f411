// Values along the span of a blade.
#pragma once

#include <array>
#include <vector>

namespace gridmorph {

/// Values along the span at given span fractions, between them cubic Hermite pieces with slopes from parabolas through
/// three neighbours: C1, exact at the given span fractions. Beyond the ends: the end values.
class SpanTable {
 public:
  /// Axial position, then the three components of the motion (axial, radial, angle).
  using Value = std::array<double, 4>;

  /// Appends a station; span must be larger than the one before.
  void add(double span, Value const& value) {
    span_.push_back(span);
    value_.push_back(value);
  }
  [[nodiscard]] Value at(double span) const;
  [[nodiscard]] std::vector<Value> const& values() const { return value_; }

 private:
  [[nodiscard]] double slope(int n, int component) const;

  std::vector<double> span_;
  std::vector<Value> value_;
};

}  // namespace gridmorph
