#include <gridmorph/geometry/arc_curve.hpp>

#include <gridmorph/geometry/cubic_piece.hpp>

#include <algorithm>
#include <utility>

namespace gridmorph {

ArcCurve::ArcCurve(std::vector<Vec3> points) : points_(std::move(points)) {
  std::size_t const n = points_.size();
  arc_.assign(1, 0.0);
  for (std::size_t k = 1; k < n; ++k) arc_.push_back(arc_.back() + distance(points_[k - 1], points_[k]));
  auto const secant = [&](std::size_t k) { return (1 / (arc_[k + 1] - arc_[k])) * (points_[k + 1] - points_[k]); };
  for (std::size_t k = 0; k < n; ++k) {
    if (n == 2) {
      slope_.push_back(secant(0));
      continue;
    }
    // Of the parabola through the node and two beside it.
    std::size_t const m = std::clamp<std::size_t>(k, 1, n - 2);
    double const before = arc_[m] - arc_[m - 1], behind = arc_[m + 1] - arc_[m];
    Vec3 const bend = (1 / (before + behind)) * (secant(m) - secant(m - 1));
    slope_.push_back(secant(m - 1) + (2 * arc_[k] - arc_[m - 1] - arc_[m]) * bend);
  }
}

Vec3 ArcCurve::at(double s) const {
  if (s <= 0) return points_.front() + s * slope_.front();
  if (s >= length()) return points_.back() + (s - length()) * slope_.back();
  auto const k = piece(s);
  double const width = arc_[k + 1] - arc_[k];
  return cubic_piece(points_[k], points_[k + 1], slope_[k], slope_[k + 1], width, (s - arc_[k]) / width);
}

Vec3 ArcCurve::tangent(double s) const {
  if (s <= 0) return slope_.front();
  if (s >= length()) return slope_.back();
  auto const k = piece(s);
  double const width = arc_[k + 1] - arc_[k], t = (s - arc_[k]) / width;
  return (6 * t * (1 - t) / width) * (points_[k + 1] - points_[k]) + ((1 - t) * (1 - 3 * t)) * slope_[k] +
         (t * (3 * t - 2)) * slope_[k + 1];
}

std::size_t ArcCurve::piece(double s) const {
  return std::size_t(piece_at(
      int(arc_.size()), [&](int k) { return arc_[k]; }, s));
}

}  // namespace gridmorph
