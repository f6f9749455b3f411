#include <gridmorph/mesh/coincident_pairs.hpp>

#include <algorithm>

namespace gridmorph {

std::vector<std::pair<Index, Index>> coincident_pairs(Coordinates const& coordinates, std::vector<Index> const& nodes,
                                                      std::function<int(Index node)> const& zone, double tolerance) {
  // Along an oblique line few points of a mesh lie side by side, even where it is a lattice.
  constexpr Vec3 line{0.5318, 0.6173, 0.5797};
  struct Placed {
    double along;
    Index node;
    int zone;
  };
  std::vector<Placed> sorted;
  sorted.reserve(nodes.size());
  for (Index const n : nodes) sorted.push_back({dot(line, coordinates[n]), n, zone(n)});
  std::sort(sorted.begin(), sorted.end(), [](Placed const& a, Placed const& b) {
    return a.along < b.along || (a.along == b.along && a.node < b.node);
  });
  std::vector<std::pair<Index, Index>> out;
  for (std::size_t a = 0; a < sorted.size(); ++a)
    for (std::size_t b = a + 1; b < sorted.size() && sorted[b].along - sorted[a].along <= tolerance; ++b)
      if (sorted[a].zone != sorted[b].zone &&
          distance(coordinates[sorted[a].node], coordinates[sorted[b].node]) <= tolerance)
        out.push_back(std::minmax(sorted[a].node, sorted[b].node));
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace gridmorph
