#include <gridmorph/mesh/detail/number_buckets.hpp>
#include <gridmorph/unstructured/node_graph.hpp>

#include <algorithm>
#include <memory>
#include <numeric>

namespace gridmorph {

namespace {

/// Calls visit(a, b) for every edge of an element, or of a face of a polyhedron: those come after all elements.
template <class Visit>
void for_each_edge(UnstructuredMesh const& mesh, Index item, Visit&& visit) {
  if (item >= mesh.n_elements()) {
    auto const face = mesh.polyhedra.faces[item - mesh.n_elements()];
    for (std::size_t k = 0; k < face.size(); ++k) visit(face[k], face[(k + 1) % face.size()]);
    return;
  }
  ElementType const type = mesh.elements.type[std::size_t(item)];
  if (type == ElementType::polyhedron) return;
  auto const nodes = mesh.elements.corners(item);
  for (int k = 0; k < n_edges(type); ++k)
    visit(nodes[std::size_t(edge_corner(type, k, 0))], nodes[std::size_t(edge_corner(type, k, 1))]);
}

}  // namespace

NodeGraph make_node_graph(UnstructuredMesh const& mesh) {
  NodeGraph graph;
  graph.representative = coincident_nodes(mesh);
  auto const& owner = graph.representative;
  // Every edge occurs once per element around it; what is kept of a node's neighbours stays where all of them were.
  detail::NumberBuckets<Number> const buckets("gridmorph::node_graph", mesh.n_elements() + mesh.polyhedra.faces.size(),
                                              mesh.n_nodes(), [&](Index item, auto const& put) {
                                                for_each_edge(mesh, item, [&](Number a, Number b) {
                                                  Number const p = owner[std::size_t(a)], q = owner[std::size_t(b)];
                                                  if (p == q) return;
                                                  put(p, q);
                                                  put(q, p);
                                                });
                                              });
  std::size_t const n = std::size_t(mesh.n_nodes());
  std::vector<Index> from(n);
  auto& first = graph.neighbours.first;
  first.assign(n + 1, 0);
  auto const kept = std::make_unique_for_overwrite<Number[]>(std::size_t(buckets.size()));
  buckets.for_each_key([&](Number node, Index at, std::span<Number> ends) {
    std::sort(ends.begin(), ends.end());
    auto const end = std::unique_copy(ends.begin(), ends.end(), kept.get() + at);
    from[std::size_t(node)] = at;
    first[std::size_t(node) + 1] = end - (kept.get() + at);
  });
  std::partial_sum(first.begin(), first.end(), first.begin());
  graph.neighbours.item.reserve(std::size_t(first.back()));
  for (std::size_t k = 0; k < n; ++k) {
    Number const* const begin = kept.get() + from[k];
    graph.neighbours.item.insert(graph.neighbours.item.end(), begin, begin + (first[k + 1] - first[k]));
  }
  return graph;
}

}  // namespace gridmorph
