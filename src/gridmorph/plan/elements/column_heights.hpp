// Where columns end: as high as the boundary layer goes, but smoothly along the wall and not across narrow gaps.
#pragma once

#include <gridmorph/plan/elements/columns.hpp>
#include <gridmorph/plan/elements/wall_distance.hpp>

#include <cstddef>
#include <functional>
#include <vector>

namespace gridmorph {

/// How far what is as rigid as a moving wall may reach into a gap to another boundary, so that enough of the gap is
/// left to take up the motion:
///
///     room = min(gap / 3, max(gap - 2 motion, gap / 10))
double room_in_gap(double gap, double motion);

/// The gap ahead of each node (n_nodes): for wall nodes where the nearest other boundary lies ahead (within 60 degrees
/// of where the column leads), the distance to it; infinite elsewhere: a boundary beside, on which the wall ends,
/// leaves no gap. Cost O(nodes of columns).
std::vector<double> gaps_ahead(Coordinates const& coordinates, Columns const& columns, NearestSource const& from_other);

/// Where columns end, by their wall nodes; 0 where there is none.
struct ColumnEnds {
  std::vector<double> height;  ///< (n_nodes) length of the column
  std::vector<double> rise;    ///< (n_nodes) as Columns::full_rise
};

/// The ends of columns, not above `most`, no longer than `longest` where that is given, and without the jumps between
/// neighbours whose columns end in different layers. What varies with the share of the height, and what begins at its
/// end, must not jump. First the least of the neighbours, so that columns are hardly ever longer. Neither lengths nor
/// rises would do alone, so a column ends where the higher of both asks for it: beside the edge of a blade lines may
/// lean by 80 degrees, and columns rise like their neighbours and are six times as long. Cost O(wall nodes).
ColumnEnds smooth_ends(NodeGraph const& graph, Columns const& columns, std::vector<double> const& most,
                       std::vector<double> const& longest = {});

/// Those nodes of columns for which keep(k) is true, asked in their order; heights are not made anew.
Columns kept_nodes(Columns const& columns, std::function<bool(std::size_t)> const& keep);

/// Columns up to their ends; what is above belongs to the layers.
Columns cut(Columns const& columns, ColumnEnds const& ends);

}  // namespace gridmorph
