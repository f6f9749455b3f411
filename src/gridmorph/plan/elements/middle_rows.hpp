// The further nodes of second-order elements follow the corners around them.
#pragma once

#include <gridmorph/mesh/node_graph.hpp>
#include <gridmorph/plan/interpolation_operator.hpp>

namespace gridmorph::detail {

/// One row for each node that is no corner of any element but a further node of one: amid an edge, a quadrilateral face
/// or the element itself, in the order of the SIDS. With m the mean of the corners of that edge, face or element, and c
/// = x - m,
///
///   u(x) = mean of their u + G c
///
/// G being the gradient that fits the displacement of all corners of the elements around x best (least squares): c, by
/// which an edge is curved, turns and stretches with the elements, so that affine motions are followed exactly. Where
/// edges are straight, c = 0, and u is the mean. Cost O(nodes of all elements).
InterpolationOperator middle_rows(Mesh const& mesh, NodeGraph const& graph);

}  // namespace gridmorph::detail
