#include <gridmorph/unstructured/node_graph.hpp>

#include <algorithm>

namespace gridmorph {

namespace {

/// Calls visit(a, b) for every edge of every element, shared ones as often as they occur.
template <class Visit>
void for_each_edge(UnstructuredMesh const& mesh, Visit&& visit) {
  for (Index e = 0; e < mesh.n_elements(); ++e) {
    ElementType const type = mesh.elements.type[std::size_t(e)];
    if (type == ElementType::polyhedron) continue;
    auto const nodes = mesh.elements.corners(e);
    for (int k = 0; k < n_edges(type); ++k)
      visit(nodes[std::size_t(edge_corner(type, k, 0))], nodes[std::size_t(edge_corner(type, k, 1))]);
  }
  for (Index f = 0; f < mesh.polyhedra.faces.size(); ++f) {
    auto const face = mesh.polyhedra.faces[f];
    for (std::size_t k = 0; k < face.size(); ++k) visit(face[k], face[(k + 1) % face.size()]);
  }
}

}  // namespace

NodeGraph make_node_graph(UnstructuredMesh const& mesh) {
  NodeGraph graph;
  graph.representative = coincident_nodes(mesh);
  auto const& owner = graph.representative;
  std::size_t const n = std::size_t(mesh.n_nodes());
  // Every edge occurs once per element around it: count, place, then keep each neighbour once.
  std::vector<Index> at(n + 1, 0);
  for_each_edge(mesh, [&](Number a, Number b) {
    Number const p = owner[std::size_t(a)], q = owner[std::size_t(b)];
    if (p == q) return;
    ++at[std::size_t(p) + 1];
    ++at[std::size_t(q) + 1];
  });
  for (std::size_t k = 0; k < n; ++k) at[k + 1] += at[k];
  std::vector<Number> ends(std::size_t(at.back()));
  std::vector<Index> next(at.begin(), at.end() - 1);
  for_each_edge(mesh, [&](Number a, Number b) {
    Number const p = owner[std::size_t(a)], q = owner[std::size_t(b)];
    if (p == q) return;
    ends[std::size_t(next[std::size_t(p)]++)] = q;
    ends[std::size_t(next[std::size_t(q)]++)] = p;
  });
  graph.neighbours.first.reserve(n + 1);
  Index kept = 0;
  for (std::size_t k = 0; k < n; ++k) {
    auto const begin = ends.begin() + at[k], end = ends.begin() + at[k + 1];
    std::sort(begin, end);
    // In place: what is kept never overtakes what is read.
    for (auto it = begin; it != end; ++it)
      if (it == begin || *it != *(it - 1)) ends[std::size_t(kept++)] = *it;
    graph.neighbours.first.push_back(kept);
  }
  ends.resize(std::size_t(kept));
  ends.shrink_to_fit();
  graph.neighbours.item = std::move(ends);
  return graph;
}

}  // namespace gridmorph
