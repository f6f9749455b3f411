// What a mesh is bounded by, as motion rules see it: the same for blocks and for elements.
#pragma once

#include <gridmorph/boundary/second_plane.hpp>
#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/geometry/facet_surface.hpp>
#include <gridmorph/mesh/coordinate_resolution.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gridmorph {

/// Corners of a facet, four or (the last is -1) three, in order around it; two in the boundary of a 2-D mesh of
/// elements.
using GridFacet = std::array<int, 4>;

/// The nodes and faces of one patch.
struct BoundarySurface {
  std::vector<Index> nodes;  ///< of the mesh, each once: i fastest on a grid, otherwise ascending
  std::optional<std::array<int, 2>>
      grid;  ///< patches of blocks: nodes along their two directions, the first one fastest; not of regions with cells
  /// Faces of elements on `nodes`, their normals pointing into the mesh (of lines: Boundary::across() x line); fans of
  /// triangles where they have more than four corners.
  std::vector<GridFacet> faces;
  std::vector<int> in_file_order;  ///< of elements: places in `nodes` as the file counts its nodes
};

/// The patches of a mesh with nodes and facets, and its periodic connections. A value of its own: it shares the
/// coordinates of the mesh and has no use for its elements.
class Boundary {
 public:
  /// The boundary of a mesh of blocks; `size`: Mesh::size(), where it is known. Cost O(nodes of patches).
  explicit Boundary(Mesh const& mesh, std::optional<double> size = {});
  /// The boundary of a mesh of elements; `size` as above. Nodes of a patch are those of the boundary faces it got, or
  /// all it lists where it got none. `regions`: regions_of_elements(), which become patches behind those of the mesh.
  /// Cost O(boundary faces, log).
  Boundary(Mesh const& mesh, UnstructuredTopology const& topology, BoundaryFacePatches const& face_patches,
           std::optional<double> size = {}, std::span<Patch const> regions = {});

  /// Positions, zones and patches by their numbers in the mesh, patches without their faces and lists of nodes, which
  /// surface() has.
  [[nodiscard]] Coordinates const& coordinates() const { return mesh_.coordinates; }
  [[nodiscard]] std::vector<Zone> const& zones() const { return mesh_.zones; }
  [[nodiscard]] std::vector<Patch> const& patches() const { return mesh_.patches; }
  [[nodiscard]] int zone_of(Index node) const { return mesh_.zone_of(node); }
  /// connections_of() the mesh.
  [[nodiscard]] std::vector<AnyConnection> connections() const { return connections_of(mesh_); }
  /// The patches and connections as rules name them.
  [[nodiscard]] NamedBoundary names() const { return NamedBoundary(mesh_); }
  /// What a selector names, and the numbers of the patches that several name; see the functions of these names in
  /// boundary/selectors.hpp.
  [[nodiscard]] Selection select(std::string const& selector) const { return gridmorph::select(mesh_, selector); }
  [[nodiscard]] std::vector<int> select_patches(std::vector<std::string> const& selectors) const {
    return gridmorph::select_patches(mesh_, selectors);
  }
  /// The names of a patch and of a node in messages.
  [[nodiscard]] std::string describe_patch(int patch) const { return names().describe_patch(patch); }
  [[nodiscard]] std::string describe_node(Index node) const { return gridmorph::describe_node(mesh_, node); }
  /// The dimension of the cells in the file (BoundaryMesh::dimension).
  [[nodiscard]] int dimension() const { return mesh_.dimension; }
  /// The size of the mesh (Mesh::size()).
  [[nodiscard]] double size() const { return size_; }
  /// The precision of the coordinates of the mesh: that of its coarsest zone.
  [[nodiscard]] CoordinatePrecision const& precision() const { return precision_; }
  [[nodiscard]] BoundarySurface const& surface(int patch) const { return surfaces_[patch]; }
  /// Whether the patches are lines, the sides of a plane mesh.
  [[nodiscard]] bool is_plane() const { return plane_; }
  /// The second plane of blocks of a 2-D mesh.
  [[nodiscard]] SecondPlane second_plane() const { return SecondPlane(mesh_); }
  /// The vector from the plane of a plane mesh to the second places of its nodes.
  [[nodiscard]] Vec3 const& across() const { return across_; }

  /// Positions of the nodes of patches, one after another. Lines come twice, the second time across the plane of the
  /// mesh: as the edges of strips they have planes and profiles.
  [[nodiscard]] std::vector<Vec3> points(std::span<int const> patches) const;
  [[nodiscard]] std::vector<Vec3> points(int patch) const { return points({&patch, 1}); }
  /// The same of nodes.
  [[nodiscard]] std::vector<Vec3> points_of(std::vector<Index> const& nodes) const;
  /// The facets of patches, in no particular orientation; none of lines.
  [[nodiscard]] FacetList facets(std::span<int const> patches) const;
  /// Whether two patches have nodes of one zone in common.
  [[nodiscard]] bool share_nodes(int patch, int other) const;

  /// (nodes of the mesh) 1 where a periodic connection of elements pairs them.
  [[nodiscard]] std::vector<std::uint8_t> periodic_nodes() const { return gridmorph::periodic_nodes(mesh_); }
  /// Pairs of nodes (own, donor) of a connection, by its number in connections_of().
  [[nodiscard]] std::vector<std::array<Index, 2>> pairs(int connection) const;
  /// Whether a connection has nodes of a patch, on either side.
  [[nodiscard]] bool touches(int connection, int patch) const;
  /// The transform that takes own nodes of a periodic connection onto the donor's, fitted to them: files declare angles
  /// in single precision.
  [[nodiscard]] RigidTransform transform(int connection) const;
  /// The transforms of all periodic connections, or of those that touch one of the patches; in their order.
  [[nodiscard]] std::vector<RigidTransform> periodic_transforms() const;
  [[nodiscard]] std::vector<RigidTransform> periodic_transforms(std::span<int const> patches) const;

 private:
  BoundaryMesh mesh_;  ///< its patches have neither faces nor nodes
  double size_ = 0;
  CoordinatePrecision precision_;
  bool plane_ = false;
  Vec3 across_;  ///< of a plane mesh
  std::vector<BoundarySurface> surfaces_;
};

}  // namespace gridmorph
