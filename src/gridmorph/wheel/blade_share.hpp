// Whose motion a boundary node of a passage has when the blades differ: its own blade's, a neighbour's, or some of
// both.
#pragma once

#include <gridmorph/boundary/boundary.hpp>
#include <gridmorph/motion/boundary_requests.hpp>
#include <gridmorph/motion/motion.hpp>
#include <gridmorph/wheel/rows.hpp>

#include <cmath>
#include <functional>
#include <vector>

namespace gridmorph {

/// Where a boundary node lies between the blades, counted in blades: node n of passage p moves as blade p + position
/// where that is a whole number, and otherwise as the two blades beside it, linearly between them.
///
/// On a blade the position is whole: 0, or 1 for the side that a passage of an H mesh has of its upper neighbour's
/// blade. Elsewhere it is the fraction of the pitch from the lower periodic side (0) to the upper one (1), minus 1/2
/// where the blades stand inside their passages: then a periodic side is halfway between two blades, and has the mean
/// of their motions. Where the blades stand on the periodic sides (H meshes), a periodic side has the motion of its
/// blade alone.
struct BladeShare {
  double position = 0;
  bool on_axis = false;  ///< the same point in every passage: the mean motion of all blades, along the axis

  [[nodiscard]] int lower() const { return int(std::floor(position)); }
  [[nodiscard]] double weight_of_upper() const { return position - std::floor(position); }
};

/// For each node one that stands for all at its place, in whichever zone; itself where it is alone.
using OneOfPlace = std::function<Index(Index)>;

/// That of nodes which the plain ones among the links of blocks join.
OneOfPlace one_of_place(PassageLinks const& links, WheelRows const& rows);

/// One per boundary node. open: the rows whose blades differ; nodes of others have position 0. `sector`, `links` and
/// `motion` are those of the sector, `requests` and their `nodes` what the plan asks. Blades are the patches that slide
/// and follow rules are `of`, or without these the walls whose displacement is given. Throws MotionError where a blade
/// hangs together with its neighbour. Cost: O(nodes of links + boundary nodes), times the nodes along the sides for
/// slide rules.
std::vector<BladeShare> blade_shares(Boundary const& sector, PassageLinks const& links, WheelRows const& rows,
                                     ResolvedMotion const& motion, std::vector<char> const& open,
                                     OneOfPlace const& one_of_place, BoundaryRequests const& requests,
                                     std::vector<Index> const& nodes);

}  // namespace gridmorph
