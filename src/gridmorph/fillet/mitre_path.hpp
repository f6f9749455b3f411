// How layers of two walls meet between them: the places of a mesh that become the mitre of a fillet.
#pragma once

#include <gridmorph/fillet/corner_cell.hpp>

#include <span>
#include <vector>

namespace gridmorph {

/// A place of the mitre, away from the corner.
struct MitrePlace {
  Index32 place = -1;
  std::array<int, 2> layer{0, 0};  ///< off the blade and off the end wall
};

/// The mitre of a root line, from the corner on.
struct Mitre {
  std::vector<std::vector<MitrePlace>> at;  ///< per place of the line, without that place
  std::vector<std::vector<Index32>>
      on_walls;                     ///< per place of the line that is to be cut: first nodes off it on either wall
  std::vector<CornerCell> cut;      ///< hexahedra, cut through node[.][0][0] and node[.][1][1] of both ends
  std::array<int, 2> layers{0, 0};  ///< that it passes off the blade and the end wall; of lines to be cut
};

/// What a mitre has to reach.
struct MitreReach {
  std::span<double const> radius;  ///< per place of the line
  std::array<int, 2> layers{
      0, 0};  ///< off the blade and the end wall; 0, 0: as many as reach 0.8 radii along all of the line
};

/// The mitre of a line whose edges have one hexahedron each: diagonals of cells and, where layers of one wall are
/// thinner than those of the other, edges in between, so that it stays about as far from one wall as from the other;
/// the same steps all along the line, as the cells that are cut have to follow on one another. It ends where there are
/// no hexahedra any more.
///
/// That of a line with several elements around each edge: the grid line that leaves the walls there, where there is
/// one.
Mitre find_mitre(CornerLattice const& lattice, WallEdges const& edges, RootLine const& line, MitreReach const& reach);

}  // namespace gridmorph
