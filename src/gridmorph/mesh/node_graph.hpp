// Which nodes an edge of an element joins, with the nodes that coincide in several zones taken as one.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>

#include <span>
#include <vector>

namespace gridmorph {

struct NodeGraph {
  /// Smallest number among the nodes at the same point (nodes_at_one_place()): the one that carries the displacement of
  /// all of them.
  std::vector<Index32> representative;
  /// Representatives at the other ends of the edges of elements, ascending; empty for all other nodes.
  CsrGraph neighbours;

  [[nodiscard]] Index size() const { return Index(representative.size()); }
  [[nodiscard]] bool carries(Index32 n) const { return representative[n] == n; }
};

/// Edges of polyhedra are those of their faces. The lists are those of UnstructuredTopology. Cost O(corners of all
/// elements). `groups`: as for nodes_at_one_place().
NodeGraph make_node_graph(HostInstance const& host, Mesh const& mesh, CsrGraph const& elements_of_nodes,
                          std::span<int const> groups = {});
inline NodeGraph make_node_graph(Mesh const& mesh, CsrGraph const& elements_of_nodes,
                                 std::span<int const> groups = {}) {
  return make_node_graph(HostInstance(), mesh, elements_of_nodes, groups);
}

}  // namespace gridmorph
