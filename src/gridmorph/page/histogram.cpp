#include <gridmorph/page/report_page.hpp>
#include <gridmorph/report/measure_text.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace gridmorph::page {

namespace {

/// The bins of an axis, found without a logarithm per value.
class Bins {
 public:
  /// logarithmic: an axis of aspect ratios, where what is no number is as bad as the largest.
  Bins(std::vector<double> const& edge, bool logarithmic)
      : edge_(edge), last_(edge.size() - 2), of_no_number_(logarithmic ? last_ : 0) {
    if (!logarithmic) {
      per_unit_ = double(last_ + 1) / (edge.back() - edge.front());
      return;
    }
    // The bin of the smallest number with the same leading bits: exponent and four bits after it, a step of 6 %.
    key_ = key_of(edge.front());
    for (std::size_t key = key_, bin = 0; key <= key_of(edge.back()); ++key) {
      double const least = std::bit_cast<double>(std::uint64_t(key) << dropped_bits);
      while (bin < last_ && least >= edge[bin + 1]) ++bin;
      first_.push_back(bin);
    }
  }

  [[nodiscard]] std::size_t operator()(double value) const {
    if (!(value > edge_.front())) return std::isnan(value) ? of_no_number_ : 0;
    if (value >= edge_.back()) return last_;
    // Even on the scale of the axis: a guess that is off by one bin at most.
    std::size_t bin = first_.empty() ? std::min(last_, std::size_t((value - edge_.front()) * per_unit_))
                                     : first_[key_of(value) - key_];
    if (value < edge_[bin]) --bin;
    if (value >= edge_[bin + 1]) ++bin;
    return bin;
  }

 private:
  static constexpr unsigned dropped_bits = 48;
  static std::size_t key_of(double value) { return std::size_t(std::bit_cast<std::uint64_t>(value) >> dropped_bits); }

  std::vector<double> const& edge_;
  std::size_t last_, of_no_number_, key_ = 0;
  double per_unit_ = 0;
  std::vector<std::size_t> first_;  ///< by key
};

// Of the drawing, in pixels.
constexpr double wide = 400, high = 172, left = 46, right = 18, top = 8, bottom = 30;

double height_of(Index count, double most) {
  return count == 0 ? 0 : (std::log10(double(count)) + 0.35) / (most + 0.35);
}

/// 1, 10, 100, 1 k, ...
std::string count_text(int power) {
  constexpr std::array names{"1", "10", "100", "1k", "10k", "100k", "1M", "10M", "100M", "1G"};
  return names[std::clamp(power, 0, 9)];
}

}  // namespace

std::vector<double> histogram_edges(Measure measure, double largest) {
  std::vector<double> out;
  auto const evenly = [&](double from, double to, int bins) {
    for (int n = 0; n <= bins; ++n) out.push_back(from + (to - from) * n / bins);
  };
  switch (measure) {
    case Measure::minimum_angle_deg: evenly(0, 90, 45); return out;
    case Measure::aspect_ratio: {
      int const decades = std::max(1, int(std::ceil(std::log10(std::clamp(largest, 10.0, 1e7)))));
      evenly(0, decades, 8 * decades);
      for (double& e : out) e = std::pow(10.0, e);
      return out;
    }
    default: evenly(-0.1, 1, 44); return out;
  }
}

std::array<Histogram, 2> histograms(Measure measure, std::vector<double> const& before,
                                    std::vector<double> const& after, std::vector<char> const& in) {
  double largest = 0;
  if (measure == Measure::aspect_ratio)
    for (auto const* values : {&before, &after})
      for (double const v : *values)
        if (v > largest && std::isfinite(v)) largest = v;
  std::array<Histogram, 2> out;
  for (Histogram& h : out) {
    h.measure = measure;
    h.edge = histogram_edges(measure, largest);
    h.before.assign(h.edge.size() - 1, 0);
    h.after.assign(h.edge.size() - 1, 0);
  }
  Bins const bin(out[0].edge, larger_is_worse(measure));
  for (std::size_t n = 0; n < before.size(); ++n) ++out[in[n] != 0 ? 1 : 0].before[bin(before[n])];
  for (std::size_t n = 0; n < after.size(); ++n) ++out[in[n] != 0 ? 1 : 0].after[bin(after[n])];
  return out;
}

std::string histogram_svg(Histogram const& h) {
  std::size_t const bins = h.before.size();
  Index largest = 1;
  for (std::size_t b = 0; b < bins; ++b) largest = std::max({largest, h.before[b], h.after[b]});
  double const most = std::log10(double(largest));
  double const dx = (wide - left - right) / double(bins);
  auto const y_of = [&](Index count) { return high - bottom - (high - top - bottom) * height_of(count, most); };
  std::string svg = fmt::format(
      "<svg class=\"histogram\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" height=\"{1:.0f}\" role=\"img\" "
      "aria-label=\"{2}\">",
      wide, high, h.title);
  int const step = most > 5 ? 2 : 1;
  for (int power = 0; power <= int(most); power += step) {
    double const y = y_of(Index(std::llround(std::pow(10.0, power))));
    svg += fmt::format(
        "<path class=\"grid\" d=\"M{:.1f} {:.1f}H{:.1f}\"/><text x=\"{:.1f}\" y=\"{:.1f}\" "
        "text-anchor=\"end\">{}</text>",
        left, y, wide - right, left - 5, y + 4, count_text(power));
  }
  std::string bars, line = fmt::format("M{:.1f} {:.1f}", left, high - bottom);
  for (std::size_t b = 0; b < bins; ++b) {
    double const x = left + dx * double(b);
    if (h.before[b] > 0)
      bars += fmt::format("M{:.1f} {:.1f}V{:.1f}H{:.1f}V{:.1f}Z", x, high - bottom, y_of(h.before[b]), x + dx,
                          high - bottom);
    line += fmt::format("V{:.1f}H{:.1f}", y_of(h.after[b]), x + dx);
  }
  line += fmt::format("V{:.1f}", high - bottom);
  svg += fmt::format("<path class=\"before\" d=\"{}\"/><path class=\"after\" d=\"{}\"/>", bars, line);
  svg += fmt::format("<path class=\"axis\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>", left, high - bottom, wide - right);
  std::size_t const ticks = h.measure == Measure::aspect_ratio        ? bins / 8
                            : h.measure == Measure::minimum_angle_deg ? 9
                                                                      : 11;
  for (std::size_t t = 0; t <= ticks; ++t) {
    std::size_t const b = t * bins / ticks;
    svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>", left + dx * double(b),
                       high - bottom + 15,
                       h.measure == Measure::aspect_ratio ? count_text(int(t))
                       : std::fabs(h.edge[b]) < 1e-9      ? "0"
                                                          : fmt::format("{:.4g}", h.edge[b]));
  }
  return svg + "</svg>";
}

}  // namespace gridmorph::page
