// Connections of meshes of second order that pair corners alone. Host.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

namespace gridmorph {

/// Nodes amid the edges and sides of boundary faces whose corners a connection pairs join it, each with the one amid
/// the same corners there, where the two coincide (periodic ones: after the transform) to `tolerance` [length]. Gmsh
/// lists corners alone where the order was raised after the mesh was made. Adds nothing where they are paired already;
/// returns how many it added. The mesh must have passed check_mesh(). Linear cost, none in meshes of first order.
Index pair_middle_nodes(Mesh& mesh, double tolerance);

}  // namespace gridmorph
