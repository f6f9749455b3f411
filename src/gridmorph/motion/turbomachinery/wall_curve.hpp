// Hub or case of a row as a curve in the meridional plane, and the coordinates between two of them.
#pragma once

#include <gridmorph/geometry/cylindrical.hpp>
#include <gridmorph/geometry/slip_surface.hpp>

#include <vector>

namespace gridmorph {

/// A part of an end wall: a profile between two abscissae of its frame.
struct WallPiece {
  RevolutionProfile profile;
  kernels::MeridionalFrame frame{};
  double first = 0, last = 0;  ///< in the direction of the curve: first > last runs against the abscissa

  [[nodiscard]] MeridionalPoint at(double abscissa) const {
    double const ordinate = profile(abscissa);
    return {frame.axial(abscissa, ordinate), frame.radius(abscissa, ordinate)};
  }
};

/// Pieces one after another, by arc length. Points of the curve lie on the profiles to round-off; only how far along
/// they lie is tabulated. Gaps between pieces are bridged by straight lines; beyond the ends the end pieces go on.
class WallCurve {
 public:
  explicit WallCurve(std::vector<WallPiece> pieces);

  [[nodiscard]] double length() const { return length_; }
  /// The point at arc length s from the first end.
  [[nodiscard]] MeridionalPoint at(double s) const;

 private:
  struct Stretch {
    WallPiece piece;
    double begin = 0, end = 0;         ///< arc lengths
    RevolutionProfile abscissa;        ///< of the arc length from `begin`
    MeridionalPoint gap_from, gap_to;  ///< a straight line when there is no profile
  };
  std::vector<Stretch> stretches_;
  double length_ = 0;
};

/// Chains the pieces by their ends, the closest first, until two curves are left: hub first, the one that comes nearest
/// to the axis. Both begin at the end of the row where the hub's axial position is smaller. Throws MotionError for
/// fewer than two pieces.
std::vector<WallCurve> chain_walls(std::vector<WallPiece> pieces);

/// Where a point is in a row: along the flow path, across it.
struct FlowPosition {
  double m = 0;  ///< a length
  double h = 0;  ///< span fraction: 0 at the hub, 1 at the case
};

/// Coordinates of the meridional plane between two curves: straight lines from hub to case join points at equal
/// fractions of the two arc lengths. m is that fraction times the mean length of the curves, h the fraction of the
/// line:
///   x(m, h) = (1 - h) hub(m) + h case(m).
class FlowCoordinates {
 public:
  FlowCoordinates(WallCurve hub, WallCurve shroud);

  [[nodiscard]] MeridionalPoint point(FlowPosition const& f) const;
  /// The inverse, to round-off. Beyond the ends of the row the curves go on.
  [[nodiscard]] FlowPosition position(MeridionalPoint const& p) const;
  /// Length of the line from hub to case.
  [[nodiscard]] double height(double m) const;
  [[nodiscard]] double length() const { return length_; }

 private:
  /// The straight line at one fraction of the lengths.
  struct Line {
    MeridionalPoint from;
    double axial = 0, radius = 0;  ///< from hub to case
    /// Twice the area of the triangle with p: 0 on the line.
    [[nodiscard]] double beside(MeridionalPoint const& p) const {
      return (p.axial - from.axial) * radius - (p.radius - from.radius) * axial;
    }
    [[nodiscard]] double along(MeridionalPoint const& p) const {
      return ((p.axial - from.axial) * axial + (p.radius - from.radius) * radius) / (axial * axial + radius * radius);
    }
  };
  [[nodiscard]] Line line(double fraction) const;

  WallCurve hub_, shroud_;
  double length_ = 0;
  std::vector<Line> lines_;  ///< evenly spaced over the row
};

}  // namespace gridmorph
