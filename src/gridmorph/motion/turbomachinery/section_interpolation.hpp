// Interpolation along sections and across tables of them.
#pragma once

#include <gridmorph/geometry/cubic_piece.hpp>
#include <gridmorph/motion/turbomachinery/span_table.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace gridmorph::section_interpolation {

/// Entries of a table along the chord: at evenly spaced chord angles.
inline constexpr int n_chord = 65;

/// Position along the chord and up to three components: what is carried along a section.
using Sample = SpanTable::Value;
using Samples = std::vector<Sample>;

/// Weights of the polynomial through the four (or fewer) table points around x.
struct LocalPolynomial {
  int first = 0, count = 0;
  std::array<double, 4> weight{};

  /// x must be strictly increasing; `value` within it is interpolated.
  template <class X>
  LocalPolynomial(X const& x, int n, double value) {
    count = std::min(n, 4);
    first = std::clamp(piece_at(n, x, value) - 1, 0, n - count);
    for (int j = 0; j < count; ++j) {
      weight[j] = 1;
      for (int k = 0; k < count; ++k)
        if (k != j) weight[j] *= (value - x(first + k)) / (x(first + j) - x(first + k));
    }
  }
  template <class F>
  Sample operator()(F const& f) const {
    Sample out{};
    for (int j = 0; j < count; ++j) {
      Sample const& v = f(first + j);
      for (int c = 0; c < 4; ++c) out[c] += weight[j] * v[c];
    }
    return out;
  }
};

/// Cubic convolution on an even table of n >= 2 entries, x in units of entries; ends are extended by parabolas.
struct Convolution {
  int first = 0;
  std::array<double, 4> weight{};  ///< of entries first - 1 .. first + 2, after
                                   ///< the ghosts were folded in
  Convolution(int n, double x) {
    first = std::clamp(int(x), 0, n - 2);
    double const t = std::clamp(x - first, 0.0, 1.0);
    if (n == 2) {
      weight = {0, 1 - t, t, 0};
      return;
    }
    weight = {t * (-0.5 + t * (1 - 0.5 * t)), 1 + t * t * (-2.5 + 1.5 * t), t * (0.5 + t * (2 - 1.5 * t)),
              t * t * (-0.5 + 0.5 * t)};
    if (first == 0) fold(weight[0], weight[1], weight[2], weight[3]);
    if (first == n - 2) fold(weight[3], weight[2], weight[1], weight[0]);
  }
  /// Replaces a ghost entry by the extrapolation 3 a - 3 b + c of the three beside it.
  static void fold(double& ghost, double& a, double& b, double& c) {
    a += 3 * ghost;
    b -= 3 * ghost;
    c += ghost;
    ghost = 0;
  }
  template <class F>
  void for_each(F const& f) const {
    for (int j = 0; j < 4; ++j)
      if (weight[j] != 0) f(first - 1 + j, weight[j]);
  }
};

inline double chord_angle(double fraction) { return std::acos(1 - 2 * std::clamp(fraction, 0.0, 1.0)); }

/// One side of a section, from leading to trailing edge, tabulated over the chord angle.
struct Side {
  double leading = 0, trailing = 0;
  std::array<Sample, n_chord> table{};

  /// Nodes that lie back upstream of an earlier one are passed over. Precondition: nodes.front() is the most upstream.
  explicit Side(Samples const& nodes) : leading(nodes.front()[0]), trailing(nodes.back()[0]) {
    constexpr double least_step = 1e-5;
    Samples kept;
    std::vector<double> phi;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      bool const last = n + 1 == nodes.size();
      double const p = last ? std::numbers::pi : chord_angle((nodes[n][0] - leading) / (trailing - leading));
      if (!phi.empty() && (p - phi.back() < least_step || (!last && std::numbers::pi - p < least_step))) continue;
      phi.push_back(p);
      kept.push_back(nodes[n]);
    }
    for (int j = 0; j < n_chord; ++j) {
      double const p = std::numbers::pi * j / (n_chord - 1);
      table[j] = LocalPolynomial([&](int n) { return phi[n]; }, int(phi.size()),
                                 p)([&](int n) -> Sample const& { return kept[n]; });
    }
  }
};

}  // namespace gridmorph::section_interpolation
