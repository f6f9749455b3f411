// Quadrilaterals in rows put together into grids: the grid lines of a surface that is made of faces of elements.
#pragma once

#include <gridmorph/boundary/boundary.hpp>

#include <array>
#include <cstddef>
#include <vector>

namespace gridmorph {

/// Points of a surface along two directions, the first one fastest.
struct FaceGrid {
  std::array<int, 2> extent{0, 0};
  std::vector<int> point;  ///< the numbers that the faces have as corners
};

struct FaceGrids {
  std::vector<FaceGrid> grids;
  std::size_t left_over = 0;  ///< faces that are in no grid: triangles, and quadrilaterals in no rows
};

/// The grids that quadrilaterals make up. Faces are neighbours where they have a side in common and go the same way
/// around.
///
/// The surface is cut along its edges until every part is a grid: from every point where other than four faces meet, or
/// three beside a cut, straight on until the next cut; where that leaves more than one part, along creases of more than
/// `crease_angle_rad` too. A part that closes on itself is cut across, its first line again at its end. So the faces of
/// one face of a block make one grid with its lines. Faces of two corners (the sides of a plane mesh) make lines,
/// `extent` {n, 1}. Cost O(faces, log).
FaceGrids find_face_grids(std::vector<GridFacet> const& faces, std::vector<Vec3> const& points,
                          double crease_angle_rad = 0.87);

}  // namespace gridmorph
