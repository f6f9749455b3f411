// Where a blade meets an end wall in a mesh of elements: edges that faces of both have in common, one after another.
// And how layers of the two walls meet between them: hexahedra around such a root line as a lattice, and the places
// that become the mitre of a fillet.
#pragma once

#include <gridmorph/mesh/unstructured_topology.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

namespace gridmorph {

/// The elements of a mesh around places that zones share. Refers to its mesh and topology. A place is known by the
/// smallest number among its nodes (nodes_at_one_place()).
class JoinedElements {
 public:
  JoinedElements(Mesh const& mesh, UnstructuredTopology const& topology);

  [[nodiscard]] Mesh const& mesh() const { return mesh_; }
  [[nodiscard]] UnstructuredTopology const& topology() const { return topology_; }
  [[nodiscard]] Index32 place(Index32 node) const { return place_[node]; }
  /// All nodes at a place.
  [[nodiscard]] std::vector<Index32> nodes_at(Index32 place) const;
  /// Elements that have a place among their corners, ascending in each zone.
  [[nodiscard]] std::vector<Index32> around(Index32 place) const;
  /// The elements that have all of some places among their corners.
  [[nodiscard]] std::vector<Index32> with(std::span<Index32 const> places) const;
  [[nodiscard]] bool has(Index32 element, Index32 place) const;
  /// The corner of an element at a place; -1: none.
  [[nodiscard]] Index32 node_at(Index32 element, Index32 place) const;
  [[nodiscard]] Vec3 position(Index32 place) const { return mesh_.coordinates[place]; }

 private:
  Mesh const& mesh_;
  UnstructuredTopology const& topology_;
  std::vector<Index32> place_;
  std::unordered_map<Index32, std::vector<Index32>> further_;  ///< nodes at places that have several
};

/// Edges of the faces of two walls.
class WallEdges {
 public:
  WallEdges(JoinedElements const& elements, BoundaryFacePatches const& face_patches, std::span<int const> blade,
            std::span<int const> end_wall);

  /// Whether faces of wall 0 (blade) or 1 (end wall) have an edge between two places.
  [[nodiscard]] bool on(int wall, Index32 a, Index32 b) const { return (walls_of(a, b) & (1 << wall)) != 0; }
  [[nodiscard]] bool on_none(Index32 a, Index32 b) const { return walls_of(a, b) == 0; }
  /// Which wall a boundary face is of; -1: neither.
  [[nodiscard]] int wall_of_face(Index32 face) const { return face < 0 ? -1 : wall_[face]; }
  /// Mean of the faces' normals at a place, weighted by area, into the mesh; zero where there is none.
  [[nodiscard]] Vec3 normal(int wall, Index32 place) const;
  [[nodiscard]] bool on(int wall, Index32 place) const { return normals_[wall].contains(place); }
  /// Ends of the edges that both walls have, ascending.
  [[nodiscard]] std::vector<std::array<Index32, 2>> common() const;

 private:
  [[nodiscard]] int walls_of(Index32 a, Index32 b) const;

  std::vector<int> wall_;  ///< per boundary face
  std::unordered_map<std::uint64_t, int> edges_;
  std::array<std::unordered_map<Index32, Vec3>, 2> normals_;  ///< sums over faces
};

struct RootLine {
  std::vector<Index32> places;  ///< in order
  bool closed = false;          ///< the first follows on the last
  bool cut =
      false;  ///< each edge has one element around it, a hexahedron with a face on either wall, which is to be cut

  [[nodiscard]] std::size_t n_edges() const { return closed ? places.size() : places.size() - 1; }
  [[nodiscard]] std::array<Index32, 2> edge(std::size_t k) const {
    return {places[k], places[(k + 1) % places.size()]};
  }
};

/// Whether a boundary face is of neither wall and no interface of two zones.
bool is_foreign(JoinedElements const& elements, WallEdges const& edges, Index face);

/// The boundary faces that lie across an end of an open line (0: its first place, 1: its last one), which the line ends
/// on; none where it ends inside the mesh, as at the edges of a blade.
std::vector<Index32> faces_across_end(JoinedElements const& elements, WallEdges const& edges, RootLine const& line,
                                      int end);

/// All root lines of two walls. A line ends where three meet, and where the elements along it do not follow on one
/// another, as at the edges of a blade in an H mesh. Throws MeshError where the walls do not meet, and for elements
/// with a face on either wall that are no hexahedra. Cost O(faces of the walls).
std::vector<RootLine> find_root_lines(JoinedElements const& elements, WallEdges const& edges);

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
