// Distance of every node from a set of nodes, and which of them is nearest.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/mesh/node_graph.hpp>

#include <vector>

namespace gridmorph {

struct NearestSource {
  std::vector<Index32> source;   ///< (n_nodes) -1 for nodes that no edge joins to a source
  std::vector<double> distance;  ///< straight, to `source`; infinite where there is none
};

/// The nearest source of every node. Each source spreads along the edges of elements, shell after shell of nodes about
/// as far away: a node takes the nearest of the sources that its neighbours have, and again as long as these change,
/// then goes on from source to source along edges as long as it comes nearer. So the source is the nearest one up to
/// what a wall in between hides, but for rare ones nearly as far. Sources at the same distance go by their place:
/// numbers of nodes do not matter, and neither does the number of threads. Cost O(edges): each is looked at about three
/// times, at a few numbers of its ends.
NearestSource nearest_source(HostInstance const& host, Coordinates const& coordinates, NodeGraph const& graph,
                             std::vector<Index32> const& sources);
inline NearestSource nearest_source(Coordinates const& coordinates, NodeGraph const& graph,
                                    std::vector<Index32> const& sources) {
  return nearest_source(HostInstance(), coordinates, graph, sources);
}

}  // namespace gridmorph
