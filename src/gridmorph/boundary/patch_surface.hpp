// The patches of a rule as one surface: nodes that coincide are one vertex, so that they move as one.
#pragma once

#include <gridmorph/boundary/boundary.hpp>
#include <gridmorph/geometry/point_numbers.hpp>

#include <array>
#include <optional>
#include <vector>

namespace gridmorph {

/// Nodes of one patch as vertices of the surface.
struct PatchGrid {
  int patch = -1;
  std::array<int, 2> extent{0, 0};  ///< along its two directions, the first one fastest
  std::vector<int> vertex;          ///< (extent[0] * extent[1])
  bool inward = false;              ///< direction 0 x direction 1 points out of the mesh, not into it
  /// The BoundarySurface::faces of patches that are no grids (extent[1] is 1), and the places of `vertex` in the order
  /// of the file.
  std::vector<GridFacet> faces;
  std::vector<int> listed;
  std::vector<Index> nodes;  ///< of the mesh, as `vertex`

  [[nodiscard]] int at(int a, int b) const { return vertex[std::size_t(a) + std::size_t(extent[0]) * b]; }
};

struct PatchSurface {
  std::vector<Vec3> points;
  std::vector<PatchGrid> grids;  ///< per patch, as given
  double size = 0;               ///< diagonal of the bounding box
  double tolerance = 0;          ///< nodes closer than this are one vertex
  bool gridded = true;           ///< patches are grids; otherwise they have faces
  bool lines = false;            ///< of two corners, in the plane of a 2-D mesh
  PointNumbers numbers{0};

  /// The surface of some patches. Cost O(nodes).
  PatchSurface(Boundary const& boundary, std::vector<int> const& patches);

  /// The quadrilaterals; those with two corners in one vertex are triangles, those with fewer are left out. All are
  /// right-handed about normals that point into the mesh.
  [[nodiscard]] std::vector<GridFacet> facets() const;
  /// This surface with faces of elements put together into grids (find_face_grids()), several of a patch where it takes
  /// them; nothing where faces are left over. Cost O(faces, log).
  [[nodiscard]] std::optional<PatchSurface> in_grids(Boundary const& boundary) const;
  /// Vertices next to one another along grid lines, or along the sides of faces; ascending, none twice.
  [[nodiscard]] std::vector<std::vector<int>> neighbours() const;
};

/// Normal of a facet with three or four corners, right-handed about their order and as long as twice its area.
Vec3 facet_normal(std::vector<Vec3> const& points, GridFacet const& f);
double box_diagonal(std::vector<Vec3> const& points);
double largest_component(std::vector<Vec3> const& points);

}  // namespace gridmorph
