// Nodes of different zones at the same place, and the middle nodes of what connections pair. Host.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <functional>
#include <utility>
#include <vector>

namespace gridmorph {

/// All pairs (first < second) of the nodes given, each once in the list, that lie in different zones within `tolerance`
/// of each other; ascending. Cost O(n log n) while few nodes are that close along an oblique line.
std::vector<std::pair<Index, Index>> coincident_pairs(Coordinates const& coordinates, std::vector<Index> const& nodes,
                                                      std::function<int(Index node)> const& zone, double tolerance);

/// Nodes amid the edges and sides of boundary faces whose corners a connection pairs join it, each with the one amid
/// the same corners there, where the two coincide (periodic ones: after the transform) to `tolerance` [length]. Gmsh
/// lists corners alone where the order was raised after the mesh was made. Adds nothing where they are paired already;
/// returns how many it added. The mesh must have passed check_mesh(). Linear cost, none in meshes of first order.
Index pair_middle_nodes(Mesh& mesh, double tolerance);

}  // namespace gridmorph
