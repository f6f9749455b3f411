// Distances along the edges of a surface. Internal to motion.
#pragma once

#include <gridmorph/boundary/patch_surface.hpp>

#include <vector>

namespace gridmorph {

/// Vertices that a periodic connection joins, and the rotation from directions at the first to those at the second.
struct VertexImage {
  int vertex = -1, image = -1;
  Mat3 rotation;
};

/// Both ways of every pair of vertices of the surface that a periodic connection of the mesh joins, each once.
std::vector<VertexImage> vertex_images(Boundary const& boundary, PatchSurface const& surface);

/// Of every vertex from the nearest of the sources, along grid lines and sides of faces; images are one place. Infinite where nothing
/// leads. Cost O(n log n).
std::vector<double> edge_distances(PatchSurface const& surface, std::vector<VertexImage> const& images,
                                   std::vector<int> const& sources);

}  // namespace gridmorph
