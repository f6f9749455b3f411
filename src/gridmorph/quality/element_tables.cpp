#include <gridmorph/quality/element_tables.hpp>

namespace gridmorph::detail {

CsrGraph neighbour_lists(Mesh const& mesh, UnstructuredTopology const& topology) {
  CsrGraph out;
  Index const n = mesh.n_elements();
  auto const& across = topology.boundary.across;
  std::size_t face = 0;  // boundary faces are in the order of elements and sides
  out.first.reserve(std::size_t(n) + 1);
  out.item.reserve(topology.sides.neighbour.size());
  for (Index e = 0; e < n; ++e) {
    for (Index32 const other : topology.sides.of(e)) {
      if (other >= 0) out.item.push_back(other);
      if (other != ElementSides::boundary) continue;
      if (across[face] >= 0) out.item.push_back(across[face]);
      ++face;
    }
    out.first.push_back(Index(out.item.size()));
  }
  return out;
}

}  // namespace gridmorph::detail
