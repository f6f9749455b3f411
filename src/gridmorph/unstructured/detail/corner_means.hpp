// The further nodes of second-order elements: means of corners.
#pragma once

#include <gridmorph/unstructured/gather_rows.hpp>
#include <gridmorph/unstructured/node_graph.hpp>

namespace gridmorph::detail {

/// One row for each node that is no corner of any element but a further node of one: amid an edge, a quadrilateral face or the
/// element itself, in the order of the SIDS. Cost O(nodes of all elements).
GatherRows corner_means(UnstructuredMesh const& mesh, NodeGraph const& graph);

}  // namespace gridmorph::detail
