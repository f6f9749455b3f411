// The cells where a flow solution has a shock.
#pragma once

#include <gridmorph/boundary/regions.hpp>
#include <gridmorph/mesh/flow_solution.hpp>
#include <gridmorph/mesh/mesh.hpp>
#include <gridmorph/motion/shock/shock_search.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace gridmorph {

/// A place of a shock and what it counts.
struct ShockPoint {
  Vec3 place;
  double weight = 0;
};

struct ShockCells {
  std::vector<std::uint8_t> cells;  ///< of the mesh: blocks zone after zone, i fastest; elements by their numbers
  std::vector<ShockPoint>
      points;      ///< middles of those that the sensor found, weighted by the rise over them times their size
  Vec3 direction;  ///< the mean way of the gradient there, the rise times the size counting; length 1, 0 where it has
                   ///< none
  std::string summary;  ///< "pressure shock: 212 cells in 2 groups ..." for notes
};

/// The variables that a search may read.
std::vector<std::string> shock_variables(ShockSearch const& search);

/// Whether each cell of the mesh lies in the zones of a region and where it holds, leaving aside shock and cells. A
/// zone that is not there holds nothing (add_regions() says so).
std::vector<std::uint8_t> cells_looked_at(Mesh const& mesh, InnerRegion const& region);

/// Cells of the shock among those looked at. Cells that share a node, across interfaces and connections too, periodic
/// ones among them, are neighbours: of one group, and layers grow to them. Throws MotionError where variables lack
/// (listing those there are), where no cell reaches the threshold (with the largest value, where it is, and what would
/// do) and where all groups are too small. Cost O(nodes + cells).
ShockCells find_shock(Mesh const& mesh, FlowSolution const& solution, ShockSearch const& search,
                      std::vector<std::uint8_t> const& looked_at);

}  // namespace gridmorph
