// The smallest angle between grid edges of a set of pieces: what ties between chains are broken by.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/mesh/mesh.hpp>

#include <span>
#include <vector>

namespace gridmorph {

/// A box of nodes of one zone, bounding planes included.
struct NodeBox {
  int zone = -1;
  IndexRange nodes;
};

/// The largest cosine of each box between grid edges of different directions that meet at one of its nodes, over the
/// edges inside the box: the cosine of the smallest angle of the faces of its cells, which is never above 90 degrees.
/// Edges of no length have no angle. The result does not depend on the number of threads, nor on how zones are numbered
/// or turned.
///
/// Cost: one pass over the nodes: 24 bytes, 4 square roots and about 110 flops per node.
std::vector<double> largest_cosines(HostInstance const& host, Mesh const& mesh, std::span<NodeBox const> boxes);

}  // namespace gridmorph
