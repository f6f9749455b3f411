// Boundary nodes: whose displacement the motion rules give, and how the rules agree where patches meet.
#pragma once

#include <gridmorph/motion/surface_motion.hpp>
#include <gridmorph/plan/stage_builder.hpp>

#include <vector>

namespace gridmorph {

/// Which explicit rule asks for which node, before any displacement is evaluated. One slot per owner node of a known
/// entity; several requests may ask for the same slot where patches meet.
struct BoundaryRequests {
  struct Request {
    Index slot = 0;
    Index node = 0;              ///< the node in the requesting patch's zone: its position is what the rule sees
    std::int32_t rotation = -1;  ///< owner frame -> frame of that node
    int rule = 0;
    int patch = -1;  ///< or
    int interface = -1;
  };
  std::vector<Index> nodes;  ///< owner node per slot
  std::vector<Request>
      requests;  ///< by (rank, rule): the first request of a slot gives its value, the others must agree
};

/// Makes the nodes of an entity class (of its owner) boundary nodes and adds the copies to their other occurrences.
/// Returns the slot of the first.
Index add_slots(Mesh const& mesh, Lattice const& lattice, int entity_class, RotationTable& rotations,
                BoundaryRequests& boundary, CopyTable& copies);

/// Marks every entity on the closure of explicitly moved faces known and lists its nodes. The order of slots and
/// requests follows the lattice. Cost: O(boundary nodes).
BoundaryRequests collect_boundary(Mesh const& mesh, Topology const& topology, ResolvedMotion const& motion,
                                  SurfaceMotion const& surface, std::vector<std::string> const& kind_order,
                                  RotationTable& rotations, Known& known, CopyTable& copies);

/// Displacement of every boundary node (slot), in the owner's frame. Throws MotionError that lists every pair of patches
/// whose displacements disagree on their common edge by more than the conformity tolerance (place, size).
std::vector<Vec3> evaluate_boundary(Mesh const& mesh, BoundaryRequests const& boundary,
                                    std::vector<Mat3> const& rotations, ResolvedMotion const& motion,
                                    SurfaceMotion const& surface, double mesh_size);

}  // namespace gridmorph
