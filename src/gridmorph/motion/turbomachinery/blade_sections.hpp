// The motion of a blade's camber surface, tabulated over span and chord.
#pragma once

#include <gridmorph/motion/turbomachinery/blade_surface.hpp>
#include <gridmorph/motion/turbomachinery/span_table.hpp>

#include <array>
#include <vector>

namespace gridmorph {

/// Mid-camber motion: the mean of the motions of the blade's sides at equal span fraction and axial chord fraction.
///
/// Sections are taken at evenly spaced span fractions, split at their edges into sides, and each side is tabulated over
/// the chord angle phi, chord fraction = (1 - cos phi) / 2: a rounded leading edge is smooth in phi, while the chord
/// fraction would see a square root. Between table entries: cubic convolution (Keys 1981), C1, third order, exact for
/// zero and linear data.
///
/// An edge is the line where the sides of an H mesh end: there the motion of its nodes is reproduced, so that periodics
/// that meet the blade in that line agree with it to round-off. Where a surface goes around the edge (O and C meshes),
/// it is the most upstream or downstream point of the section, found between grid lines by a parabola.
class BladeSections {
 public:
  /// Throws MotionError when the sections have no axial chord or the spanwise lines have no span in common.
  explicit BladeSections(BladeSurface const& blade);

  /// Axial positions of leading and trailing edge. Beyond the first and last section: theirs.
  [[nodiscard]] double leading(double span) const { return leading_.at(span)[0]; }
  [[nodiscard]] double trailing(double span) const { return trailing_.at(span)[0]; }

  /// Chord fraction 0 is the leading edge, 1 the trailing edge; clamped to these.
  [[nodiscard]] CylindricalMotion motion(double span, double chord_fraction) const;

  /// How far the motions of the contours' edges are from their mean, which the edges of the row get: nothing but
  /// rounding for one blade, and for copies that move alike; what blunt edges make of two sides.
  struct EdgeSpread {
    double length = 0;  ///< along the flow or the span, in chords
    double angle_rad = 0;
  };
  [[nodiscard]] EdgeSpread edge_spread() const { return edge_spread_; }

  /// The value of BladeSurface::sliced: whether lines were made by cutting facets.
  [[nodiscard]] bool sliced() const { return sliced_; }
  [[nodiscard]] double first_span() const { return span_lo_; }
  [[nodiscard]] double last_span() const { return span_hi_; }
  /// How far any of its lines reaches: beyond the sections where lines end apart, as beside a groove.
  [[nodiscard]] double lowest_span() const { return lowest_; }
  [[nodiscard]] double highest_span() const { return highest_; }
  /// Smallest leading and largest trailing edge position: the blade's axial range.
  [[nodiscard]] double most_upstream() const;
  [[nodiscard]] double most_downstream() const;

 private:
  using Components = std::array<double, 3>;  ///< axial, radial, angle

  [[nodiscard]] Components tabulated(double span, double chord_fraction) const;

  bool sliced_ = false;
  EdgeSpread edge_spread_;
  double span_lo_ = 0, span_hi_ = 0, lowest_ = 0, highest_ = 0;
  int n_sections_ = 0;
  std::vector<Components> motion_;  ///< (n_sections, n_chord), chord fastest
  SpanTable leading_, trailing_;
};

}  // namespace gridmorph
