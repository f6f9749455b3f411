#include <generators/blade_contour.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace gridmorph::passage {

namespace {

constexpr int n_samples = 1000;
constexpr double parallel_distance = 0.25;  // chords

double angle_between(Point2 a, Point2 b) { return std::atan2(a.x * b.y - a.y * b.x, a.x * b.x + a.y * b.y); }

double interpolate(double s, double s0, double s1, double v0, double v1) {
  return v0 + (v1 - v0) * (s - s0) / (s1 - s0);
}

}  // namespace

BladeSide::BladeSide(Airfoil const& airfoil, Side side)
    : phi_(n_samples + 1), measure_(n_samples + 1), turn_(n_samples + 1) {
  double const sign = side == Side::upper ? 1 : -1;
  double const distance = parallel_distance * airfoil.chord();
  Point2 previous_tangent = sign * airfoil.tangent(0);
  Point2 previous = airfoil.point(0);
  for (int n = 1; n <= n_samples; ++n) {
    phi_[n] = sign * std::numbers::pi * n / n_samples;
    Point2 const here = airfoil.point(phi_[n]), tangent = sign * airfoil.tangent(phi_[n]);
    // Going from leading to trailing edge the outside is on the left of the upper and on the right of the lower side.
    double const turn = -sign * angle_between(previous_tangent, tangent);
    turn_[n] = turn_[n - 1] + turn;
    measure_[n] = measure_[n - 1] + std::max(length(here - previous) + distance * turn, 0.0);
    previous = here;
    previous_tangent = tangent;
  }
  double const total = measure_.back();
  for (double& m : measure_) m /= total;
}

double BladeSide::phi(double fraction) const {
  if (fraction <= 0) return phi_.front();
  if (fraction >= 1) return phi_.back();
  auto const after = std::upper_bound(measure_.begin() + 1, measure_.end() - 1, fraction);
  std::size_t const n = after - measure_.begin();
  return interpolate(fraction, measure_[n - 1], measure_[n], phi_[n - 1], phi_[n]);
}

double BladeSide::fraction_of_turn(double turn) const {
  std::size_t n = 1;
  while (n + 1 < turn_.size() && turn_[n] < turn) ++n;
  return std::clamp(interpolate(turn, turn_[n - 1], turn_[n], measure_[n - 1], measure_[n]), 0.0, 1.0);
}

double BladeSide::fraction_before_end(double turn) const {
  std::size_t n = turn_.size() - 1;
  while (n > 1 && turn_.back() - turn_[n - 1] < turn) --n;
  return 1 -
         std::clamp(interpolate(turn_.back() - turn, turn_[n - 1], turn_[n], measure_[n - 1], measure_[n]), 0.0, 1.0);
}

}  // namespace gridmorph::passage
