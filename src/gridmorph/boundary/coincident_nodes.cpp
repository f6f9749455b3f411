#include <gridmorph/boundary/coincident_nodes.hpp>
#include <gridmorph/boundary/link_nodes.hpp>
#include <gridmorph/boundary/links.hpp>

#include <algorithm>
#include <numeric>

namespace gridmorph {

std::vector<Index> coincident_nodes(Mesh const& mesh) {
  std::vector<Index> root(std::size_t(mesh.n_nodes()));
  std::iota(root.begin(), root.end(), Index(0));
  auto const find = [&](Index n) {
    while (root[std::size_t(n)] != n) n = root[std::size_t(n)] = root[std::size_t(root[std::size_t(n)])];
    return n;
  };
  TopologyOptions any;
  any.matching_tolerance = mesh.size();
  Problems ignored;
  for (auto const& link : connect(mesh, any, ignored).all)
    if (!link.periodic)
      for_each_pair(mesh, link, [&](Index a, Index b) {
        Index const low = std::min(find(a), find(b)), high = std::max(find(a), find(b));
        root[std::size_t(high)] = low;
      });
  for (Index n = 0; n < mesh.n_nodes(); ++n) root[std::size_t(n)] = find(n);
  return root;
}

}  // namespace gridmorph
