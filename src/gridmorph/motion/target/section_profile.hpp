// One airfoil section: its edges, and positions around it by shares of the arc length.
#pragma once

#include <gridmorph/kernels/vec3.hpp>

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace gridmorph {

/// A position around a section, the same on every section of a blade: on which stretch, and at which share of its
/// length.
struct SectionPosition {
  /// 0: from the trailing edge to the leading edge; 1: from there back to the trailing edge; 2: across the blunt base,
  /// if there is one. Right-handed about the span.
  int stretch = 0;
  double fraction = 0;
};

/// A closed curve through the points of a section, C1 except at corners (turns of more than 40 degrees): cubic Hermite
/// pieces over the arc length of the polygon with slopes from parabolas through three neighbours.
///
/// The trailing edge is the end of the longest chord that lies downstream: the corners within a tenth of the chord of
/// it (one of a sharp edge, two of a blunt base), otherwise the point farthest from the other end, found between points
/// by a parabola. The leading edge is the point farthest from there. Both stay where they are when the section is moved
/// rigidly, run through backwards, or started elsewhere.
///
/// Edges::extreme is for H meshes, whose lines across the flow touch the blade in a round edge: there the edges without
/// corners are the points farthest up- and downstream, on the mesh as on the target.
///
/// `window` is for cuts through facets, whose points may be anywhere: parabolas at edges without corners then fit, by
/// least squares, the points within so many of the mean distances between points around there, and the next ones on
/// both sides.
class SectionProfile {
 public:
  enum class Edges { farthest, extreme };

  /// Points once around, the first one again at the end or not, or (open) from one side of the trailing edge to the
  /// other. `span`: direction the section is seen along; `flow`: downstream. Throws MotionError beginning with `name`.
  SectionProfile(std::vector<Vec3> points, Vec3 const& span, Vec3 const& flow, std::string const& name,
                 Edges edges = Edges::farthest, double window = 0);

  /// The positions of the points that were given, in their order.
  [[nodiscard]] std::vector<SectionPosition> positions() const;
  /// The position of the place at the share t of the way from given point n to the next one.
  [[nodiscard]] SectionPosition position(int n, double t) const;
  /// The point at a position; exactly one of the points given where the position agrees with its own to 1e-9.
  [[nodiscard]] Vec3 at(SectionPosition const& position) const;
  [[nodiscard]] std::vector<Vec3> const& points() const { return points_; }

 private:
  [[nodiscard]] int size() const { return int(points_.size()); }
  [[nodiscard]] int wrap(int n) const { return ((n % size()) + size()) % size(); }
  [[nodiscard]] bool is_corner(int n) const;
  [[nodiscard]] SectionPosition position_at(double s) const;
  /// The length at which the measure is greatest near point n.
  [[nodiscard]] double extreme_length(int n, std::function<double(Vec3 const&)> const& measure) const;
  [[nodiscard]] double fitted_extreme(int n, std::function<double(Vec3 const&)> const& measure) const;
  [[nodiscard]] Vec3 at_length(double s) const;
  [[nodiscard]] Vec3 slope(int n, int side) const;
  void find_edges(Vec3 const& flow, std::string const& name, Edges edges);

  double window_ = 0;
  std::vector<Vec3> points_;         ///< right-handed about the span
  std::vector<int> given_;           ///< number in points_ of every point that was given
  std::vector<double> length_;       ///< (size + 1) arc length of the polygon up to each point, and around
  std::array<double, 4> stretch_{};  ///< where the stretches begin: ascending, the last one a turn after the first
};

}  // namespace gridmorph
