// Edges of a surface of facets: its boundary, and creases.
#pragma once

#include <gridmorph/boundary/patch_surface.hpp>

#include <vector>

namespace gridmorph {

/// A line of edges between two corners, or around.
struct FeatureChain {
  std::vector<int> vertices;  ///< the first one again at the end when closed
  [[nodiscard]] bool closed() const { return vertices.size() > 2 && vertices.front() == vertices.back(); }
};

struct FeatureEdge {
  int a = 0, b = 0;  ///< a < b
  bool boundary = false;
};

/// Edges with one facet (boundary), with more than two, or where the normals of two facets differ by more than the
/// angle. Ascending. Facets without area make no crease. Cost O(facets log facets).
std::vector<FeatureEdge> find_feature_edges(std::vector<Vec3> const& points, std::vector<GridFacet> const& facets,
                                            double crease_angle_deg);

/// Neighbours along the edges, per vertex.
std::vector<std::vector<int>> feature_neighbours(std::size_t n_points, std::vector<FeatureEdge> const& edges);

/// Whether exactly two edges meet in the vertex and turn by more than 45 degrees there.
bool turns_sharply(std::vector<Vec3> const& points, std::vector<std::vector<int>> const& neighbours, int vertex);

/// The chains of edges, every edge in one of them; chains end where other than two edges meet, and at the vertices in
/// `corner`.
std::vector<FeatureChain> feature_chains(std::vector<std::vector<int>> const& neighbours,
                                         std::vector<char> const& corner);

}  // namespace gridmorph
