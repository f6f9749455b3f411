// What a guard moved nodes by, as a linear function of the boundary's displacement: a part that a plan may carry.
#pragma once

#include <gridmorph/core/index.hpp>
#include <gridmorph/geometry/slip_surface.hpp>
#include <gridmorph/kernels/frozen_shifts.hpp>

#include <vector>

namespace gridmorph {

/// What is added to the nodes after a morph of the boundary displacement u
///
///   a_d = sum over boundary nodes b of gauge_d(b) . u(b),    u(n) += sum over d of a_d shift_d(n)
///
/// a fixed linear map: no displacement gives no shift, to the bit; a scaled one scales it; a rate of the boundary's
/// displacement gives that of the shift. Nodes on slip surfaces go back onto them after it. Made by SmoothingRecord
/// (guard/guard.hpp), applied by a Morpher at the end of every call. Cost per call: modes times 24 bytes
/// read per boundary node and per node that moves, 48 for the latter's displacement.
struct SmoothingMap {
  int n_modes = 0;
  int n_records = 0;         ///< displacements that it was made of
  double largest_shift = 0;  ///< of a node in these
  double misfit = 0;         ///< largest distance from there to where the map brings the node, before it slides
  Index n_nodes = 0, n_boundary = 0;  ///< of the mesh and plan that it belongs to
  std::vector<Vec3> gauge;            ///< (n_modes, n_boundary)
  std::vector<Index> node;            ///< nodes that move in space, ascending
  std::vector<Vec3> shift;            ///< (node, n_modes), in the frame of the node
  // Blocks: points that slide, and all nodes at each.
  std::vector<kernels::SlidingShift> slides;
  std::vector<Vec3> slide_shift;  ///< (slides, n_modes), in the frame of SlidingShift::node
  std::vector<kernels::SlidingNode> slide_nodes;
  std::vector<SlipSurface> surfaces;  ///< the surfaces that `slides` name

  [[nodiscard]] Index n_moved() const { return Index(node.size() + slide_nodes.size()); }
};

}  // namespace gridmorph
