#include <gridmorph/report/progress_text.hpp>

#include <fmt/format.h>

#include <numeric>
#include <utility>

namespace gridmorph {

std::string duration_text(double seconds) {
  if (seconds < 99.5) return fmt::format("{:.0f} s", seconds);
  if (seconds < 99.5 * 60) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.2g} h", seconds / 3600);
}

std::string progress_text(std::string_view work, std::optional<double> share, double elapsed) {
  if (!share) return std::string(work);
  std::string text = fmt::format("{}, {:.0f} %", work, 100 * *share);
  if (elapsed >= 2 && *share >= 0.02 && *share < 1)
    text += fmt::format(", about {} left", duration_text(elapsed * (1 - *share) / *share));
  return text;
}

void StagedProgress::expect(std::vector<double> costs) {
  costs_ = std::move(costs);
  next_ = 0;
}

std::optional<double> StagedProgress::advance() {
  if (next_ >= costs_.size()) return {};
  auto const at = costs_.begin() + std::ptrdiff_t(next_++);
  double const all = std::accumulate(costs_.begin(), costs_.end(), 0.0);
  return all > 0 ? std::accumulate(costs_.begin(), at, 0.0) / all : 0.0;
}

}  // namespace gridmorph
