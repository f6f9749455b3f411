#include <gridmorph/boundary/coincident_nodes.hpp>
#include <gridmorph/boundary/link_nodes.hpp>
#include <gridmorph/boundary/links.hpp>
#include <gridmorph/core/disjoint_sets.hpp>

#include <utility>

namespace gridmorph {

namespace {

void join_blocks(Mesh const& mesh, bool periodic, DisjointSets<Index>& sets) {
  TopologyOptions any;
  any.matching_tolerance = mesh.size();
  Problems ignored;
  for (auto const& link : connect(mesh, any, ignored).all)
    if (link.periodic == periodic) for_each_pair(mesh, link, [&](Index a, Index b) { sets.join(a, b); });
}

}  // namespace

std::vector<Index> coincident_block_nodes(Mesh const& mesh) {
  DisjointSets<Index> sets(std::size_t(mesh.n_nodes()));
  join_blocks(mesh, false, sets);
  return sets.roots();
}

std::vector<Index> nodes_joined_across_periodic_sides(Mesh const& mesh, std::vector<Index> one) {
  DisjointSets<Index> sets(std::move(one));
  if (mesh.is_structured()) join_blocks(mesh, true, sets);
  for (Connection const& c : mesh.connections)
    for (std::size_t k = 0; c.periodic && k < c.nodes.size(); ++k) sets.join(c.nodes[k], c.donor_nodes[k]);
  return sets.roots();
}

}  // namespace gridmorph
