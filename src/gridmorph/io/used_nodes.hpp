// Which nodes of a file its mesh has. Internal to io.
#pragma once

#include <gridmorph/core/csr_graph.hpp>

#include <vector>

namespace gridmorph::io {

/// Number in the mesh of each of n_nodes nodes of a file, in its order; -1 for those that no element does (centres of
/// circles, ...). nodes: of all elements of the file; is_of_mesh(e): whether the mesh has element e. n_used: how many.
template <class IsOfMesh>
std::vector<Index32> used_nodes(CsrGraph const& nodes, std::size_t n_nodes, IsOfMesh const& is_of_mesh, Index& n_used) {
  std::vector<Index32> number(n_nodes, -1);
  for (Index e = 0; e < nodes.size(); ++e)
    if (is_of_mesh(e))
      for (Index32 const n : nodes[e]) number[n] = 0;
  n_used = 0;
  for (Index32& n : number)
    if (n == 0) n = Index32(n_used++);
  return number;
}

}  // namespace gridmorph::io
