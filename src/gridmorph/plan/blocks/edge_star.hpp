// What meets at an edge of the cut mesh.
#pragma once

#include <gridmorph/plan/blocks/lattice.hpp>

#include <utility>
#include <vector>

namespace gridmorph {

/// The faces and pieces around an edge class, in all zones that have it.
struct EdgeStar {
  std::vector<int> faces;                         ///< face classes, ascending
  std::vector<int> pieces;                        ///< one entry per corner of a piece at this edge
  std::vector<std::pair<int, int>> corner_faces;  ///< per piece corner: its two face classes
};
EdgeStar star_of(Lattice const& lattice, int edge_class);

/// The face that continues another one across the edge: the one two corners of pieces away, as at a regular edge, or at
/// the rim of a wall that stands out into the mesh (three corners). -1: none does, or several do.
int straight_on(EdgeStar const& star, int face_class);

}  // namespace gridmorph
