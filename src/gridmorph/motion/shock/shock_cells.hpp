// The cells where a flow solution has a shock, and the solution as the sensors see it: at the corners of cells.
#pragma once

#include <gridmorph/boundary/regions.hpp>
#include <gridmorph/mesh/flow_solution.hpp>
#include <gridmorph/mesh/mesh.hpp>
#include <gridmorph/motion/shock/shock_search.hpp>

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace gridmorph {

/// The cells of a mesh of either kind by their corners.
class CellCorners {
 public:
  explicit CellCorners(Mesh const& mesh);

  [[nodiscard]] Index size() const { return n_; }
  /// The dimension of the cells in the file.
  [[nodiscard]] int dimension() const { return mesh_.dimension; }
  /// Calls look(cell, corner nodes) for every cell in order.
  void each(std::function<void(Index, std::span<Index const>)> const& look) const;
  /// The smallest number among the nodes at one place, across interfaces and connections that are not periodic.
  [[nodiscard]] Index one(Index node) const { return one_[node]; }
  /// For each node the one that stands for its place, across periodic sides too.
  [[nodiscard]] std::vector<Index> one_across_periodic_sides() const;
  [[nodiscard]] Index n_nodes() const { return Index(one_.size()); }

 private:
  Mesh const& mesh_;
  Index n_ = 0;
  std::vector<Index> one_;
};

/// Values on all nodes: pressure or another variable, and where they are wanted velocity and speed of sound.
struct FlowAtNodes {
  std::vector<double> variable;
  std::array<std::vector<double>, 3> velocity;
  std::vector<double> sound;
};

/// Pressure and velocity are made of Density, Momentum and EnergyStagnationDensity where the solution has these alone:
/// p = (gamma - 1) (rho E - rho v^2 / 2), a^2 = gamma p / rho. The units of the solution have to be of one system,
/// whichever. Values in cells become the mean of the cells around each node. Throws MotionError where something lacks,
/// with what there is. Cost O(nodes + cells).
FlowAtNodes flow_at_nodes(CellCorners const& cells, FlowSolution const& solution, ShockSearch const& search);

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
