// Zones, and parts of them, drawn at random: boxes that cover a zone without overlap, those of several ranks.
#pragma once

#include <gridmorph/mesh/distribution.hpp>
#include <gridmorph/mesh/mesh.hpp>

#include "support/random.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph::test {

/// Zones without coordinates.
inline Mesh drawn_zones(int n_zones, int most_nodes, Random& random) {
  Mesh mesh;
  auto const extent = [&] { return 2 + random.below(most_nodes - 1); };
  for (int z = 0; z < n_zones; ++z) {
    int const i = extent(), j = extent();
    mesh.add_zone("Z" + std::to_string(z), {i, j, extent()});
  }
  return mesh;
}

/// How parts that a plane divides have nodes in common.
enum class Joint { none, plane, layers };

/// A box divided by planes until pieces are few nodes, by chance.
inline void divide(IndexRange const& box, int zone, Joint joint, Random& random, std::vector<Part>& out) {
  int const a = random.below(3);
  int const least = joint == Joint::none ? 2 : 3;
  if (box.extent(a) < least || random.below(6) == 0) {
    out.push_back({zone, box, -1});
    return;
  }
  IndexRange below = box, above = box;
  int const place = box.begin[a] + 1 + random.below(box.extent(a) - least + 1);
  above.begin[a] = place;
  below.end[a] = joint == Joint::none ? place : place + 1;
  divide(below, zone, joint, random, out);
  divide(above, zone, joint, random, out);
}

/// Parts of all zones in any order, of random ranks of which some may have none. Layers of ghost nodes are one or two.
inline std::vector<Part> drawn_parts(Mesh const& mesh, int n_ranks, Joint joint, Random& random) {
  std::vector<Part> out;
  for (int z = 0; z < int(mesh.zones.size()); ++z) divide({{0, 0, 0}, mesh.zones[z].extent}, z, joint, random, out);
  int const n_used = 1 + random.below(n_ranks);
  for (Part& part : out) {
    part.rank = random.below(n_used);
    for (int a = 0; a < 3 && joint == Joint::layers; ++a) {
      part.nodes.begin[a] = std::max(0, part.nodes.begin[a] - 1 - random.below(2));
      part.nodes.end[a] = std::min(mesh.zones[part.zone].extent[a], part.nodes.end[a] + 1 + random.below(2));
    }
  }
  random.shuffle(out);
  return out;
}

inline IndexRange drawn_range(Zone const& zone, Random& random) {
  IndexRange out;
  for (int a = 0; a < 3; ++a) {
    int const p = random.below(zone.extent[a] + 1), q = random.below(zone.extent[a] + 1);
    out.begin[a] = std::min(p, q);
    out.end[a] = std::max(p, q);
  }
  return out;
}

template <class Function>
void for_indices(IndexRange const& range, Function const& f) {
  for (int k = range.begin[2]; k < range.end[2]; ++k)
    for (int j = range.begin[1]; j < range.end[1]; ++j)
      for (int i = range.begin[0]; i < range.end[0]; ++i) f(Index3{i, j, k});
}

}  // namespace gridmorph::test
