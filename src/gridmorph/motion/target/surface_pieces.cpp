#include <gridmorph/motion/target/target_projection.hpp>

#include <gridmorph/core/disjoint_sets.hpp>

#include <algorithm>

namespace gridmorph {

std::vector<int> pieces_between(std::vector<GridFacet> const& facets, std::set<std::pair<int, int>> const& cuts) {
  struct Side {
    std::pair<int, int> edge;
    int facet;
  };
  std::vector<Side> sides;
  for (int n = 0; n < int(facets.size()); ++n) {
    int const corners = facets[n][3] < 0 ? 3 : 4;
    for (int c = 0; c < corners; ++c) sides.push_back({std::minmax(facets[n][c], facets[n][(c + 1) % corners]), n});
  }
  std::sort(sides.begin(), sides.end(),
            [](Side const& s, Side const& t) { return s.edge != t.edge ? s.edge < t.edge : s.facet < t.facet; });
  DisjointSets<int> pieces(facets.size());
  for (std::size_t n = 1; n < sides.size(); ++n)
    if (sides[n].edge == sides[n - 1].edge && !cuts.contains(sides[n].edge))
      pieces.join(sides[n - 1].facet, sides[n].facet);
  return pieces.set_numbers();
}

}  // namespace gridmorph
