// Corners between two walls in a mesh of elements: hexahedra in them cut in two along the mitre, and where nodes go
// when root lines are filled.
#pragma once

#include <gridmorph/fillet/mitre_path.hpp>
#include <gridmorph/fillet/root_sections.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace gridmorph {

/// The mesh with these hexahedra cut through node[.][0][0] and node[.][1][1] of both ends, into two prisms each, and
/// those that follow on them behind the ends of the line, up to the boundary: the cut quadrilaterals have to be those
/// of both neighbours. Faces of patches are cut with them. Nodes are those of the mesh, elements are counted anew.
/// Throws MeshError where other elements than hexahedra follow. Cost O(mesh).
Mesh cut_corners(CornerLattice const& lattice, std::vector<CornerCell> const& cells);

/// The corner is made round node by node (BetweenSections::place()); nodes of the walls are put onto arcs and walls
/// exactly, and what that takes is handed to the nodes over them. `on_arc`: per node, whether it is on a fillet. Cost
/// O(nodes), and O(log facets) for those near the lines.
Coordinates round_corners(JoinedElements const& elements, WallEdges const& edges, RootSections const& sections,
                          std::array<FacetSurface const*, 2> const& walls, std::vector<std::uint8_t>& on_arc);

}  // namespace gridmorph
