// Layers of nodes around a set of nodes, and how displacements pass from one layer to the next.
#pragma once

#include <gridmorph/mesh/node_graph.hpp>
#include <gridmorph/plan/interpolation_operator.hpp>

#include <cstdint>
#include <functional>
#include <vector>

namespace gridmorph {

struct LayerRows {
  InterpolationOperator rows;   ///< targets in the order of their layers
  std::vector<Index> level{0};  ///< first row of each layer, and the end

  [[nodiscard]] int n_layers() const { return int(level.size()) - 1; }
};

/// Layers of the nodes of `wanted` around the seeds, in the order of a distance from them instead of a number of edges:
/// a node gathers from the neighbours that are nearer to the seeds by more than 0.28 of the edge between them, with
/// their whole weight from 0.38 on, or else from the nearest of those that have a row already. So fronts that leave
/// walls with fine and with coarse elements advance alike. A layer holds the nodes whose sources lie in layers before.
/// weight(node, source) must be positive. Ties go by places, so that numbers of nodes do not matter. Seeds need not be
/// at distance zero; wanted nodes that no chain of edges joins to a seed get no row. `weight` is called on all threads
/// of the instance, whose number does not matter. Cost: a sort of the wanted nodes by counting, and their edges once.
LayerRows make_layers(HostInstance const& host, NodeGraph const& graph, Coordinates const& coordinates,
                      std::vector<std::uint8_t> const& seeds, std::vector<std::uint8_t> const& wanted,
                      std::vector<double> const& distance,
                      std::function<double(Index32 node, Index32 source)> const& weight);
inline LayerRows make_layers(NodeGraph const& graph, Coordinates const& coordinates,
                             std::vector<std::uint8_t> const& seeds, std::vector<std::uint8_t> const& wanted,
                             std::vector<double> const& distance,
                             std::function<double(Index32 node, Index32 source)> const& weight) {
  return make_layers(HostInstance(), graph, coordinates, seeds, wanted, distance, weight);
}

}  // namespace gridmorph
