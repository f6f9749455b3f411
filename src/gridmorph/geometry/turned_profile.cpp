// The frame of the meridional plane in which a wall is a function.
#include <gridmorph/core/error.hpp>
#include <gridmorph/geometry/slip_surface.hpp>

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>

namespace gridmorph {

using kernels::MeridionalFrame;

namespace {

using Points = std::vector<std::pair<double, double>>;

MeridionalFrame turned_by(int degrees) {
  // The two frames along the axes are exact.
  if (degrees == 0) return {1, 0};
  if (degrees == 90) return {0, 1};
  double const angle = degrees * std::numbers::pi / 180;
  return {std::cos(angle), std::sin(angle)};
}

Points in_frame(MeridionalFrame const& frame, Points const& points, std::size_t step = 1) {
  Points out;
  for (std::size_t n = 0; n < points.size(); n += step)
    out.emplace_back(frame.abscissa(points[n].first, points[n].second),
                     frame.ordinate(points[n].first, points[n].second));
  return out;
}

double slope_of_piece(RevolutionProfile const& profile, std::size_t n) {
  kernels::ProfileKnot const &lo = profile.knots[n], &hi = profile.knots[n + 1];
  return std::abs((hi.radius - lo.radius) / (hi.axial - lo.axial));
}

double steepest_piece(RevolutionProfile const& profile) {
  double most = 0;
  for (std::size_t n = 0; n + 1 < profile.knots.size(); ++n) most = std::max(most, slope_of_piece(profile, n));
  return most;
}

/// Points of two walls, taken by turns, make a line longer than every other of them does, or do not lie on it; points
/// along one wall do neither.
bool zigzags(RevolutionProfile const& profile) {
  constexpr std::size_t least = 16;
  auto const& knots = profile.knots;
  if (profile.deviation > 1e-3 * (knots.back().axial - knots.front().axial)) return true;
  if (knots.size() < least) return false;
  auto const length = [&](std::size_t step) {
    double sum = 0;
    for (std::size_t n = 0; n + step < knots.size(); n += step)
      sum += std::hypot(knots[n + step].axial - knots[n].axial, knots[n + step].radius - knots[n].radius);
    return sum;
  };
  constexpr double longer = 1.02;
  return length(1) > longer * length(2) + 2 * longer * length(1) / double(knots.size());
}

}  // namespace

bool RevolutionProfile::is_steep() const {
  constexpr double steep = 10, matters = 1e-3;
  double lo = knots.front().radius, hi = lo, risen = 0;
  for (std::size_t n = 0; n + 1 < knots.size(); ++n) {
    lo = std::min(lo, knots[n + 1].radius);
    hi = std::max(hi, knots[n + 1].radius);
    if (slope_of_piece(*this, n) > steep) risen += std::abs(knots[n + 1].radius - knots[n].radius);
  }
  return risen > matters * std::max(hi - lo, knots.back().axial - knots.front().axial);
}

TurnedProfile TurnedProfile::from_points(Points const& points) {
  std::optional<TurnedProfile> upright;
  std::string reason;
  for (int const degrees : {0, 90}) {
    MeridionalFrame const frame = turned_by(degrees);
    try {
      TurnedProfile fit{RevolutionProfile::from_points(in_frame(frame, points)), frame};
      if (!fit.profile.is_steep()) return fit;
      if (!upright) upright = std::move(fit);
    } catch (MotionError const& e) {
      if (degrees == 0) reason = e.what();
    }
  }

  // Which frame is best shows in a part of the points already.
  constexpr std::size_t enough = 4000;
  std::size_t const step = std::max<std::size_t>(1, points.size() / enough);
  std::optional<MeridionalFrame> best;
  double least = std::numeric_limits<double>::infinity();
  for (int const degrees : {45, 30, 60, -45, -30, -60, 15, 75, -15, -75}) {
    MeridionalFrame const frame = turned_by(degrees);
    try {
      RevolutionProfile const fit = RevolutionProfile::from_points(in_frame(frame, points, step));
      double const slope = steepest_piece(fit);
      // Keeps to the frames named first where others are no better than by round-off.
      if (slope >= 0.999 * least || fit.is_steep() || zigzags(fit)) continue;
      least = slope;
      best = frame;
    } catch (MotionError const&) {
      continue;
    }
  }
  try {
    if (best) return {RevolutionProfile::from_points(in_frame(*best, points)), *best};
  } catch (MotionError const&) {
  }
  if (upright) return *upright;
  throw MotionError(reason +
                    "; nor is it a function in any turned frame of the meridional plane: a wall may turn by less "
                    "than 180 degrees; split it, or give its patches rules of their own");
}

}  // namespace gridmorph
