// Blade rows of a sector mesh: which zones belong together, and how many of their passages make a wheel.
#pragma once

#include <gridmorph/motion/motion.hpp>
#include <gridmorph/wheel/passage_links.hpp>
#include <gridmorph/wheel/row_pitch.hpp>

#include <vector>

namespace gridmorph {

/// Zones that hang together by 1-to-1 interfaces or connections, periodic ones included.
struct WheelRow {
  std::vector<int> zones;  ///< ascending
  int passages = 1;        ///< that make 360 degrees; 1 for zones without a periodic
                           ///< link, 0 for straight rows, which have no number
  RowPitch pitch;
  [[nodiscard]] bool periodic() const { return passages != 1; }
};

struct WheelRows {
  std::vector<WheelRow> rows;    ///< by their first zone
  std::vector<int> row_of_zone;  ///< per Mesh::zones
  /// The pitch of any of the periodic rows, which are all wheels or all straight: what
  /// their motions are shared by. That of a turn by 360 degrees where there is
  /// none.
  [[nodiscard]] RowPitch any_pitch(Axis const& axis) const;
  std::vector<int>
      pitches_of_link;  ///< per PassageLinks::all: the donor is where own nodes are after so many pitches (0, 1, -1)
};

/// Finds the rows and checks that the periodic links of each turn by one pitch,
/// 360 degrees over a whole number, about the axis, node by node to their
/// tolerance, or that all of them shift by one pitch: of a straight row, the
/// mean over its nodes. Passages of a straight row count upwards in the
/// positive direction of the coordinate that its pitch has most of. Throws
/// MeshError naming every interface or connection that does not. Cost: O(nodes
/// of periodic links).
WheelRows find_rows(Mesh const& mesh, PassageLinks const& links, Axis const& axis);

}  // namespace gridmorph
