// Distance of every node from a set of nodes, and which of them is nearest.
#pragma once

#include <gridmorph/mesh/node_graph.hpp>

#include <vector>

namespace gridmorph {

struct NearestSource {
  std::vector<Index32> source;   ///< (n_nodes) -1 for nodes that no edge joins to a source
  std::vector<double> distance;  ///< straight, to `source`; infinite where there is none
};

/// Each source spreads along the edges of elements, in the order of the number of edges to the nearest one; a node takes the nearest
/// of the sources that its neighbours have, and again as long as these change. So the source is the nearest one up to
/// what a wall in between hides, and up to a cell or so where meshes are very uneven. Sources at the same distance go by their place: numbers of nodes do not
/// matter. Serial, deterministic, O(edges).
NearestSource nearest_source(Coordinates const& coordinates, NodeGraph const& graph,
                             std::vector<Index32> const& sources);

}  // namespace gridmorph
