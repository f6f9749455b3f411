// How many cells have which value of a measure, baseline and morphed.
#pragma once

#include <gridmorph/quality/quality.hpp>

#include <array>
#include <string>
#include <vector>

namespace gridmorph::page {

struct Histogram {
  Measure measure = Measure::determinant_3x3x3;
  std::vector<double> edge;  ///< (bins + 1), ascending; what lies outside is in the first or the last bin
  std::vector<Index> before,
      after;  ///< (bins) of cells that were looked at; values that are no number are where the worst ones are
  std::string title;
};

/// Edges that suit a measure: determinants and angles evenly, aspect ratios evenly on a logarithmic scale up to
/// `largest`.
std::vector<double> histogram_edges(Measure measure, double largest);

/// Values of cells counted, [0] of those that are not `in` and [1] of those that are, with the same edges. Cost
/// O(values).
std::array<Histogram, 2> histograms(Measure measure, std::vector<double> const& before,
                                    std::vector<double> const& after, std::vector<char> const& in);

/// An SVG that takes its colours from the page: bars of the baseline behind, those of the morphed mesh as a line.
/// Heights are logarithmic: one bad cell among a million is to be seen.
std::string histogram_svg(Histogram const& histogram);

}  // namespace gridmorph::page
