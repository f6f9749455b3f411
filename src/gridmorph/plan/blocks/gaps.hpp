// Gaps: the layer of blocks between walls that move and walls close by on which nodes slide, as over the tips of
// blades.
//
//     case (slips)      =====================================
//                          |       |  gap  |       |            gap layer: lines run from the tip's plane to the case
//     plane of the tip  ---+-------#########-------+---
//                          |       # blade #       |
//
// There is no room for a near field, and lines that cross the gap from side to side know nothing of the tip. So lines
// run across it: the motion of the tip, and of the faces that continue its plane, goes on to the sliding wall, and what
// puts nodes back on that is shared by all cells between alike.
#pragma once

#include <gridmorph/boundary/links.hpp>
#include <gridmorph/motion/boundary_motion.hpp>
#include <gridmorph/plan/blocks/chain.hpp>

#include <vector>

namespace gridmorph {

/// Whether each patch is a wall at a gap: it ranks as a wall (`kinds`), an explicit rule other than `fixed` moves it,
/// all grid lines off it end on walls that slip, and are on average shorter than half the root of the area of all
/// patches that the rule moves towards such walls. Looks at 81 lines of a patch at most.
std::vector<char> gap_walls(Mesh const& mesh, Links const& links, BoundaryMotion const& surface,
                            std::vector<PatchKind> const& kinds);

class Gaps {
 public:
  Gaps() = default;
  /// Finds the gap layers. Cost: linear in the entities of the cut mesh.
  Gaps(Mesh const& mesh, Topology const& topology, ResolvedMotion const& motion, std::vector<char> const& walls);

  [[nodiscard]] bool any() const { return !axis_of_block_.empty(); }
  /// Whether the block is in a gap layer.
  [[nodiscard]] bool holds(int block) const { return any() && axis_of_block_[block] >= 0; }
  /// Whether a step of a chain runs across a gap, from wall to wall.
  [[nodiscard]] bool runs_across(ChainStep const& step) const {
    return holds(step.block) && axis_of_block_[step.block] == step.to_chain.inverse().axis[0];
  }
  /// Whether all of a chain does.
  [[nodiscard]] bool runs_across(Chain const& chain) const;
  /// Whether a chain passes a gap layer beside its lines.
  [[nodiscard]] bool is_crossed_by(Chain const& chain) const;

 private:
  std::vector<int> axis_of_block_;  ///< along its lines; -1: in no gap
};

}  // namespace gridmorph
