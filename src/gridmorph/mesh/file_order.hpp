// Nodes and elements along a curve through space, and back in the order of the file.
//
// Meshers number as they go, and files may be in any order. What belongs together is then far apart in memory, and every
// stage of an unstructured morph waits for it: twice as long in all with numbers at random.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <span>
#include <utility>
#include <vector>

namespace gridmorph {

/// Whether the numbers of most elements' corners are further apart than a sixteenth of all nodes: what order_by_position() is
/// for; blocks are not looked at. Never for less than 4,096 nodes, which fit in a cache in any order. Cost: one stream over the elements.
bool is_scattered(HostInstance const& host, Mesh const& mesh);
inline bool is_scattered(Mesh const& mesh) { return is_scattered(HostInstance(), mesh); }

/// Nodes of each zone along a Hilbert curve through the bounding box, nodes at the same place in the order they have;
/// elements of each zone by the first of their nodes along it. Blocks stay as they are. Linear cost: a sort by counting, a few streams over the
/// elements.
FileOrder order_by_position(HostInstance const& host, Mesh const& mesh);
inline FileOrder order_by_position(Mesh const& mesh) { return order_by_position(HostInstance(), mesh); }

/// Renumbers the nodes and elements inside their zones: what stands at place order.node[n] comes to place n. Zones, patches
/// and connections stay in order, and so do the faces of each patch. The mesh knows its way back (file_order). The mesh must
/// be in the order of its file; throws MeshError for one that is not, for an order of other sizes, and for one that moves nodes
/// or cells of a block, whose numbers follow from their indices.
void reorder(HostInstance const& host, Mesh& mesh, FileOrder order);
inline void reorder(Mesh& mesh, FileOrder order) { reorder(HostInstance(), mesh, std::move(order)); }

/// The mesh as its file numbers it.
Mesh in_file_order(HostInstance const& host, Mesh const& mesh);
inline Mesh in_file_order(Mesh const& mesh) { return in_file_order(HostInstance(), mesh); }
/// Coordinates as the file of the mesh numbers them.
Coordinates in_file_order(HostInstance const& host, Mesh const& mesh, Coordinates const& coordinates);
inline Coordinates in_file_order(Mesh const& mesh, Coordinates const& coordinates) {
  return in_file_order(HostInstance(), mesh, coordinates);
}
/// A value for each node or each element of the mesh, as its file numbers them. `place` is file_order.node or .element.
std::vector<double> in_file_order(HostInstance const& host, std::span<Index32 const> place,
                                  std::span<double const> values);
inline std::vector<double> in_file_order(std::span<Index32 const> place, std::span<double const> values) {
  return in_file_order(HostInstance(), place, values);
}

}  // namespace gridmorph
