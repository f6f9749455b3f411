// Normals of the smooth parts of a surface around each of its vertices.
#pragma once

#include <gridmorph/boundary/patch_surface.hpp>
#include <gridmorph/motion/detail/edge_distances.hpp>

#include <cstddef>
#include <span>
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
    return {parts_.data() + first_[std::size_t(v)], parts_.data() + first_[std::size_t(v) + 1]};
  }

 private:
  std::vector<std::size_t> first_{0};
  std::vector<Vec3> parts_;
};

}  // namespace gridmorph
