#include <gridmorph/motion/motion.hpp>

#include <algorithm>
#include <cmath>

namespace gridmorph {

namespace {

using Stations = std::vector<std::pair<double, double>>;

double secant(Stations const& s, std::size_t n) {
  return (s[n + 1].second - s[n].second) / (s[n + 1].first - s[n].first);
}

/// Slope of the spline at station n: level at extremes, harmonic mean of the secants elsewhere (Fritsch and Butland
/// 1984). A table that ends inside the span goes on with its last value and is level there; one that reaches the end
/// ends without curvature.
double slope(Stations const& s, std::size_t n) {
  auto const inner = [&](std::size_t m) {
    double const a = secant(s, m - 1), b = secant(s, m);
    return a * b > 0 ? 2 * a * b / (a + b) : 0.0;
  };
  std::size_t const last = s.size() - 1;
  if (n > 0 && n < last) return inner(n);
  if (n == 0 ? s.front().first > 0 : s.back().first < 1) return 0;
  double const own = secant(s, n == 0 ? 0 : last - 1);
  double const inside = last > 1 ? inner(n == 0 ? 1 : last - 1) : own;
  return 1.5 * own - 0.5 * inside;
}

}  // namespace

double SpanwiseTable::at(double span) const {
  if (stations.empty()) return 0;
  if (span <= stations.front().first || stations.size() < 2) return stations.front().second;
  if (span >= stations.back().first) return stations.back().second;
  auto const above = std::upper_bound(stations.begin(), stations.end(), span,
                                      [](double h, auto const& station) { return h < station.first; });
  std::size_t const n = std::size_t(above - stations.begin()) - 1;
  double const width = stations[n + 1].first - stations[n].first, t = (span - stations[n].first) / width, q = 1 - t;
  double const rise = stations[n + 1].second - stations[n].second;
  if (interpolation == Interpolation::linear) return stations[n].second + t * rise;
  return stations[n].second +
         (t * t * (3 - 2 * t) * rise + width * t * q * (q * slope(stations, n) - t * slope(stations, n + 1)));
}

bool SpanwiseTable::is_zero() const {
  return std::all_of(stations.begin(), stations.end(), [](auto const& station) { return station.second == 0; });
}

}  // namespace gridmorph
