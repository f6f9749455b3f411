// The side of an element across from one of its sides, where one lies over the other corner by corner: layers of
// elements on walls.
#pragma once

#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <vector>

namespace gridmorph {

/// below: the corner nodes of the side asked for, in the order of the element; above: the nodes at the other ends of
/// the edges that leave it there; side: the one whose corners these are. Triangles of prisms, quadrilaterals of
/// hexahedra, in 2-D edges of quadrilaterals; faces of a polyhedron where exactly one edge leaves each corner, to
/// another node each, and a face has these and no others: prismatic ones, whatever lies between.
struct OppositeSide {
  int side = -1;  ///< -1: none
  std::vector<Index32> below, above;
};

/// Fills `out`, whose lists are kept for the next call. Cost O(corners of the element), of a polyhedron those of all
/// faces times those of the side.
void find_opposite_side(Mesh const& mesh, Index element, int side, OppositeSide& out);

}  // namespace gridmorph
