// A smooth field between scattered boundary values: how walls and other boundaries move, carried into the volume.
#pragma once

#include <gridmorph/kernels/uniform_lattice.hpp>
#include <gridmorph/plan/layers.hpp>

#include <array>
#include <vector>

namespace gridmorph {

/// At each node of an even lattice the values of boundary nodes n are averaged with the weights
///
///     w_n = A_n / |x - x_n|^p,   p = 4 (3-D), 3 (2-D),   A_n: the node's share of the boundary's area,
///
/// inverse distance weighting (Shepard 1968; with areas and for meshes: Luke, Collins and Blades 2012), where far
/// groups of nodes count as one, at their centre with their mean (a tree by position, opened where a group's radius
/// exceeds `opening` times its distance). In the cells the field is trilinear. So it is smooth, reaches a place by
/// means over boundary parts as large as their distance, and reproduces constants to round-off.
///
/// All values are gathered: leaves of the tree from nodes, groups from their two parts level by level, lattice nodes
/// from groups.
struct InverseDistanceField {
  InterpolationOperator leaves;   ///< boundary nodes (numbers in the mesh) -> groups
  LayerRows groups;               ///< groups -> groups, from the smallest on
  InterpolationOperator lattice;  ///< groups -> lattice nodes
  Index32 n_groups = 0;
  std::vector<Vec3> centre;  ///< of each group
  kernels::UniformLattice shape;

  [[nodiscard]] bool empty() const { return n_groups == 0; }
};

/// Radius over distance up to which a group counts as one. About a half, but no ratio of lengths in a lattice:
/// round-off would break such ties. The fine one where values are motions that turn and so change across a group: twice
/// as many items per lattice node.
inline constexpr double coarse_opening = 0.4917, fine_opening = 0.3517;

/// What lattice a field is asked for on.
struct ScatterLattice {
  Vec3 low, high;  ///< the box that it covers
  Index most_nodes = 100'000;
  double opening = coarse_opening;
  /// The nodes of the mesh that read the field: nodes of the lattice that none of them reads have no row. Empty: all
  /// have.
  std::vector<Index32> readers{};
};

/// The field of boundary nodes on a lattice. nodes: boundary nodes; area: the share of each, positive. Cost O(n log n)
/// in the nodes and in the lattice's nodes; the latter on all threads of the instance, whose number does not matter.
InverseDistanceField make_scatter_lattice(HostInstance const& host, Coordinates const& coordinates,
                                          std::vector<Index32> const& nodes, std::vector<double> const& area,
                                          int dimension, ScatterLattice const& lattice);
inline InverseDistanceField make_scatter_lattice(Coordinates const& coordinates, std::vector<Index32> const& nodes,
                                                 std::vector<double> const& area, int dimension,
                                                 ScatterLattice const& lattice) {
  return make_scatter_lattice(HostInstance(), coordinates, nodes, area, dimension, lattice);
}

}  // namespace gridmorph
