#include <gridmorph/quality/element_tables.hpp>

#include <algorithm>

namespace gridmorph::detail {

std::vector<Index32> neighbours_across(UnstructuredTopology const& topology) {
  auto const& [nodes, element, side, across] = topology.boundary;
  if (std::none_of(across.begin(), across.end(), [](Index32 e) { return e >= 0; })) return {};
  std::vector<Index32> out = topology.sides.neighbour;
  for (std::size_t f = 0; f < across.size(); ++f)
    if (across[f] >= 0) out[std::size_t(topology.sides.first[std::size_t(element[f])] + side[f])] = across[f];
  return out;
}

}  // namespace gridmorph::detail
