// Hexahedra in the corner between two walls, cut in two along the mitre.
#pragma once

#include <gridmorph/fillet/mitre_path.hpp>

#include <vector>

namespace gridmorph {

/// The mesh with these hexahedra cut through node[.][0][0] and node[.][1][1] of both ends, into two prisms each, and
/// those that follow on them behind the ends of the line, up to the boundary: the cut quadrilaterals have to be those
/// of both neighbours. Faces of patches are cut with them. Nodes are those of the mesh, elements are counted anew.
/// Throws MeshError where other elements than hexahedra follow. Cost O(mesh).
Mesh cut_corners(CornerLattice const& lattice, std::vector<CornerCell> const& cells);

}  // namespace gridmorph
