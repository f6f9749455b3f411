#include <gridmorph/plan/elements/element_grades.hpp>
#include <gridmorph/plan/elements/one_rings.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace gridmorph::detail {

std::vector<double> node_grades(Mesh const& mesh, UnstructuredTopology const& topology, NodeGraph const& graph) {
  std::vector<double> grade_of_element(std::size_t(mesh.n_elements()), 1);
  for (Index e = 0; e < mesh.n_elements(); ++e) {
    ElementType const type = mesh.elements.type[std::size_t(e)];
    if (type == ElementType::polyhedron) continue;
    auto const nodes = mesh.elements.corners(e);
    double shortest = std::numeric_limits<double>::infinity(), longest = 0;
    for (int k = 0; k < n_edges(type); ++k) {
      double const length = distance(mesh.coordinates[nodes[std::size_t(edge_corner(type, k, 0))]],
                                     mesh.coordinates[nodes[std::size_t(edge_corner(type, k, 1))]]);
      if (length > 0) shortest = std::min(shortest, length);
      longest = std::max(longest, length);
    }
    if (longest > 0) grade_of_element[std::size_t(e)] = shortest / longest;
  }
  std::vector<double> grade(std::size_t(mesh.n_nodes()), 0);
  std::vector<Index32> count(std::size_t(mesh.n_nodes()), 0);
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    std::size_t const o = std::size_t(graph.representative[std::size_t(n)]);
    for (Index32 const e : topology.elements_of_nodes[n]) {
      grade[o] += grade_of_element[std::size_t(e)];
      ++count[o];
    }
  }
  for (std::size_t n = 0; n < grade.size(); ++n) grade[n] = count[n] > 0 ? grade[n] / count[n] : 1;
  return grade;
}

std::vector<double> wall_curvature(Mesh const& mesh, UnstructuredTopology const& topology, NodeGraph const& graph,
                                   std::vector<Index32> const& faces) {
  std::vector<Vec3> const normal = wall_normals(mesh, topology, graph, faces);
  std::vector<double> curvature(normal.size(), 0);
  for (Index32 const f : faces) {
    auto const face = topology.boundary.nodes[f];
    for (std::size_t k = 0; k < face.size(); ++k) {
      Index32 const a = graph.representative[std::size_t(face[k])],
                    b = graph.representative[std::size_t(face[(k + 1) % face.size()])];
      Vec3 const m = normal[std::size_t(a)], n = normal[std::size_t(b)];
      double const edge = distance(mesh.coordinates[a], mesh.coordinates[b]);
      if (!(edge > 0) || !(norm(m) > 0) || !(norm(n) > 0)) continue;
      double const angle = std::atan2(norm(cross(m, n)), dot(m, n));
      for (Index32 const at : {a, b}) curvature[std::size_t(at)] = std::max(curvature[std::size_t(at)], angle / edge);
    }
  }
  return curvature;
}

}  // namespace gridmorph::detail
