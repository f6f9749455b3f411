// What the weights of layers look at: quality around nodes, curvature of walls.
#pragma once

#include <gridmorph/mesh/node_graph.hpp>

#include <vector>

namespace gridmorph::detail {

/// Mean over the elements around each node of their shortest over their longest edge, 0 < grade <= 1. Cost O(corners).
std::vector<double> node_grades(Mesh const& mesh, UnstructuredTopology const& topology, NodeGraph const& graph);

/// Curvature of the wall at each of its nodes: the largest angle between its normal and a neighbour's over their
/// distance [1 / length]; zero elsewhere. Cost O(faces).
std::vector<double> wall_curvature(Mesh const& mesh, UnstructuredTopology const& topology, NodeGraph const& graph,
                                   std::vector<Index32> const& faces);

}  // namespace gridmorph::detail
