#include <gridmorph/motion/target/surface_pieces.hpp>

#include <algorithm>
#include <numeric>

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
  std::vector<int> root(facets.size());
  std::iota(root.begin(), root.end(), 0);
  auto const find = [&](int n) {
    while (root[n] != n) n = root[n] = root[root[n]];
    return n;
  };
  for (std::size_t n = 1; n < sides.size(); ++n) {
    if (sides[n].edge != sides[n - 1].edge || cuts.contains(sides[n].edge)) continue;
    int const a = find(sides[n - 1].facet), b = find(sides[n].facet);
    root[std::max(a, b)] = std::min(a, b);
  }
  std::vector<int> piece(facets.size(), -1);
  int count = 0;
  for (int n = 0; n < int(facets.size()); ++n) piece[n] = find(n) == n ? count++ : piece[find(n)];
  return piece;
}

}  // namespace gridmorph
