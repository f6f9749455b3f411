// Places in an order that neither numbers nor round-off decide.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>

namespace gridmorph {

/// An order of nodes by x, y and z in steps of a share of the largest extent, a millionth unless told, then by what the
/// steps leave. Where several nodes would do, the first of them is taken: numbered anew, in another unit, or with
/// coordinates that are off by round-off, it is the same one. Steps begin and end off round numbers, where meshes have
/// their nodes.
class PlaceOrder {
 public:
  /// The order of these nodes. Keeps a reference. Cost O(n).
  explicit PlaceOrder(Coordinates const& coordinates, double share = 1.13e-6) : x_(coordinates) {
    for (Index n = 0; n < coordinates.size(); ++n) {
      Vec3 const p = coordinates[n];
      low_ = n == 0 ? p : Vec3{std::min(low_.x, p.x), std::min(low_.y, p.y), std::min(low_.z, p.z)};
      high_ = n == 0 ? p : Vec3{std::max(high_.x, p.x), std::max(high_.y, p.y), std::max(high_.z, p.z)};
    }
    Vec3 const size = high_ - low_;
    double const largest = std::max({size.x, size.y, size.z});
    if (largest > 0) step_ = share * largest;
  }

  /// Whether node a comes before node b.
  [[nodiscard]] bool operator()(Index32 a, Index32 b) const { return (*this)(x_[a], a, x_[b], b); }
  /// Whether one of any two places comes before the other; numbers tell those apart that are the same.
  [[nodiscard]] bool operator()(Vec3 const& p, Index32 a, Vec3 const& q, Index32 b) const {
    auto const s = steps(p), t = steps(q);
    if (s != t) return s < t;
    return std::tie(p.x, p.y, p.z, a) < std::tie(q.x, q.y, q.z, b);
  }
  [[nodiscard]] double step() const { return step_; }
  /// The number of the step that a place is in, per axis.
  [[nodiscard]] std::array<std::int64_t, 3> steps(Vec3 const& p) const {
    auto const count = [&](double x, double low) { return std::int64_t(std::floor((x - low) / step_ + 0.3819)); };
    return {count(p.x, low_.x), count(p.y, low_.y), count(p.z, low_.z)};
  }
  /// A length in steps, but for round-off.
  [[nodiscard]] double rounded_steps(double length) const { return rounded(length / step_); }
  /// A number rounded to 16 bits, one that round-off does not change, but for those at its steps, which no ratio of
  /// small integers is at.
  [[nodiscard]] static double rounded(double a) {
    if (!std::isfinite(a) || a == 0) return a;
    // The same by the bits of the number, 52 of which are behind the leading one: 15 stay.
    if (a >= std::numeric_limits<double>::min()) {
      constexpr std::uint64_t step = std::uint64_t(1) << 37, share = std::uint64_t(0.3819 * double(step) + 0.5);
      return std::bit_cast<double>((std::bit_cast<std::uint64_t>(a) + share) & ~(step - 1));
    }
    int exponent = 0;
    double const mantissa = std::frexp(a, &exponent);
    return std::ldexp(std::floor(mantissa * 0x1p16 + 0.3819), exponent - 16);
  }

 private:
  Coordinates const& x_;
  Vec3 low_, high_;
  double step_ = 1;
};

}  // namespace gridmorph
