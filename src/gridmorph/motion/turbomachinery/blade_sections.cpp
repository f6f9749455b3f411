#include <gridmorph/motion/turbomachinery/row_motion.hpp>

#include <gridmorph/core/error.hpp>
#include <gridmorph/motion/turbomachinery/section_interpolation.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>

namespace gridmorph {

namespace {

using namespace section_interpolation;

/// One spanwise line, ready for interpolation: span fractions strictly increasing.
struct SpanLine {
  std::vector<double> span;
  Samples samples;

  SpanLine(BladeSurface const& blade, std::vector<CylindricalMotion> const& motion, std::vector<int> const& nodes) {
    for (int n : nodes) {
      BladeNode const& b = blade.nodes[n];
      if (!span.empty() && !(b.span > span.back() + 1e-9)) continue;
      span.push_back(b.span);
      samples.push_back({b.m, motion[n].axial, motion[n].radial, motion[n].angle_rad});
    }
  }
  [[nodiscard]] Sample at(double h) const {
    LocalPolynomial const p([this](int n) { return span[n]; }, int(span.size()),
                            std::clamp(h, span.front(), span.back()));
    return p([this](int n) -> Sample const& { return samples[n]; });
  }
};

/// The extreme axial position near node m of a section, where the parabola through m and its neighbours turns.
struct Edge {
  double at = 0;  ///< node number, with the fraction towards the next
  Sample sample{};
};

template <class Node>
Edge rounded_edge(Node const& node, int m) {
  Sample const &a = node(m - 1), &b = node(m), &c = node(m + 1);
  double const curvature = a[0] - 2 * b[0] + c[0], slope = 0.5 * (c[0] - a[0]);
  double const t = curvature != 0 ? std::clamp(-slope / curvature, -0.5, 0.5) : 0.0;
  Edge edge{m + t, {}};
  for (int q = 0; q < 4; ++q)
    edge.sample[q] = b[q] + t * (0.5 * (c[q] - a[q]) + 0.5 * t * ((a[q] - b[q]) + (c[q] - b[q])));
  return edge;
}

/// Which lines of an open contour are its edges; -1 where the surface goes around the edge.
struct EdgeLines {
  int leading = -1, trailing = -1;
};

/// The ends of an open contour are edges if they are about as far upstream (downstream) as the section gets.
EdgeLines find_edge_lines(Samples const& nodes, bool closed) {
  if (closed) return {};
  constexpr double about =
      0.1;  // of the chord: blunt and inclined noses reach a little beyond the end of the grid line
  auto const [lo, hi] =
      std::minmax_element(nodes.begin(), nodes.end(), [](auto const& a, auto const& b) { return a[0] < b[0]; });
  double const chord = (*hi)[0] - (*lo)[0], first = nodes.front()[0], last = nodes.back()[0];
  int const n = int(nodes.size());
  EdgeLines edges;
  if (std::min(first, last) - (*lo)[0] < about * chord) edges.leading = first < last ? 0 : n - 1;
  if ((*hi)[0] - std::max(first, last) < about * chord) edges.trailing = first < last ? n - 1 : 0;
  return edges;
}

/// Splits one section at its edges into sides. `nodes` go once around (closed) or from end to end.
std::vector<Side> split_at_edges(Samples const& nodes, bool closed, EdgeLines const& lines) {
  int const n = int(nodes.size());
  auto const node = [&](int m) -> Sample const& { return nodes[((m % n) + n) % n]; };
  auto const by_axial = [](Sample const& a, Sample const& b) { return a[0] < b[0]; };
  auto const edge = [&](int line, Samples::const_iterator extreme) {
    int const m = line >= 0 ? line : int(extreme - nodes.begin());
    bool const end = line >= 0 || (!closed && (m == 0 || m == n - 1));
    return end ? Edge{double(m), nodes[m]} : rounded_edge(node, m);
  };
  Edge const leading = edge(lines.leading, std::min_element(nodes.begin(), nodes.end(), by_axial));
  Edge const trailing = edge(lines.trailing, std::max_element(nodes.begin(), nodes.end(), by_axial));

  std::vector<Side> sides;
  // From one edge in steps of one node up to (not including) `stop`, then the sample `end`.
  auto const add = [&](Edge const& from, int step, double stop, Sample const& end) {
    Samples side{from.sample};
    int const start = int(std::floor(from.at)) + (step > 0 ? 1 : (from.at == std::floor(from.at) ? -1 : 0));
    for (int m = start; step > 0 ? m < stop : m > stop; m += step) side.push_back(node(m));
    side.push_back(end);
    if (side.front()[0] > side.back()[0]) std::reverse(side.begin(), side.end());
    if (side.back()[0] > side.front()[0]) sides.emplace_back(side);
  };
  if (closed) {
    add(leading, +1, trailing.at > leading.at ? trailing.at : trailing.at + n, trailing.sample);
    add(leading, -1, trailing.at < leading.at ? trailing.at : trailing.at - n, trailing.sample);
    return sides;
  }
  int const forward = trailing.at > leading.at ? +1 : -1;
  add(leading, forward, trailing.at, trailing.sample);
  // What lies beyond an edge is the other side of a C; short leftovers are the end face of a blunt edge.
  double const chord = trailing.sample[0] - leading.sample[0];
  int const before = forward > 0 ? 0 : n - 1, after = n - 1 - before;
  if (nodes[before][0] - leading.sample[0] > 0.5 * chord) add(leading, -forward, before, nodes[before]);
  if (trailing.sample[0] - nodes[after][0] > 0.5 * chord) add(trailing, forward, after, nodes[after]);
  return sides;
}

/// The motion of the lines where sides end, node for node; nothing if a surface goes around the edge.
std::optional<SpanTable> edge_table(std::vector<std::vector<SpanLine>> const& contours,
                                    std::vector<EdgeLines> const& edges, int EdgeLines::*which) {
  for (EdgeLines const& e : edges)
    if (e.*which < 0) return std::nullopt;
  SpanTable table;
  double const share = 1.0 / double(contours.size());
  for (double h : contours.front()[edges.front().*which].span) {
    Sample mean{};
    for (std::size_t c = 0; c < contours.size(); ++c) {
      Sample const s = contours[c][edges[c].*which].at(h);
      for (int q = 0; q < 4; ++q) mean[q] += share * s[q];
    }
    table.add(h, mean);
  }
  return table;
}

/// Widens the spread by the edges of each contour, where they are the mean of its sides. `mean`: that of all sides at
/// the leading and at the trailing edge.
void widen(BladeSections::EdgeSpread& spread, std::vector<Side> const& sides,
           std::vector<std::size_t> const& of_contour, std::array<Sample, 2> const& mean) {
  double const chord = mean[1][0] - mean[0][0];
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && of_contour[end] == of_contour[begin]) ++end;
    for (std::size_t edge = 0; edge < 2; ++edge) {
      Sample own{};
      for (std::size_t n = begin; n < end; ++n)
        for (int q = 0; q < 4; ++q)
          own[q] += (edge == 0 ? sides[n].table.front() : sides[n].table.back())[q] / double(end - begin);
      spread.length =
          std::max({spread.length, std::abs(own[1] - mean[edge][1]) / chord, std::abs(own[2] - mean[edge][2]) / chord});
      spread.angle_rad = std::max(spread.angle_rad, std::abs(own[3] - mean[edge][3]));
    }
  }
}

}  // namespace

BladeSections::BladeSections(BladeSurface const& blade, std::vector<CylindricalMotion> const& motion) {
  std::vector<std::vector<SpanLine>> contours;
  sliced_ = blade.sliced;
  span_lo_ = -std::numeric_limits<double>::infinity();
  span_hi_ = std::numeric_limits<double>::infinity();
  lowest_ = span_hi_;
  highest_ = span_lo_;
  std::size_t most_nodes = 0;
  for (BladeContour const& contour : blade.contours) {
    contours.emplace_back();
    for (int l : contour.lines) {
      SpanLine const& line = contours.back().emplace_back(blade, motion, blade.lines[l]);
      span_lo_ = std::max(span_lo_, line.span.front());
      span_hi_ = std::min(span_hi_, line.span.back());
      lowest_ = std::min(lowest_, line.span.front());
      highest_ = std::max(highest_, line.span.back());
      most_nodes = std::max(most_nodes, line.span.size());
    }
  }
  if (contours.empty() || !(span_hi_ - span_lo_ > 0.3 * (highest_ - lowest_)))
    throw MotionError("the blade's spanwise grid lines share only the span fractions " + std::to_string(span_lo_) +
                      " to " + std::to_string(span_hi_) + " of " + std::to_string(lowest_) + " to " +
                      std::to_string(highest_) + "; let `of` name whole sides of one blade row");

  n_sections_ = int(std::clamp<std::size_t>(2 * most_nodes - 1, 33, 129));
  auto const section = [&](std::size_t c, double h) {
    Samples nodes;
    for (SpanLine const& line : contours[c]) nodes.push_back(line.at(h));
    return nodes;
  };
  std::vector<EdgeLines> edges;
  for (std::size_t c = 0; c < contours.size(); ++c)
    edges.push_back(find_edge_lines(section(c, 0.5 * (span_lo_ + span_hi_)), blade.contours[c].closed));

  SpanTable leading, trailing;
  for (int s = 0; s < n_sections_; ++s) {
    double const h = span_lo_ + (span_hi_ - span_lo_) * s / (n_sections_ - 1);
    std::vector<Side> sides;
    std::vector<std::size_t> of_contour;
    for (std::size_t c = 0; c < contours.size(); ++c)
      for (Side& side : split_at_edges(section(c, h), blade.contours[c].closed, edges[c])) {
        sides.push_back(side);
        of_contour.push_back(c);
      }
    if (sides.empty())
      throw MotionError("at span fraction " + std::to_string(h) + " the blade has no axial chord; check the axis");
    double const share = 1.0 / double(sides.size());
    Sample first{}, last{};
    motion_.resize(motion_.size() + n_chord, {0, 0, 0});
    for (Side const& side : sides) {
      for (int q = 0; q < 4; ++q) {
        first[q] += share * side.table.front()[q];
        last[q] += share * side.table.back()[q];
      }
      for (int j = 0; j < n_chord; ++j)
        for (int q = 0; q < 3; ++q) motion_[std::size_t(s) * n_chord + j][q] += share * side.table[j][q + 1];
    }
    leading.add(h, first);
    trailing.add(h, last);
    widen(edge_spread_, sides, of_contour, {first, last});
  }
  leading_ = edge_table(contours, edges, &EdgeLines::leading).value_or(leading);
  trailing_ = edge_table(contours, edges, &EdgeLines::trailing).value_or(trailing);
}

BladeSections::Components BladeSections::tabulated(double span, double chord_fraction) const {
  int const n = n_sections_;
  double const x = (std::clamp(span, span_lo_, span_hi_) - span_lo_) / (span_hi_ - span_lo_) * (n - 1);
  Convolution const over_chord(n_chord, chord_angle(chord_fraction) / std::numbers::pi * (n_chord - 1));
  Components sum{0, 0, 0};
  Convolution(n, x).for_each([&](int s, double ws) {
    over_chord.for_each([&](int j, double wj) {
      for (int q = 0; q < 3; ++q) sum[q] += ws * wj * motion_[std::size_t(s) * n_chord + j][q];
    });
  });
  return sum;
}

CylindricalMotion BladeSections::motion(double span, double chord_fraction) const {
  double const c = std::clamp(chord_fraction, 0.0, 1.0);
  SpanTable::Value const first = leading_.at(span), last = trailing_.at(span);
  // The chord angle turns round-off of the axial position into its square root: nodes on an edge are caught before.
  constexpr double on_edge = 1e-12;
  if (c <= on_edge) return {first[1], first[2], first[3]};
  if (c >= 1 - on_edge) return {last[1], last[2], last[3]};
  // The edges are known better than the table: what it misses there is spread linearly over the chord.
  Components const m = tabulated(span, c), at_first = tabulated(span, 0), at_last = tabulated(span, 1);
  Components out{};
  for (int q = 0; q < 3; ++q) out[q] = m[q] + (1 - c) * (first[q + 1] - at_first[q]) + c * (last[q + 1] - at_last[q]);
  return {out[0], out[1], out[2]};
}

namespace {

bool by_axial(SpanTable::Value const& a, SpanTable::Value const& b) { return a[0] < b[0]; }

}  // namespace

double BladeSections::most_upstream() const {
  return (*std::min_element(leading_.values().begin(), leading_.values().end(), by_axial))[0];
}

double BladeSections::most_downstream() const {
  return (*std::max_element(trailing_.values().begin(), trailing_.values().end(), by_axial))[0];
}

}  // namespace gridmorph
