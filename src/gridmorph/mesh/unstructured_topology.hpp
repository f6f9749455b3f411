// What follows from the lists of an unstructured mesh: elements around nodes, neighbours, boundary faces, the patches
// they belong to, coincident nodes. Everything is gathered (each entry written once, by its own loop index), so the
// results do not depend on the number of threads. Host; linear cost.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <string>
#include <vector>

namespace gridmorph {

/// Elements that have a node among their corners, ascending: list n belongs to node n.
CsrGraph elements_of_nodes(HostInstance const& host, Mesh const& mesh);
inline CsrGraph elements_of_nodes(Mesh const& mesh) { return elements_of_nodes(HostInstance(), mesh); }

/// The other side of every side of every element.
struct ElementSides {
  static constexpr Index32 boundary = -1;   ///< nothing on the other side
  static constexpr Index32 crowded = -2;    ///< more than two elements have this side: overlapping elements
  static constexpr Index32 collapsed = -3;  ///< the side is a line or a point: the element names a node more than once

  std::vector<Index> first;        ///< (n_elements + 1): sides of element e are first[e] ... first[e + 1] - 1
  std::vector<Index32> neighbour;  ///< element of the same zone, or one of the constants above

  [[nodiscard]] std::span<Index32 const> of(Index e) const {
    return {neighbour.data() + first[e], std::size_t(first[e + 1] - first[e])};
  }
};

/// Two elements are neighbours when a side of one has the corner nodes of a side of the other: looked for around the
/// smallest node of each side, among elements_of_nodes().
ElementSides element_sides(HostInstance const& host, Mesh const& mesh, CsrGraph const& elements_of_nodes);
inline ElementSides element_sides(Mesh const& mesh) {
  return element_sides(HostInstance(), mesh, elements_of_nodes(mesh));
}

/// Sides with nothing behind them, in element order; normals point out of the mesh.
struct BoundaryFaces {
  CsrGraph nodes;                ///< corner nodes
  std::vector<Index32> element;  ///< the one they belong to
  std::vector<Index32> side;     ///< which of its sides
  std::vector<Index32> across;   ///< the face behind a connection, periodic ones too; -1: none
  /// The connection: 2 c where the face has nodes of Mesh::connections[c], 2 c + 1 where it has donor nodes of it; -1:
  /// none.
  std::vector<Index32> connection;
  /// For baffles and other surfaces inside the mesh that patches list, the face on the other side, with the same nodes;
  /// -1: none. Empty where the mesh has no such surfaces.
  std::vector<Index32> behind;
  [[nodiscard]] Index size() const { return nodes.size(); }
};

/// How the elements of a mesh hang together: elements of nodes, neighbours, boundary. The mesh must have passed
/// check_mesh(). Faces that walls list inside the mesh, where elements on both sides have the same nodes (createBaffles
/// of OpenFOAM, MARKER_INTERNAL of SU2, inner physical surfaces of Gmsh), are boundary: its elements are no neighbours
/// there.
struct UnstructuredTopology {
  CsrGraph elements_of_nodes;
  ElementSides sides;
  BoundaryFaces boundary;
  CsrGraph faces_of_nodes;  ///< boundary faces that have a node, ascending
  Index crowded_sides = 0;
};

UnstructuredTopology make_topology(HostInstance const& host, Mesh const& mesh);
inline UnstructuredTopology make_topology(Mesh const& mesh) { return make_topology(HostInstance(), mesh); }

/// The boundary face with exactly these corner nodes, in any order (a node may be named twice); -1 where there is none.
/// The boundary face with these nodes; of a surface inside the mesh either side, the other one is behind it.
Index32 find_boundary_face(UnstructuredTopology const& topology, std::span<Index32 const> nodes);

/// Which patch each boundary face belongs to.
struct BoundaryFacePatches {
  static constexpr int connection = -1;  ///< no patch, but all of its nodes are paired by one connection
  static constexpr int open = -2;        ///< neither

  std::vector<int> patch;             ///< (boundary faces) number in Mesh::patches, or one of the constants
  std::vector<Index> faces_of_patch;  ///< (patches) boundary faces each of them got
  std::vector<std::string> problems;  ///< what a morph would refuse: faces that no patch has, or two
  std::vector<std::string> notes;     ///< faces of patches inside the mesh, ...
};

/// A face belongs to the patch that lists it. Patches given as nodes get the faces all of whose corners they list and
/// that no patch of faces has; where several do, the one with fewest nodes, then the first in the file.
BoundaryFacePatches find_face_patches(Mesh const& mesh, UnstructuredTopology const& topology);

/// For each node the smallest number among the nodes that connections (periodic ones left out) declare to be the same
/// point; its own number where there is none.
std::vector<Index32> coincident_nodes(Mesh const& mesh);

/// Marks of nodes, (n_nodes): 1 for those that a periodic connection pairs.
std::vector<std::uint8_t> periodic_nodes(BoundaryMesh const& mesh);

/// For each of `points` the nearest of `donors` within `tolerance` (the first of equals), or -1. Both are node numbers;
/// `periodic`: moves the points onto the donors first. n log n.
std::vector<Index32> match_points(HostInstance const& host, Coordinates const& coordinates,
                                  std::span<Index32 const> points, std::span<Index32 const> donors, double tolerance,
                                  std::optional<Periodic> const& periodic = {});
inline std::vector<Index32> match_points(Coordinates const& coordinates, std::span<Index32 const> points,
                                         std::span<Index32 const> donors, double tolerance,
                                         std::optional<Periodic> const& periodic = {}) {
  return match_points(HostInstance(), coordinates, points, donors, tolerance, periodic);
}

/// Largest distance between nodes that a connection pairs.
double largest_mismatch(Mesh const& mesh, Connection const& connection);

}  // namespace gridmorph
