// Boundary conditions and connections of unstructured zones, and of the blocks beside them.
#pragma once

#include <gridmorph/io/cgns/cgns_sections.hpp>

namespace gridmorph::cgns {

/// Appends the BC_t nodes of all zones to mesh.patches, then the boundary sections that no BC_t names, and the families
/// to mesh.families. `faces`: those of each zone, none of blocks; marks what boundary conditions claim. The ranges of
/// blocks become faces.
void read_boundary(File const& file, Node const& tree, Layout const& layout, std::vector<ListedFaces>& faces,
                   Mesh& mesh, Problems& problems);

/// Appends GridConnectivity_t nodes: those that pair node with node to mesh.connections, the others to mesh.patches
/// with kind `connection`. The coordinates must be there: pairs are checked, and found by position where a file does
/// not list them. Blocks: GridConnectivity1to1_t too; ranges and lists are of index tuples.
void read_connections(File const& file, Layout const& layout, std::vector<ListedFaces>& faces, Mesh& mesh,
                      Problems& problems);

}  // namespace gridmorph::cgns
