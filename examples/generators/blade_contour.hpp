// How nodes are spread round an airfoil. Internal to the demo.
#pragma once

#include <generators/passage_geometry.hpp>

#include <vector>

namespace gridmorph::passage {

/// One side of an airfoil from leading to trailing edge, measured along the curve parallel to it at a distance of
/// a quarter chord: even spacing there clusters nodes where the contour turns, smoothly.
class BladeSide {
 public:
  enum class Side { upper, lower };
  BladeSide(Airfoil const& airfoil, Side side);

  /// phi at a fraction (0 leading edge, 1 trailing edge) of the parallel curve's length.
  [[nodiscard]] double phi(double fraction) const;
  /// Fraction at which the contour has turned by an angle since the leading edge; of the angles the contour turns by
  /// more than once, the place nearest the leading edge.
  [[nodiscard]] double fraction_of_turn(double turn_rad) const;
  /// The same before the trailing edge, as a fraction counted from there.
  [[nodiscard]] double fraction_before_end(double turn_rad) const;

 private:
  std::vector<double> phi_, measure_, turn_;
};

}  // namespace gridmorph::passage
