// Where what is in a mesh comes again behind its free periodic connections.
#pragma once

#include <gridmorph/geometry/rigid_transform.hpp>
#include <gridmorph/motion/boundary_conditions.hpp>

#include <vector>

namespace gridmorph {

/// The moves from the places of a mesh to those of its images: the identity, then the transforms of its free periodic
/// connections and their inverses, each up to `passages` times. Those that come out alike, as behind the last passage
/// of a wheel, once. Transforms are fitted to the nodes, as those of BoundaryConditions::images are. Cost O(nodes of
/// the connections).
std::vector<RigidTransform> periodic_moves(HostInstance const& host, Mesh const& mesh, NodeGraph const& graph,
                                           BoundaryConditions const& boundary, int passages);

}  // namespace gridmorph
