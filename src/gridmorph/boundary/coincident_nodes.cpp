#include <gridmorph/boundary/coincident_nodes.hpp>
#include <gridmorph/boundary/link_nodes.hpp>
#include <gridmorph/boundary/links.hpp>
#include <gridmorph/core/disjoint_sets.hpp>

namespace gridmorph {

std::vector<Index> coincident_block_nodes(Mesh const& mesh) {
  DisjointSets<Index> sets(std::size_t(mesh.n_nodes()));
  TopologyOptions any;
  any.matching_tolerance = mesh.size();
  Problems ignored;
  for (auto const& link : connect(mesh, any, ignored).all)
    if (!link.periodic) for_each_pair(mesh, link, [&](Index a, Index b) { sets.join(a, b); });
  return sets.roots();
}

}  // namespace gridmorph
