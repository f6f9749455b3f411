#include <gridmorph/quality/unstructured_quality.hpp>
#include <gridmorph/unstructured/detail/fans.hpp>

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

namespace gridmorph::detail {

namespace {

/// The faces without those that have the nodes of one before: the other side of a wall between zones, whose normal is the opposite.
std::vector<Number> one_sided(UnstructuredTopology const& topology, NodeGraph const& graph,
                              std::vector<Number> const& faces) {
  auto const owner = [&](Number n) { return graph.representative[std::size_t(n)]; };
  bool const joined = std::any_of(faces.begin(), faces.end(), [&](Number f) {
    auto const face = topology.boundary.nodes[f];
    return std::any_of(face.begin(), face.end(), [&](Number n) { return owner(n) != n; });
  });
  if (!joined) return faces;
  std::set<std::vector<Number>> seen;
  std::vector<Number> out;
  for (Number const f : faces) {
    std::vector<Number> owners;
    for (Number const n : topology.boundary.nodes[f]) owners.push_back(owner(n));
    std::sort(owners.begin(), owners.end());
    if (seen.insert(std::move(owners)).second) out.push_back(f);
  }
  return out;
}

/// Calls visit(node, a, b) for every corner of every face.
template <class Visit>
void for_each_corner(UnstructuredMesh const& mesh, UnstructuredTopology const& topology, NodeGraph const& graph,
                     std::vector<Number> const& faces, Visit&& visit) {
  auto const owner = [&](Number n) { return graph.representative[std::size_t(n)]; };
  for (Number const f : faces) {
    auto const face = topology.boundary.nodes[f];
    std::size_t const n = face.size();
    if (mesh.dimension == 2) {
      for (Number const end : face) visit(owner(end), owner(face[0]), owner(face[1]));
    } else {
      for (std::size_t k = 0; k < n; ++k) visit(owner(face[k]), owner(face[(k + 1) % n]), owner(face[(k + n - 1) % n]));
    }
  }
}

}  // namespace

NumberLists wall_fans(UnstructuredMesh const& mesh, UnstructuredTopology const& topology, NodeGraph const& graph,
                      std::vector<Number> const& all_faces, std::vector<Number> const& roots) {
  std::vector<Number> const faces = one_sided(topology, graph, all_faces);
  std::vector<Number> place(std::size_t(mesh.n_nodes()), -1);
  for (std::size_t r = 0; r < roots.size(); ++r) place[std::size_t(roots[r])] = Number(r);
  NumberLists fans;
  fans.first.assign(roots.size() + 1, 0);
  for_each_corner(mesh, topology, graph, faces, [&](Number n, Number, Number) {
    if (Number const r = place[std::size_t(n)]; r >= 0) fans.first[std::size_t(r) + 1] += 2;
  });
  for (std::size_t r = 0; r < roots.size(); ++r) fans.first[r + 1] += fans.first[r];
  fans.item.resize(std::size_t(fans.first.back()));
  std::vector<Index> next(fans.first.begin(), fans.first.end() - 1);
  for_each_corner(mesh, topology, graph, faces, [&](Number n, Number a, Number b) {
    if (Number const r = place[std::size_t(n)]; r >= 0) {
      fans.item[std::size_t(next[std::size_t(r)]++)] = a;
      fans.item[std::size_t(next[std::size_t(r)]++)] = b;
    }
  });
  return fans;
}

std::vector<Vec3> wall_normals(UnstructuredMesh const& mesh, UnstructuredTopology const& topology,
                               NodeGraph const& graph, std::vector<Number> const& all_faces) {
  std::vector<Number> const faces = one_sided(topology, graph, all_faces);
  std::vector<Vec3> normal(std::size_t(mesh.n_nodes()));
  Vec3 const across = plane_normal(mesh);
  for_each_corner(mesh, topology, graph, faces, [&](Number n, Number a, Number b) {
    Vec3 const x = mesh.coordinates[n], p = mesh.coordinates[a], q = mesh.coordinates[b];
    normal[std::size_t(n)] += mesh.dimension == 2 ? cross(q - p, across) : cross(p - x, q - x);
  });
  return normal;
}

}  // namespace gridmorph::detail
