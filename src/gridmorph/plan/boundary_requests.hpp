// What the motion rules ask of the boundary nodes of a plan.
#pragma once

#include <gridmorph/motion/surface_motion.hpp>
#include <gridmorph/plan/plan.hpp>

#include <vector>

namespace gridmorph {

/// Which explicit rule asks for which boundary node, before any displacement is evaluated. Several requests may ask for
/// the same boundary node where patches meet.
struct BoundaryRequests {
  struct Request {
    Index boundary_node = 0;     ///< in Plan::boundary_nodes
    Index node = 0;              ///< the node in the requesting patch's zone: its position is what the rule sees
    std::int32_t rotation = -1;  ///< owner frame -> frame of that node
    int rule = 0;
    int patch = -1;  ///< or
    int interface = -1;
  };
  std::vector<Request>
      requests;  ///< by (rank, rule): the first request of a node gives its value, the others must agree
};

/// Displacement of every boundary node of the plan, in its frame. Throws MotionError that lists every pair of patches
/// whose displacements disagree on their common edge by more than the conformity tolerance (place, size).
std::vector<Vec3> evaluate_boundary(Mesh const& mesh, BoundaryRequests const& boundary, Plan const& plan,
                                    ResolvedMotion const& motion, SurfaceMotion const& surface, double mesh_size);

}  // namespace gridmorph
