#include <gridmorph/plan/elements/turning_bodies.hpp>

#include <gridmorph/geometry/smoothstep.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gridmorph {
namespace {

/// The function Q of the law of turn_share().
double growth(double s, double early) { return std::log1p(s) - early * std::log1p(s / early); }

}  // namespace

double turn_share(TurnDistances const& at) {
  constexpr double start_of_logarithm = 0.21;
  if (!std::isfinite(at.others)) return 1;
  double const way = at.body + at.others, far = std::max(way, 8 * at.size);
  double const gap = std::min(1.0, way / (8 * at.size)), early = std::max(0.02, 0.25 * gap);
  double const length = start_of_logarithm * std::sqrt(at.size * std::sqrt(at.size * far) / gap);
  if (!(way > 0 && length > 0)) return 0;
  double const start = std::min(at.body_layer, way / 3), end = way - std::min(at.other_layer, way / 3);
  double const done = (std::clamp(at.body, start, end) - start) / (end - start), all = (end - start) / length;
  // Where the way is short Q is s^2 and what differences of logarithms leave.
  constexpr double least = 1e-4;
  return 1 - (all < least ? done * done : growth(done * all, early) / growth(all, early));
}

void share_between(std::span<double> turn_shares) {
  constexpr double given_up = 0.4;
  double all = 1;
  for (double const f : turn_shares) all *= 1 - given_up * f;
  for (double& f : turn_shares) f *= all / (1 - given_up * f);
}

double turn_share_in_sight(double body, double others) {
  constexpr double smooth = 0.38;
  if (std::isinf(body)) return 1;
  if (std::isinf(others) || !(body > 0)) return 0;
  double const q = body / (body + others);
  return q + smooth * (q * q * (3 - 2 * q) - q);
}

double narrowness(double way, double size) { return 1 - smoothstep((way / size - 3) / 3); }

double compactness(double perimeter, double size) {
  return std::clamp((perimeter / (2 * std::numbers::pi * size) - 0.7) / 0.15, 0.0, 1.0);
}

double faded(double t) {
  constexpr double cubic = 0.1;
  return 1 - t - cubic * (t * t * (3 - 2 * t) - t);
}

void shift_shares(std::span<double const> from_bodies, std::span<double const> sizes, std::span<double const> moved,
                  double from_others, std::span<double> shares) {
  constexpr double of_what_is_left = 0.1;
  double nearest = from_others, second = from_others;
  for (double const d : from_bodies) {
    second = std::min(second, std::max(d, nearest));
    nearest = std::min(nearest, d);
  }
  // Of body b, and how much of what is around is nearer than 8 of its sizes.
  auto const grown = [&](std::size_t b) {
    double const d = from_bodies[b], others = d > nearest ? nearest : second;
    if (!std::isfinite(d) || !std::isfinite(others)) return d;
    double const way = d + others, gap = std::min(1.0, way / (8 * sizes[b]));
    double start = sizes[b] * gap * gap;
    if (moved[b] > 0) start = std::min(start, of_what_is_left * way * std::max(0.0, way / moved[b] - 1));
    return start > 0 ? d - start * std::log1p(d / start) : d;
  };
  for (std::size_t b = 0; b < shares.size(); ++b) {
    double nearness = 1 / from_others;
    for (std::size_t k = 0; k < shares.size(); ++k)
      if (k != b) nearness += 1 / grown(k);
    // Zero at the others, whatever the distance from the body is.
    double const done = grown(b) * nearness, t = std::isinf(nearness) ? 1 : done / (1 + done);
    shares[b] = faded(t);
  }
}

}  // namespace gridmorph
