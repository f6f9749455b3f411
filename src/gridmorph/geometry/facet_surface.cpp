#include <gridmorph/geometry/facet_surface.hpp>

#include <gridmorph/geometry/facet_boxes.hpp>
#include <gridmorph/geometry/facet_tangents.hpp>
#include <gridmorph/geometry/facet_topology.hpp>

#include <algorithm>

namespace gridmorph {

void FacetList::add(FacetList const& other) {
  auto const shift = std::int32_t(points.size());
  points.insert(points.end(), other.points.begin(), other.points.end());
  for (auto facet : other.facets) {
    for (std::int32_t& c : facet)
      if (c >= 0) c += shift;
    facets.push_back(facet);
  }
}

FacetSurface FacetSurface::from_facets(FacetList const& list, FacetOptions const& options) {
  FacetTopology topology(list, options);
  FacetTangents tangents(topology);

  std::vector<kernels::Facet> facets(topology.facets.size());
  for (int f = 0; f < int(facets.size()); ++f)
    for (int q = 0; q < topology.n_corners(f); ++q) {
      int const e = topology.edges_of_facet[f][q];
      FacetEdge const& edge = topology.edges[e];
      int const side = edge.facet[0] == f ? 1 : 0;
      facets[f].corner[q] = topology.facets[f][q];
      facets[f].normal[q] = tangents.normal_of_corner[f][q];
      facets[f].bend[q] = 2 * e + (edge.point[0] == topology.facets[f][q] ? 0 : 1);
      if (edge.facet[1] >= 0) facets[f].neighbour[q] = 4 * edge.facet[side] + edge.place[side];
      if (edge.crease) facets[f].creases |= 1 << q;
    }

  FacetSurface surface;
  FacetBoxes tree(topology.points, topology.facets);
  surface.boxes = std::move(tree.boxes);
  std::vector<std::int32_t> place(facets.size());
  for (std::size_t n = 0; n < facets.size(); ++n) place[tree.order[n]] = std::int32_t(n);
  for (int const f : tree.order) {
    kernels::Facet facet = facets[f];
    for (std::int32_t& neighbour : facet.neighbour)
      if (neighbour >= 0) neighbour = 4 * place[neighbour / 4] + neighbour % 4;
    surface.facets.push_back(facet);
  }
  surface.points = std::move(topology.points);
  surface.normals = std::move(tangents.normals);
  surface.bends = std::move(tangents.bends);
  return surface;
}

double FacetSurface::size() const { return empty() ? 0 : distance(boxes.front().low, boxes.front().high); }

}  // namespace gridmorph
