// From the elements of a structural model to any position: the closest element and its shape functions.
#pragma once

#include <gridmorph/mapping/stencil.hpp>
#include <gridmorph/mapping/structural_model.hpp>

#include <memory>
#include <span>
#include <vector>

namespace gridmorph {

/// A position q is projected to the closest point p of the elements (triangles; quadrilaterals as bilinear surfaces).
/// Its displacement is the shape-function interpolation at p, and the lever q - p, the offset between the two skins, is
/// carried along, turned by the rotation of the elements if one is given (see nodal_rotations). Linear fields come out
/// to round-off on flat elements; on smooth fields and curved surfaces the error falls with the square of the element
/// size.
///
/// Where p lies on a free edge (one that a single element has) and q is beyond it, the part of q - p in the plane of
/// the element is extrapolated: Extrapolation::linear by the gradient of the element, no farther than one element size;
/// Extrapolation::nearest not at all (that part belongs to the lever then).
///
/// Cost: O(n log n) to build, O(log n) per position. Stencils may be asked for from several threads.
class FacetMap {
 public:
  /// Throws ConfigError that names the first elements without an area. `coincidence`: closer to a node than this is the
  /// node.
  FacetMap(StructuralModel const& model, Extrapolation extrapolation, double coincidence);
  ~FacetMap();
  FacetMap(FacetMap&&) noexcept;
  FacetMap& operator=(FacetMap&&) noexcept;

  [[nodiscard]] Stencil stencil(Vec3 const& position) const { return stencil(position, position); }
  /// The stencil by the element that is closest to `anchor`: where elements meet at an angle the field jumps between
  /// their sides by the offset, not within one.
  [[nodiscard]] Stencil stencil(Vec3 const& position, Vec3 const& anchor) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Rotation vector (angle times axis, below pi) of every node under a displacement of the nodes: the area-weighted mean
/// over its elements of the rotation that takes an element's tangents and normal to their new directions (polar
/// decomposition). Rigid motions come out exactly, zero displacement gives exactly zero. Cost O(elements).
std::vector<Vec3> nodal_rotations(StructuralModel const& model, std::span<Vec3 const> displacement);

}  // namespace gridmorph
