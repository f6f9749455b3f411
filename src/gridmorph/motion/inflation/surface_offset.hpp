// The way every vertex of a surface goes when its faces are offset by one unit of length.
#pragma once

#include <gridmorph/boundary/patch_surface.hpp>
#include <gridmorph/motion/detail/slip_surfaces.hpp>
#include <gridmorph/motion/inflation/vertex_normals.hpp>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace gridmorph {

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
