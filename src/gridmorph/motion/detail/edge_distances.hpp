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

/// The vertices and their images, both ways of every pair of the surface that a periodic connection of the mesh joins,
/// each once.
std::vector<VertexImage> vertex_images(Boundary const& boundary, PatchSurface const& surface);

struct EdgeDistances {
  std::vector<double> distance;  ///< infinite where nothing leads
  std::vector<int> source;       ///< place of the nearest one in the list of sources, -1: none
};

/// The distance of every vertex from the nearest of the sources, along grid lines and sides of faces; images are one
/// place. Cost O(n log n).
EdgeDistances edge_distances_and_sources(PatchSurface const& surface, std::vector<VertexImage> const& images,
                                         std::vector<int> const& sources);
/// The distances of edge_distances_and_sources() alone.
inline std::vector<double> edge_distances(PatchSurface const& surface, std::vector<VertexImage> const& images,
                                          std::vector<int> const& sources) {
  return edge_distances_and_sources(surface, images, sources).distance;
}

}  // namespace gridmorph
