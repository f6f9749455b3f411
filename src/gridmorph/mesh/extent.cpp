#include <gridmorph/core/for_all.hpp>
#include <gridmorph/mesh/extent.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace gridmorph {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

/// Least and greatest of one component, in several independent lanes so that the loop can be vectorised.
class Range {
 public:
  static constexpr int lanes = 8;
  void take(int lane, double v) {
    low_[lane] = v < low_[lane] ? v : low_[lane];
    high_[lane] = v > high_[lane] ? v : high_[lane];
  }
  [[nodiscard]] double low() const { return *std::min_element(low_.begin(), low_.end()); }
  [[nodiscard]] double high() const { return *std::max_element(high_.begin(), high_.end()); }
  Range() {
    low_.fill(inf);
    high_.fill(-inf);
  }

 private:
  std::array<double, lanes> low_{}, high_{};
};

MeshExtent extent_of(Coordinates const& c, Index begin, Index end) {
  double const *const x = c.x.data(), *const y = c.y.data(), *const z = c.z.data();
  constexpr int lanes = Range::lanes;
  Range rx, ry, rz;
  // 0 * v is zero for finite v and NaN otherwise, and sums keep a NaN.
  std::array<double, lanes> zero{};
  auto const take = [&](int l, Index n) {
    rx.take(l, x[n]);
    ry.take(l, y[n]);
    rz.take(l, z[n]);
    zero[std::size_t(l)] += 0 * (x[n] + y[n] + z[n]);
  };
  Index n = begin;
  for (; n + lanes <= end; n += lanes)
    for (int l = 0; l < lanes; ++l) take(l, n + l);
  for (; n < end; ++n) take(0, n);
  return {{rx.low(), ry.low(), rz.low()},
          {rx.high(), ry.high(), rz.high()},
          std::all_of(zero.begin(), zero.end(), [](double v) { return v == 0; })};
}

}  // namespace

bool is_usable(Vec3 const& p) {
  // Not-a-number is no larger, and no smaller, than anything.
  return std::fabs(p.x) <= coordinate_limit && std::fabs(p.y) <= coordinate_limit && std::fabs(p.z) <= coordinate_limit;
}

bool MeshExtent::usable() const { return finite && (low.x > high.x || (is_usable(low) && is_usable(high))); }

double MeshExtent::size() const { return low.x <= high.x ? distance(low, high) : 0.0; }

MeshExtent extent_of(HostInstance const& host, Coordinates const& coordinates) {
  constexpr Index chunk = 16384;  // 384 KiB: stays in a core's cache
  std::vector<MeshExtent> parts(std::size_t((coordinates.size() + chunk - 1) / chunk));
  detail::for_all(host, "gridmorph::extent_of", Index(parts.size()), [&](Index p) {
    Index const begin = p * chunk;
    parts[std::size_t(p)] = extent_of(coordinates, begin, std::min(coordinates.size(), begin + chunk));
  });
  MeshExtent all{{inf, inf, inf}, {-inf, -inf, -inf}, true};
  for (MeshExtent const& part : parts) {
    all.low = {std::min(all.low.x, part.low.x), std::min(all.low.y, part.low.y), std::min(all.low.z, part.low.z)};
    all.high = {std::max(all.high.x, part.high.x), std::max(all.high.y, part.high.y),
                std::max(all.high.z, part.high.z)};
    all.finite = all.finite && part.finite;
  }
  return all;
}

}  // namespace gridmorph
