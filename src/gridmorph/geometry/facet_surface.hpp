// Smooth surfaces through the nodes of facets: structured patches of a mesh, or triangles and quadrilaterals from a
// file.
#pragma once

#include <gridmorph/kernels/facet_surface.hpp>
#include <gridmorph/kernels/vec3.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace gridmorph {

/// Triangles and quadrilaterals as they stand in a file or a mesh. Points may be there several times, facets in any
/// order and orientation.
struct FacetList {
  std::vector<Vec3> points;
  std::vector<std::array<std::int32_t, 4>> facets;  ///< numbers of points around the facet; [3] = -1: a triangle

  /// Appends the facets of another list.
  void add(FacetList const& other);
};

struct FacetOptions {
  /// Facets that meet at a larger angle meet at a crease: the surface is not smooth across it.
  double crease_angle_rad = 0.8;
  /// Points closer than this times the size of the surface, and closer than a tenth of the edges that leave them, are
  /// one.
  double weld = 1e-7;
};

/// A surface through all its points, made of curved facets (kernels/facet_patch.hpp).
///
/// Tangents at the ends of edges come from the grid lines: where a line of edges goes on (four facets about a point, or
/// along a rim or crease), the derivative by chord length of the polynomial through up to five of its points, one-sided
/// where the line ends. Elsewhere (triangles, poles, points with three or five facets) the normal is that of a height
/// function fitted to the points around, cubic where there are enough of them (Cazals and Pouget 2005), and edges leave
/// along their chord's projection on the tangent plane (PN triangles). Both give tangent planes to O(h^3) and better,
/// so the surface is off a smooth one by O(h^4) where facets are quadrilaterals, by O(h^3) on triangles.
///
/// Numbering, order and orientation of the input change nothing: points and facets are brought into an order of their
/// own first, by position. Explicit: no system of equations beyond the nine unknowns of a fit.
struct FacetSurface {
  std::vector<Vec3> points, normals, bends;
  std::vector<kernels::Facet> facets;
  std::vector<kernels::FacetBox> boxes;

  /// Points that coincide become one; facets collapsed to a line or named twice go. Throws MotionError, naming the
  /// facet or point, when a number is out of range or a point not finite, and when no facet is left. Cost O(n log n).
  static FacetSurface from_facets(FacetList const& list, FacetOptions const& options = {});

  [[nodiscard]] bool empty() const { return facets.empty(); }
  /// Diagonal of the box around the points.
  [[nodiscard]] double size() const;

  /// The surface as kernels see it. Borrows the tables: valid on the host while this surface lives unchanged.
  [[nodiscard]] kernels::FacetSurfaceView view() const {
    return {{points.data(), facets.data(), boxes.data()}, normals.data(), bends.data()};
  }
  /// The point of the surface nearest to p, for host code. Cost O(log n) near the surface.
  [[nodiscard]] kernels::FacetFoot closest_point(Vec3 const& p) const { return view().closest_point(p); }
};

}  // namespace gridmorph
