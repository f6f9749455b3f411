// Nodes of two zones at one place that no interface joins.
#pragma once

#include <gridmorph/plan/blocks/boundary.hpp>

namespace gridmorph {

/// Says in a note of the plan how many nodes of patches coincide with nodes of another zone (coincidence_tolerance())
/// that they share no displacement with, and where the first are: without an interface each zone goes its own way
/// there. Nodes of connections that do not match node to node are left out, as they are to slide, and those that one
/// rule displaces on both sides. Call with the plan's skeleton complete. Cost O(n log n) in the nodes of patches.
void note_loose_nodes(Mesh const& mesh, BoundaryRequests const& boundary, Plan& plan);

}  // namespace gridmorph
