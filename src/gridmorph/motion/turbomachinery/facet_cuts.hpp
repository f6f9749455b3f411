// The facets of a blade cut at a span fraction.
#pragma once

#include <gridmorph/kernels/vec3.hpp>

#include <array>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

namespace gridmorph {

/// Facets, and where they are along the span and the flow.
struct SliceInput {
  std::vector<Vec3> points;
  std::vector<std::array<int, 3>> triangles;
  std::function<double(Vec3 const&)> span;    ///< span fraction
  std::function<double(Vec3 const&)> along;   ///< increases along the flow
  std::function<double(Vec3 const&)> height;  ///< length of the span through a point
  std::vector<double> at = {};  ///< span fraction of each point, where it is known; otherwise `span` says it
};

/// Span that facets with a part in sections gain at least, over their length: tip faces gain less.
inline constexpr double least_span_gain = 0.3;
/// Length of the gradient of the values at its corners in a triangle; 0 where it has no area.
double gradient_in(std::array<Vec3, 3> const& corners, std::array<double, 3> const& values);

/// A place on the surface: a weighted mean of its points. Its span is that of its section, which places inside facets
/// are a little off.
struct SlicePlace {
  std::vector<std::pair<int, double>> weights;
  Vec3 point;
  double span = 0;
};

/// Points of one section in their order.
struct CutLine {
  std::vector<int> edges;  ///< of the surface that the points lie on
  std::vector<Vec3> points;
  bool closed = false;

  [[nodiscard]] int size() const { return int(points.size()); }
  /// The diagonal of the line's box.
  [[nodiscard]] double extent() const;
  /// Twice the area vector of the line; an open one is closed by a straight line.
  [[nodiscard]] Vec3 area() const;
  void reverse();
};

/// Triangles that hang together, by the lower end of their span.
struct SurfacePart {
  std::vector<int> triangles;
  std::vector<double> low;  ///< per triangle, ascending
  double rise = 0;          ///< the most span that one of them takes up
};

/// Triangles that gain span (least_span_gain) with their edges. Keeps a reference to its input.
class FacetCuts {
 public:
  /// Ends of the span are whole lines of nodes but for round-off: spans within 1e-9 of the whole of them are theirs.
  /// Throws MotionError when no triangle gains span. Cost O(triangles, log).
  explicit FacetCuts(SliceInput const& input);

  [[nodiscard]] std::vector<SurfacePart> parts() const;
  [[nodiscard]] std::pair<double, double> range(SurfacePart const& part) const;
  /// The points of a part's triangles.
  [[nodiscard]] std::vector<std::array<int, 3>> corners(SurfacePart const& part) const;
  /// Mean span that a triangle takes up.
  [[nodiscard]] double step(SurfacePart const& part) const;

  /// The contour of a part at a span fraction, without points where it has none: the line that reaches farthest. Pieces
  /// with gaps of less than a tenth of the extent between them are one. `upper`: points at the span fraction are above
  /// it. Cost: the triangles beside it.
  [[nodiscard]] CutLine cut(SurfacePart const& part, double span, bool upper) const;
  /// Where an edge has the span fraction: by secants, since span is not linear along an edge where hub or case are
  /// curved.
  [[nodiscard]] SlicePlace place(int edge, double span) const;

 private:
  [[nodiscard]] std::pair<double, double> range(int triangle) const;
  [[nodiscard]] bool rises(std::array<int, 3> const& triangle) const;
  void find_edges();
  [[nodiscard]] bool above(int point, double span, bool upper) const {
    return upper ? span_[point] >= span : span_[point] > span;
  }
  [[nodiscard]] double linear_fraction(int edge, double span) const;
  [[nodiscard]] double fraction(int edge, double span) const;
  [[nodiscard]] Vec3 between(int edge, double fraction) const;

  SliceInput const& input_;
  std::vector<double> span_;  ///< per point
  std::vector<std::array<int, 3>> triangles_;
  std::vector<std::array<int, 2>> edges_;     ///< points, the lower number first
  std::vector<std::array<int, 3>> edges_of_;  ///< per triangle
};

}  // namespace gridmorph
