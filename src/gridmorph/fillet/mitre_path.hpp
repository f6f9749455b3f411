// How layers of two walls meet between them: hexahedra around a root line as a lattice, and the places that become the
// mitre of a fillet.
#pragma once

#include <gridmorph/fillet/root_line.hpp>

#include <array>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

namespace gridmorph {

/// A hexahedron seen along the corner.
struct CornerCell {
  Index32 element = -1;
  /// Nodes: at either end along the corner, nearer (0) to or farther (1) from the blade, from the end wall.
  std::array<std::array<std::array<Index32, 2>, 2>, 2> node{{{{{-1, -1}, {-1, -1}}}, {{{-1, -1}, {-1, -1}}}}};
};

class CornerLattice {
 public:
  CornerLattice(JoinedElements const& elements, WallEdges const& edges) : elements_(elements), edges_(edges) {}

  /// The only element along a root edge, its ends in the order of the edge. Throws MeshError for a collapsed one, and
  /// where both of its faces there are of one wall.
  [[nodiscard]] CornerCell first(std::array<Index32, 2> const& root_edge) const;
  /// The cell next to one, farther off a wall; nothing where there is no hexahedron.
  [[nodiscard]] std::optional<CornerCell> off(CornerCell const& cell, int wall) const;
  /// The cell behind an end of one along the corner, across periodic connections too; nothing at boundaries. Throws
  /// MeshError for other elements.
  [[nodiscard]] std::optional<CornerCell> behind(CornerCell const& cell, int end) const;
  /// The nodes around the face at an end, from the one at the walls on, the farthest one third.
  [[nodiscard]] static std::array<Index32, 4> end_face(CornerCell const& cell, int end);

  [[nodiscard]] JoinedElements const& elements() const { return elements_; }

 private:
  [[nodiscard]] Index32 across(Index32 element, std::array<Index32, 4> const& nodes) const;
  [[nodiscard]] Index32 partner(Index32 node, Index32 connection_side) const;

  JoinedElements const& elements_;
  WallEdges const& edges_;
  mutable std::unordered_map<Index32, std::unordered_map<Index32, Index32>>
      partners_;  ///< per side of a connection, as found
};

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
