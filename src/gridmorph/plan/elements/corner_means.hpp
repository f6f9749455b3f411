// The further nodes of second-order elements: means of corners.
#pragma once

#include <gridmorph/mesh/node_graph.hpp>
#include <gridmorph/plan/interpolation_operator.hpp>

namespace gridmorph::detail {

/// One row for each node that is no corner of any element but a further node of one: amid an edge, a quadrilateral face or the
/// element itself, in the order of the SIDS. Cost O(nodes of all elements).
InterpolationOperator corner_means(Mesh const& mesh, NodeGraph const& graph);

}  // namespace gridmorph::detail
