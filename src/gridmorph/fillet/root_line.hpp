// Where a blade meets an end wall in a mesh of elements: edges that faces of both have in common, one after another.
#pragma once

#include <gridmorph/mesh/unstructured_topology.hpp>

#include <array>
#include <cstdint>
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
  [[nodiscard]] Index32 place(Index32 node) const { return place_[std::size_t(node)]; }
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
  [[nodiscard]] int wall_of_face(Index32 face) const { return face < 0 ? -1 : wall_[std::size_t(face)]; }
  /// Mean of the faces' normals at a place, weighted by area, into the mesh; zero where there is none.
  [[nodiscard]] Vec3 normal(int wall, Index32 place) const;
  [[nodiscard]] bool on(int wall, Index32 place) const { return normals_[std::size_t(wall)].contains(place); }
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

}  // namespace gridmorph
