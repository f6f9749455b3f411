// Boundary conditions and connections of a CGNS file, as patches and interfaces of a mesh.
#pragma once

#include <gridmorph/io/cgns/cgns_layout.hpp>

namespace gridmorph::cgns {

/// Appends the BC_t nodes of all zones to mesh.patches and the families to mesh.families. What is not on a face of its zone
/// is noted and skipped; ranges out of bounds are problems.
void read_boundary(File const& file, Node const& tree, Layout const& layout, Mesh& mesh, Problems& problems);

/// Appends GridConnectivity1to1_t nodes (and those GridConnectivity_t nodes that match node to node) to mesh.interfaces,
/// and other connections to mesh.patches with kind `connection`.
void read_connections(File const& file, Layout const& layout, Mesh& mesh, Problems& problems);

}  // namespace gridmorph::cgns
