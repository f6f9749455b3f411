// 2-D meshes as meshes of one cell layer.
#pragma once

#include <gridmorph/io/cgns/cgns_layout.hpp>

namespace gridmorph::cgns {

/// Gives flat zones their second node plane and their two symmetry patches "2-D plane".
///
/// The second plane is the first one shifted by one typical cell (the square root of the mean cell area) along the
/// missing direction: the coordinate axis along which the mesh is constant, otherwise the mean normal of its cells.
/// Plane 0 of every flat zone is already in the coordinates. Problems: a surface that closes on itself, so that no
/// direction is missing.
void add_second_planes(Layout const& layout, Mesh& mesh, Problems& problems);

/// Node steps of the two axes of a flat zone's planes and of the step between the planes, in the flat arrays of a mesh.
struct PlaneSteps {
  std::array<int, 2> axis;  ///< in-plane axes, ascending
  std::array<Index, 2> step;
  Index across;
};
PlaneSteps plane_steps(Zone const& zone, int flat_axis);

}  // namespace gridmorph::cgns
