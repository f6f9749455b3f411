// A flow solution as the shock sensors see it: at the corners of cells.
#pragma once

#include <gridmorph/mesh/flow_solution.hpp>
#include <gridmorph/mesh/mesh.hpp>
#include <gridmorph/motion/shock/shock_search.hpp>

#include <array>
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
  /// Calls look(cell, corner nodes) for every cell in order.
  void each(std::function<void(Index, std::span<Index const>)> const& look) const;
  /// The smallest number among the nodes at one place, across interfaces and connections that are not periodic.
  [[nodiscard]] Index one(Index node) const { return one_[std::size_t(node)]; }
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

}  // namespace gridmorph
