// Interfaces and open faces of blocks found from what their nodes are. Internal to generated meshes.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <functional>
#include <vector>

namespace gridmorph::demo {

/// A rectangle of cells on a zone's face that is joined with no other.
struct OpenFace {
  int zone, axis, side;
  IndexRange range;  ///< of nodes
};

/// Finds the cells of zone faces whose four nodes are those of another one, adds interfaces from both sides for
/// rectangles of them, and returns rectangles of the others. identity: the same number for all nodes at one place that
/// are one, and for no others; no face may have an edge or a diagonal of one node twice. n log n in the cells on faces.
std::vector<OpenFace> join_by_nodes(Mesh& mesh, std::function<Index(int zone, Index3 const&)> const& identity);

}  // namespace gridmorph::demo
