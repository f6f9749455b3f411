// Which of the transforms that map open face cells onto open face cells are the periodicity of a machine, and which are
// chance. Internal to topology.
#pragma once

#include <gridmorph/boundary/detail/find_periodic.hpp>

#include <string>
#include <vector>

namespace gridmorph::topology {

struct Judgement {
  bool taken = false;
  std::string why;  ///< not taken: the reason, for a remark
};

/// One per match. A pair of sides counts when
/// - it is sizeable: each side has a fiftieth of the open area or more, and few of its edges run through open surface
/// that goes
///   on smoothly (a part of a face is whole where it ends at a patch, an interface, a corner or along few lines);
/// - the sides lie on both ends of the passage: the way from one to the other leads into the mesh at the start and out
/// of it at
///   the end, and they are not parts of one plane;
/// - a rotation is a whole number of times in a full turn, and the mesh nowhere lies much nearer to the axis or further
/// away
///   than the sides do (a cube turns onto itself too); of several, those about the axis of the largest;
/// - a translation is not between planes, which inlets and outlets, end walls and far fields are too, unless the
/// boundary that is
///   declared leaves nothing else open.
/// The two planes of a mesh of one cell layer do not count as open area. `open`: for each cell whether it was open
/// before the matches took theirs. Cost: O(surface cells).
std::vector<Judgement> judge(SurfaceCells const& cells, std::vector<PeriodicMatch> const& matches,
                             std::vector<std::uint8_t> const& open);

}  // namespace gridmorph::topology
