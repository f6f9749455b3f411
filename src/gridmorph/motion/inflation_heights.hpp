// Heights of an inflated blade or wing: tables over span and chord, and bulbs on its contour, such as a leading-edge
// bulb at its root.
#pragma once

#include <gridmorph/motion/motion.hpp>

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph {

/// Heights at stations: along the chord between those of one span fraction, then along the span between these, both
/// times as SpanwiseTable does. Beyond the first and last station: theirs. Stations of a span fraction need not be at
/// the chord fractions of another.
class HeightTable {
 public:
  struct Station {
    double span = 0, chord = 0;
    double side = 0;  ///< 1, -1, or 0 for both (SurfacePlace::side)
    double height = 0;
  };
  /// A table of stations in any order. Throws MotionError where two have the same place, or one side has stations and
  /// the other none.
  HeightTable(std::vector<Station> stations, SpanwiseTable::Interpolation interpolation);

  /// The height at a place; exactly the station's at a station. Cost O(stations along the span, and log of those along
  /// the chord).
  [[nodiscard]] double at(double span, double chord, double side) const;
  /// Whether heights depend on the side.
  [[nodiscard]] bool has_sides() const { return has_sides_; }

 private:
  using Row = std::pair<double, SpanwiseTable>;  ///< span fraction, and heights over the chord
  std::array<std::vector<Row>, 2> rows_;         ///< of side -1 or both, and of side 1
  SpanwiseTable::Interpolation interpolation_;
  bool has_sides_ = false;
};

/// A part of a surface raised around a place of the contour. With q the distance from an edge over the chord, straight
/// in the surface of the section and negative on side -1, and h the span fraction: height(h) shape(r), r^2 = ((q -
/// position(h)) / extent(h))^2 + ((h - span) / span_extent)^2.
struct Bulb {
  enum class Edge { leading, trailing };
  enum class Shape {
    cosine,    ///< (1 + cos(pi r)) / 2: level in the middle and at its rim
    parabola,  ///< 1 - r^2: a crease at its rim
    bump       ///< exp(1 - 1 / (1 - r^2)): all derivatives vanish at its rim
  };
  Edge edge = Edge::leading;  ///< the edge that q is measured from
  Shape shape = Shape::cosine;
  SpanwiseTable position;      ///< of the middle [chords]; empty: the edge itself
  SpanwiseTable extent;        ///< along the contour, from the middle to the rim [chords]
  SpanwiseTable height;        ///< in the middle [length]
  std::optional<double> span;  ///< of the middle; absent: a ridge along the span, whose term of r^2 is left out
  double span_extent = 0;      ///< from the middle to the rim [span fractions]

  [[nodiscard]] double at(SurfacePlace const& place) const;
};

/// The sum of bulbs. Throws MotionError for extents that are not positive, values that are not finite, and bulbs that
/// reach around the other edge, where distances from theirs end. The rule refuses heights above the chord.
InflateRule make_bulbs(std::vector<Bulb> bulbs, InflateRule::Sections const& sections);

}  // namespace gridmorph
