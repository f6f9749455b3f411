// The faces around wall nodes.
#pragma once

#include <gridmorph/mesh/node_graph.hpp>

#include <vector>

namespace gridmorph::detail {

/// The nodes around each of `roots` on the wall, as pairs (a, b): in 3-D its neighbours behind and ahead in each wall
/// face around it, so that the sum of (a - root) x (b - root) is normal to the wall; in 2-D the ends of each wall edge
/// at it. Cost O(faces around).
CsrGraph wall_one_rings(Mesh const& mesh, UnstructuredTopology const& topology, NodeGraph const& graph,
                        std::vector<Index32> const& faces, std::vector<Index32> const& roots);

/// Normal of the wall at each node of `faces`, zero elsewhere; not of unit length.
std::vector<Vec3> wall_normals(Mesh const& mesh, UnstructuredTopology const& topology, NodeGraph const& graph,
                               std::vector<Index32> const& faces);

}  // namespace gridmorph::detail
