// Boundary nodes: whose displacement the motion rules give, and how the rules agree where patches meet.
#pragma once

#include <gridmorph/motion/boundary_requests.hpp>
#include <gridmorph/plan/blocks/stage_builder.hpp>

#include <vector>

namespace gridmorph {

/// Makes the nodes of an entity class (of its owner) boundary nodes of the plan. Returns the number of the first.
Index add_boundary_nodes(PlanContext const& context, int entity_class, Plan& plan);

/// Marks every entity on the closure of explicitly moved faces, and of the pieces in regions, known and lists its
/// nodes. The order of slots and requests follows the lattice. Cost: O(boundary nodes).
BoundaryRequests collect_boundary(PlanContext const& context, BoundaryMotion const& surface,
                                  std::vector<std::string> const& kind_order, Known& known, Plan& plan);

}  // namespace gridmorph
