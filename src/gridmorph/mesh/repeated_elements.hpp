// Elements that a file has twice: SU2 repeats a row of cells beyond one of its periodic sides.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

namespace gridmorph {

/// Leaves out elements whose corners all have periodic partners that are the corners of another element, and their
/// nodes, patch faces and pairs of connections: without them the passages of a row would lie on top of each other. Of
/// the two the one goes that takes fewer faces of patches along. Says in Mesh::notes how many. Meshes with blocks or
/// polyhedra stay as they are. Returns the number of elements left out. Cost: O(n log n) in the nodes of periodic
/// connections, and the elements once.
Index leave_out_repeated_elements(Mesh& mesh);

}  // namespace gridmorph
