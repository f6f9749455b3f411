#include <gridmorph/geometry/cubic_piece.hpp>
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
  std::size_t const n = std::size_t(piece_at(
      int(stations.size()), [&](int k) { return stations[k].first; }, span));
  auto const [from, a] = stations[n];
  auto const [to, b] = stations[n + 1];
  double const width = to - from, t = (span - from) / width;
  if (interpolation == Interpolation::linear) return a + t * (b - a);
  return cubic_piece(a, b, slope(stations, n), slope(stations, n + 1), width, t);
}

bool SpanwiseTable::is_zero() const {
  return std::all_of(stations.begin(), stations.end(), [](auto const& station) { return station.second == 0; });
}

}  // namespace gridmorph
