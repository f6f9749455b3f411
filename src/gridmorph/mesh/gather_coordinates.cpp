#include <gridmorph/mesh/distribution.hpp>
#include <gridmorph/mesh/fetch_nodes.hpp>
#include <gridmorph/mesh/gather_coordinates.hpp>

#include <vector>

namespace gridmorph {

Coordinates gather_coordinates(std::shared_ptr<Ranks const> const& ranks, BoundaryMesh const& zones,
                               std::span<NodeBox const> boxes, Coordinates const& coordinates) {
  std::vector<Bytes> const of_ranks = ranks->gather(std::as_bytes(boxes));
  std::vector<Part> parts;
  for (int r = 0; r < ranks->size(); ++r)
    for (NodeBox const& box : from_bytes<NodeBox>(of_ranks[std::size_t(r)])) parts.push_back({box.zone, box.nodes, r});
  Distribution const distribution(ranks, zones, std::move(parts));
  std::vector<NodeBox> wanted;
  if (ranks->rank() == 0)
    for (int z = 0; z < int(zones.zones.size()); ++z) wanted.push_back({z, {{0, 0, 0}, zones.zones[z].extent}});
  return fetch_nodes(distribution, coordinates, wanted);
}

}  // namespace gridmorph
