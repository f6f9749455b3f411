// Bulbs on the contour of a blade or wing, such as a leading-edge bulb at its root, as heights of an inflated surface.
#pragma once

#include <gridmorph/motion/motion.hpp>

#include <optional>
#include <string>
#include <vector>

namespace gridmorph {

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
