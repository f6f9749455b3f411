#include <gridmorph/quality/detail/judge_cells.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gridmorph::detail {

CellScreen::CellScreen(CellLimits const& limits)
    : determinant(std::max(limits.min_determinant, 1 - limits.max_loss)),
      angle_deg(std::max(limits.min_angle_deg, 90 * (1 - limits.max_loss))),
      skewness(limits.max_skewness) {
  constexpr double radians = std::numbers::pi / 180, slack = 1e-12;  // rounding may let more cells through, never fewer
  angle_cosine = std::cos(radians * std::min(angle_deg, 90.0)) - slack;
  skewness_cosine = std::cos(radians * 90 * (1 - std::clamp(limits.max_skewness, 0.0, 1.0))) - slack;
}

}  // namespace gridmorph::detail
