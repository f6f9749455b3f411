// Where the nodes of a mesh of elements go when its root lines are filled.
#pragma once

#include <gridmorph/fillet/root_sections.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace gridmorph {

/// The corner is made round node by node (BetweenSections::place()); nodes of the walls are put onto arcs and walls
/// exactly, and what that takes is handed to the nodes over them. `on_arc`: per node, whether it is on a fillet. Cost
/// O(nodes), and O(log facets) for those near the lines.
Coordinates round_corners(JoinedElements const& elements, WallEdges const& edges, RootSections const& sections,
                          std::array<FacetSurface const*, 2> const& walls, std::vector<std::uint8_t>& on_arc);

}  // namespace gridmorph
