// Boundary conditions and connections of a CGNS file, as patches and interfaces of a mesh.
#pragma once

#include <gridmorph/io/cgns/cgns_layout.hpp>

namespace gridmorph::cgns {

/// Appends the BC_t nodes of all zones to mesh.patches and the families to mesh.families. What is not on a face of its
/// zone is noted and skipped; ranges out of bounds are problems.
void read_boundary(File const& file, Node const& tree, Layout const& layout, Mesh& mesh, Problems& problems);

/// Appends GridConnectivity1to1_t nodes (and those GridConnectivity_t nodes that match node to node) to
/// mesh.interfaces, and other connections to mesh.patches with kind `connection`.
void read_connections(File const& file, Layout const& layout, Mesh& mesh, Problems& problems);

// Of one zone or node, for readers of blocks beside elements:

/// The families of all bases that have zones.
void add_families(Layout const& layout, Mesh& mesh);
/// The BC_t nodes of a block, as read_boundary() takes them.
void read_block_boundary(File const& file, Node const& tree, Layout const& layout, int zone, Mesh& mesh,
                         Problems& problems);
/// A child of a block's ZoneGridConnectivity_t, whose donor is a block or is not there, as read_connections() takes it.
void read_block_connection(File const& file, Layout const& layout, int zone, Node const& node, Mesh& mesh,
                           Problems& problems);
/// The zone that a connection names: one of the same base, or "Base/Zone"; -1 where there is none.
int find_donor(Layout const& layout, ZoneLayout const& zone, std::string const& name);

}  // namespace gridmorph::cgns
