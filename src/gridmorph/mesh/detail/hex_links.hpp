// How hexahedra are joined to one another: for every side the cell behind it, and which corner is which.
#pragma once

#include <gridmorph/mesh/unstructured_topology.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace gridmorph::detail {

/// A hexahedron as a box of local indices: corner c (SIDS order) lies at bit 0, 1, 2 of corner_place[c] along its local
/// axes 0, 1, 2. The table is its own inverse.
inline constexpr std::array<int, 8> corner_place{0, 1, 3, 2, 4, 5, 7, 6};
/// The local axis that a side (SIDS order) lies across, and at which end of it.
inline constexpr std::array<int, 6> side_axis{2, 1, 0, 1, 0, 2}, side_end{0, 0, 1, 1, 0, 1};
/// The side at an end of an axis.
inline constexpr std::array<std::array<int, 2>, 3> side_at{{{4, 2}, {1, 3}, {0, 5}}};

/// The corners of a side in the order of face_corner().
inline std::array<int, 4> corners_of_side(int side) {
  std::array<int, 4> out{};
  for (int k = 0; k < 4; ++k) out[k] = face_corner(ElementType::hexahedron, side, k);
  return out;
}

/// Side `side` of cell `cell`, as one number; -1: none.
using CellSide = Index32;
inline CellSide cell_side(Index32 cell, int side) { return 6 * cell + side; }

/// How corners and local axes of one cell go on in another, across a side that both have.
struct HexTurn {
  Orientation axes;                     ///< of this cell's -> of that one's
  std::array<std::int8_t, 8> corner{};  ///< of the side's corners: theirs in that cell
};

/// How every side meets every other in all eight ways: 48 * side + 8 * other side + way.
extern std::array<HexTurn, 288> const side_turns;

/// What lies across a side.
struct HexLink {
  Index32 cell = -1;
  int side = -1;
  HexTurn const* turn = nullptr;
};

/// The links of all sides. Cells that are no hexahedra, and sides of them, have none.
class HexLinks {
 public:
  /// Nodes that connections join, periodic ones left out, count as one.
  HexLinks(HostInstance const& host, Mesh const& mesh, UnstructuredTopology const& topology);

  [[nodiscard]] bool is_hexahedron(Index32 cell) const { return mesh_.elements.type[cell] == ElementType::hexahedron; }
  /// The node that stands for those that connections, periodic ones left out, declare to be one.
  [[nodiscard]] Index32 representative(Index32 node) const { return representative_[node]; }
  /// That of corner c.
  [[nodiscard]] Index32 node(Index32 cell, int corner) const {
    auto const& nodes = mesh_.elements.nodes;
    return representative(only_hexahedra_ ? nodes.item[8 * Index(cell) + corner] : nodes[cell][corner]);
  }
  /// What lies behind a side inside the mesh; -1: nothing.
  [[nodiscard]] CellSide behind(CellSide s) const {
    return way_[s] < 0 ? -1 : cell_side(cell_behind(s), way_[s] / n_ways);
  }
  /// The link of a side that has something behind it.
  [[nodiscard]] HexLink link(CellSide s) const { return made(s, cell_behind(s), way_[s]); }
  /// The number of a side among the boundary faces; -1 where it is none. A search among these.
  [[nodiscard]] Index32 boundary_face(CellSide s) const;
  /// Across a periodic connection; nothing where a side lies on none.
  [[nodiscard]] std::optional<HexLink> periodic(CellSide s) const;
  /// The connection of a boundary face: 2 c, or 2 c + 1 from the donor's side.
  [[nodiscard]] Index32 connection(CellSide s) const { return topology_.boundary.connection[boundary_face(s)]; }

 private:
  static constexpr int n_ways = 8;  ///< in which two given sides may meet

  static HexLink made(CellSide from, Index32 cell, int way) {
    return {cell, way / n_ways, &side_turns[6 * n_ways * (from % 6) + way]};
  }
  [[nodiscard]] Index32 cell_behind(CellSide s) const {
    // Where all elements have six sides, they are numbered alike.
    Index32 const neighbour = only_hexahedra_ ? topology_.sides.neighbour[s] : topology_.sides.of(s / 6)[s % 6];
    return neighbour >= 0 ? neighbour : cell_across(s);
  }
  /// Of a side on a connection.
  [[nodiscard]] Index32 cell_across(CellSide s) const;
  /// n_ways * side there + the way in which the corners of one side are those of another, by `same(node of this, node
  /// of that)`; -1: they are not.
  template <class Same>
  [[nodiscard]] int way_between(CellSide from, CellSide to, Same const& same) const;
  [[nodiscard]] int find_way(CellSide s) const;

  Mesh const& mesh_;
  UnstructuredTopology const& topology_;
  bool only_hexahedra_;
  std::vector<Index32> representative_;
  std::vector<std::int8_t> way_;  ///< (6 cells) of way_between()
  /// Per connection, its nodes as pairs of representatives, ascending: from its side, and from the donor's.
  std::vector<std::vector<std::pair<Index32, Index32>>> pairs_;
};

}  // namespace gridmorph::detail
