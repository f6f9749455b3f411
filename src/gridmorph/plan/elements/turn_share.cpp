#include <gridmorph/plan/elements/turn_share.hpp>

#include <algorithm>
#include <cmath>

namespace gridmorph {
namespace {

/// Q of the law.
double growth(double s) {
  constexpr double early = 0.25;
  return std::log1p(s) - early * std::log1p(s / early);
}

}  // namespace

double turn_share(TurnDistances const& at) {
  constexpr double start_of_logarithm = 0.21;
  if (!std::isfinite(at.others)) return 1;
  double const way = at.body + at.others, far = std::max(way, 8 * at.size);
  double const length = start_of_logarithm * std::sqrt(at.size * std::sqrt(at.size * far));
  if (!(way > 0 && length > 0)) return 0;
  double const start = std::min(at.body_layer, way / 3), end = way - std::min(at.other_layer, way / 3);
  double const done = (std::clamp(at.body, start, end) - start) / (end - start), all = (end - start) / length;
  // Where the way is short Q is s^2 and what differences of logarithms leave.
  constexpr double least = 1e-4;
  return 1 - (all < least ? done * done : growth(done * all) / growth(all));
}

}  // namespace gridmorph
