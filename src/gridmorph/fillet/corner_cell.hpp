// Hexahedra around a root line as a lattice: from one to the next off either wall, and on along the corner.
#pragma once

#include <gridmorph/fillet/root_line.hpp>

#include <array>
#include <optional>
#include <unordered_map>

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

}  // namespace gridmorph
