// How far across its passage a point lies.
#pragma once

#include <gridmorph/boundary/boundary.hpp>
#include <gridmorph/wheel/rows.hpp>

#include <array>
#include <vector>

namespace gridmorph {

/// Fraction of the pitch from the lower periodic side (0) to the upper one (1), at the same place of the meridional
/// plane. Made from the grid lines, or the edges of faces, in which patches (an inlet, say) meet the lower side;
/// between their nodes the position along the pitch is linear. In a straight row that place is across the pitch.
class PitchFraction {
 public:
  PitchFraction(Boundary const& boundary, PassageLinks const& links, WheelRows const& rows, int row,
                std::vector<int> const& patches);

  [[nodiscard]] bool empty() const { return segments_.empty(); }
  /// Clamped to 0 ... 1. Cost: O(nodes of the lines).
  [[nodiscard]] double operator()(Vec3 const& p) const;

 private:
  struct Segment {
    PlaceInRow from, to;
  };

  RowPitch pitch_;
  std::vector<Segment> segments_;
};

}  // namespace gridmorph
