// The way every vertex of a surface goes when its faces are offset by one unit of length, and the normals of the smooth
// parts around it.
#pragma once

#include <gridmorph/boundary/patch_surface.hpp>
#include <gridmorph/motion/detail/edge_distances.hpp>
#include <gridmorph/motion/detail/slip_surfaces.hpp>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace gridmorph {

/// A vertex has one normal per smooth part of the surface around it, into the mesh: the mean of the normals of its
/// faces' corners, weighted by their angles (Thuermer and Wuethrich 1998), so that it does not depend on how flat faces
/// are cut. Corners whose normals are less than the crease angle apart, or are joined by others between, are one part.
/// Faces beyond periodic connections count, turned back. Nodes that are no corners of faces (middles of the sides of
/// curved elements) have the means of those of the corners around.
class VertexNormals {
 public:
  /// The normals of a surface. Cost O(faces), and O(log) for each node that is no corner.
  VertexNormals(Boundary const& boundary, PatchSurface const& surface, std::vector<VertexImage> const& images,
                double crease_angle_deg);

  /// The unit normals of the parts of a vertex; none where all faces are without area or those of a part cancel.
  [[nodiscard]] std::span<Vec3 const> parts(int v) const {
    return {parts_.data() + first_[v], parts_.data() + first_[v + 1]};
  }

 private:
  std::vector<std::size_t> first_{0};
  std::vector<Vec3> parts_;
};

/// The shortest d across `kept` (unit vectors) with d . n = 1 for the unit normals n, by least squares where there are
/// more than can be, cut to a length of 2, which edges sharper than 60 degrees would exceed. Zero where all normals lie
/// along `kept` or cancel.
///
/// With m = n less its part along `kept`, M = sum m m^T and its principal axes a_k with moments l_k: d = sum (a_k . sum
/// m / l_k) a_k.
Vec3 offset_direction(std::span<Vec3 const> normals, std::span<Vec3 const> kept);

/// Directions of all vertices: offset_direction() of their VertexNormals.
///
/// Vertices of slip surfaces move within these, by as much as keeps the offset of the faces (`directions`); what that
/// changes fades over the rest of the surface, to zero at the vertex farthest from the slip surface along the edges. It
/// is a motion within the faces.
class SurfaceOffset {
 public:
  /// `slip` must outlive this. Throws MotionError, beginning with `name`, where a vertex has no normal. Cost O(vertices
  /// log vertices).
  SurfaceOffset(Boundary const& boundary, PatchSurface const& surface, SlipSurfaces const& slip,
                double crease_angle_deg, std::string const& name);

  /// Displacement of vertex v for a height. Exactly zero for zero, linear in it but for the curvature of slip surfaces.
  [[nodiscard]] Vec3 displacement(int v, double height) const;

  [[nodiscard]] std::size_t at_creases() const { return at_creases_; }
  /// Vertices whose way is cut, so that their faces are offset by less than the height.
  [[nodiscard]] std::size_t limited() const { return limited_; }

 private:
  SurfaceOffset(Boundary const& boundary, PatchSurface const& surface, std::vector<VertexImage> const& images,
                SlipSurfaces const& slip, double crease_angle_deg, std::string const& name);
  void find_rims(Boundary const& boundary, PatchSurface const& surface, SlipSurfaces const& slip);
  void fade(PatchSurface const& surface, std::vector<VertexImage> const& images);

  struct Slide {
    SlipSurface const* surface;
    double share;  ///< of what it changes; 1 on the surface itself
    Vec3 direction;
  };
  std::vector<Vec3> points_;
  VertexNormals normals_;
  std::vector<Vec3> direction_;
  std::vector<SlipSurface const*> touched_;
  std::vector<std::vector<int>> rims_;      ///< per vertex numbers in touched_; empty inside
  std::vector<std::vector<Slide>> slides_;  ///< per vertex, those with a share
  std::size_t at_creases_ = 0, limited_ = 0;
};

}  // namespace gridmorph
