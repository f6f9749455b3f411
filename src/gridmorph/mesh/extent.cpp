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
    zero[l] += 0 * (x[n] + y[n] + z[n]);
  };
  Index n = begin;
  for (; n + lanes <= end; n += lanes)
    for (int l = 0; l < lanes; ++l) take(l, n + l);
  for (; n < end; ++n) take(0, n);
  return {{rx.low(), ry.low(), rz.low()},
          {rx.high(), ry.high(), rz.high()},
          std::all_of(zero.begin(), zero.end(), [](double v) { return v == 0; })};
}

/// The middle one of some values, which are sorted as far as that takes.
double median(std::vector<double>& values) {
  auto const middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

bool is_usable(Vec3 const& p) {
  // Not-a-number is no larger, and no smaller, than anything.
  return std::fabs(p.x) <= coordinate_limit && std::fabs(p.y) <= coordinate_limit && std::fabs(p.z) <= coordinate_limit;
}

bool MeshExtent::usable() const { return finite && (low.x > high.x || (is_usable(low) && is_usable(high))); }

double MeshExtent::size() const { return low.x <= high.x ? distance(low, high) : 0.0; }

bool MeshCore::is_rounded_away(double largest) const {
  return std::numeric_limits<double>::epsilon() * largest > 1e-3 * radius && radius > 0;
}

MeshCore core_of(Coordinates const& coordinates) {
  MeshCore out;
  if (coordinates.size() == 0) return out;
  constexpr Index wanted = 1000;
  // An odd step meets nodes on different lines of a block.
  Index const step = std::max<Index>(1, coordinates.size() / wanted) | 1;
  std::array<std::vector<double>, 3> values;
  for (Index n = 0; n < coordinates.size(); n += step) {
    Vec3 const p = coordinates[n];
    values[0].push_back(p.x);
    values[1].push_back(p.y);
    values[2].push_back(p.z);
  }
  out.middle = {median(values[0]), median(values[1]), median(values[2])};
  std::vector<double> away;
  for (Index n = 0; n < coordinates.size(); n += step)
    if (double const d = distance(coordinates[n], out.middle); d > 0) away.push_back(d);
  if (!away.empty()) out.radius = median(away);
  return out;
}

MeshExtent extent_of(HostInstance const& host, Coordinates const& coordinates) {
  constexpr Index chunk = 16384;  // 384 KiB: stays in a core's cache
  std::vector<MeshExtent> parts((coordinates.size() + chunk - 1) / chunk);
  detail::for_all(host, "gridmorph::extent_of", Index(parts.size()), [&](Index p) {
    Index const begin = p * chunk;
    parts[p] = extent_of(coordinates, begin, std::min(coordinates.size(), begin + chunk));
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
