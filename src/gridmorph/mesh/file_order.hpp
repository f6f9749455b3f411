// Nodes and elements along a curve through space, and back in the order of the file.
//
// Meshers number as they go, and files may be in any order. What belongs together is then far apart in memory, and
// every stage of an unstructured morph waits for it: twice as long in all with numbers at random.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <span>
#include <utility>
#include <vector>

namespace gridmorph {

/// Whether the numbers of most elements' corners are further apart than a sixteenth of all nodes: what
/// order_by_position() is for; blocks are not looked at. Never for less than 4,096 nodes, which fit in a cache in any
/// order. Cost: one stream over the elements.
bool is_scattered(HostInstance const& host, Mesh const& mesh);
inline bool is_scattered(Mesh const& mesh) { return is_scattered(HostInstance(), mesh); }

/// Nodes of each zone along a Hilbert curve through the bounding box, nodes at the same place in the order they have;
/// elements of each zone by the first of their nodes along it. Blocks stay as they are. Linear cost: a sort by
/// counting, a few streams over the elements.
FileOrder order_by_position(HostInstance const& host, Mesh const& mesh);
inline FileOrder order_by_position(Mesh const& mesh) { return order_by_position(HostInstance(), mesh); }

/// Renumbers the nodes and elements inside their zones: what stands at place order.node[n] comes to place n. Zones,
/// patches and connections stay in order, and so do the faces of each patch. The mesh knows its way back (file_order).
/// The mesh must be in the order of its file; throws MeshError for one that is not, for an order of other sizes, and
/// for one that moves nodes or cells of a block, whose numbers follow from their indices.
void reorder(HostInstance const& host, Mesh& mesh, FileOrder order);
inline void reorder(Mesh& mesh, FileOrder order) { reorder(HostInstance(), mesh, std::move(order)); }

/// The mesh as its file numbers it, without the nodes that it left to it.
Mesh in_file_order(HostInstance const& host, Mesh const& mesh);
inline Mesh in_file_order(Mesh const& mesh) { return in_file_order(HostInstance(), mesh); }
/// Coordinates as the file of the mesh numbers them.
Coordinates in_file_order(HostInstance const& host, Mesh const& mesh, Coordinates const& coordinates);
inline Coordinates in_file_order(Mesh const& mesh, Coordinates const& coordinates) {
  return in_file_order(HostInstance(), mesh, coordinates);
}
/// A value for each node or each element of the mesh, as its file numbers them. `place` is node_places() or
/// file_order.element.
std::vector<double> in_file_order(HostInstance const& host, std::span<Index32 const> place,
                                  std::span<double const> values);
inline std::vector<double> in_file_order(std::span<Index32 const> place, std::span<double const> values) {
  return in_file_order(HostInstance(), place, values);
}

/// Nodes that no element has (centres of circles, points of a mesh that was cut away, ...) are no part of a mesh that
/// is read, so that they change nothing: neither its size nor what is found around its nodes. Takes those that neither
/// an element, nor a face of a patch or a subset, nor a connection has out of a mesh in the order of its file; blocks
/// keep theirs. Then FileOrder::node has the place of each node that stays among all those of its zone, counted on from
/// Zone::first_node. Returns how many were taken out; a mesh without any stays as it is. Linear cost.
Index leave_out_unused_nodes(Mesh& mesh);
/// FileOrder::node among the nodes that the mesh has: what in_file_order() takes for values of nodes.
std::vector<Index32> node_places(Mesh const& mesh);

/// What a file has that left nodes to it: `n_nodes` of each zone, and where all of them are.
struct NodesOfFile {
  std::vector<Index> n_nodes;
  Coordinates coordinates;
};
/// The mesh in the order of its file, with all of its nodes. Throws MeshError where the file has fewer nodes than the
/// mesh, or other zones.
Mesh with_all_nodes(Mesh const& mesh, NodesOfFile const& file);
/// Coordinates of all nodes of the file: `coordinates` of those that the mesh has, where the file has them of the
/// others.
Coordinates with_all_nodes(Mesh const& mesh, NodesOfFile const& file, Coordinates const& coordinates);
/// A value for each node of the file, zero of those that the mesh does not have.
std::vector<double> with_all_nodes(Mesh const& mesh, NodesOfFile const& file, std::span<double const> values);

}  // namespace gridmorph
