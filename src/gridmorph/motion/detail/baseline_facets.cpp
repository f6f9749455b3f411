#include <gridmorph/motion/detail/facet_groups.hpp>

#include <gridmorph/core/disjoint_sets.hpp>
#include <gridmorph/geometry/facet_topology.hpp>

#include <algorithm>
#include <map>
#include <utility>

namespace gridmorph {

std::vector<std::vector<int>> smoothly_joined(Boundary const& boundary, std::vector<int> const& patches,
                                              FacetOptions const& options) {
  FacetList const list = boundary.facets(patches);
  std::vector<int> patch_of;  // per facet of the list, as a place in `patches`
  for (std::size_t m = 0; m < patches.size(); ++m)
    patch_of.resize(patch_of.size() + boundary.facets({&patches[m], 1}).facets.size(), int(m));

  std::map<std::pair<int, int>, int> balance;  // smooth edges less creases between two patches
  if (!list.facets.empty()) {
    FacetTopology const topology(list, options);
    for (FacetEdge const& edge : topology.edges) {
      if (edge.facet[1] < 0) continue;
      int const a = patch_of[topology.source[edge.facet[0]]], b = patch_of[topology.source[edge.facet[1]]];
      if (a != b) balance[{std::min(a, b), std::max(a, b)}] += edge.crease ? -1 : 1;
    }
  }
  DisjointSets<int> groups(patches.size());
  for (auto const& [pair, smooth] : balance)
    if (smooth > 0) groups.join(pair.first, pair.second);
  std::map<int, std::vector<int>> members;
  for (std::size_t m = 0; m < patches.size(); ++m) members[groups.root(int(m))].push_back(patches[m]);
  std::vector<std::vector<int>> out;
  for (auto& [number, list_of] : members) out.push_back(std::move(list_of));
  return out;
}

}  // namespace gridmorph
