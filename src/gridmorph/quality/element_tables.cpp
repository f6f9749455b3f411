#include <gridmorph/quality/element_tables.hpp>

#include <algorithm>

namespace gridmorph::detail {

std::vector<Index32> neighbours_across(UnstructuredTopology const& topology) {
  auto const& [nodes, element, side, across, connection, behind] = topology.boundary;
  if (std::none_of(across.begin(), across.end(), [](Index32 f) { return f >= 0; })) return {};
  std::vector<Index32> out = topology.sides.neighbour;
  for (std::size_t f = 0; f < across.size(); ++f)
    if (across[f] >= 0) out[topology.sides.first[element[f]] + side[f]] = element[across[f]];
  return out;
}

LinkedSides linked_sides(Mesh const& mesh, UnstructuredTopology const& topology) {
  auto const& [nodes, element, side, across, connection, behind] = topology.boundary;
  LinkedSides out;
  // Bindings are named one by one, since clang below 16 captures none in code for OpenMP.
  auto const side_of = [&topology, &element = element, &side = side](std::size_t f) {
    return std::size_t(topology.sides.first[element[f]] + side[f]);
  };
  for (std::size_t f = 0; f < across.size(); ++f) {
    if (across[f] < 0) continue;
    if (out.links.empty()) out.neighbour = topology.sides.neighbour;
    auto const there = std::size_t(across[f]);
    SideLink link{element[there], side[there], {}};
    auto const& c = mesh.connections[connection[f] / 2];
    if (c.periodic) {
      Mat3 const& to_donor = c.periodic->declared.rotation;
      link.turn = connection[f] % 2 == 0 ? transpose(to_donor) : to_donor;
    }
    out.neighbour[side_of(f)] = first_link - Index32(out.links.size());
    out.links.push_back(link);
  }
  return out;
}

}  // namespace gridmorph::detail
