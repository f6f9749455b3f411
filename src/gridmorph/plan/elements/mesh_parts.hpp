// Parts of a mesh of elements that nothing connects, and one of them as a mesh of its own. Internal to plan.
#pragma once

#include <gridmorph/mesh/node_graph.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>
#include <gridmorph/motion/boundary_conditions.hpp>

#include <cstdint>
#include <vector>

namespace gridmorph::detail {

/// The number of the part (n_nodes) that a node belongs to, -1 where no element has it. Elements that share a node hang
/// together, and so do nodes at one place and those that a connection pairs, periodic ones too. `cuts`: (n_nodes) nodes
/// at one place, by the one that carries them, that do not join the zones on their two sides; empty: none. Parts are
/// counted in the order of their first nodes. Cost O(corners of all elements).
std::vector<Index32> parts_of_nodes(Mesh const& mesh, NodeGraph const& graph, std::vector<std::uint8_t> const& cuts);

/// Some nodes of a mesh, with all elements that have them, as a mesh of its own: zones and patches keep their numbers,
/// nodes and elements their order.
struct MeshPart {
  Mesh mesh;
  std::vector<Index32> nodes, elements;  ///< of the part -> of the mesh, ascending
  UnstructuredTopology topology;
  BoundaryFacePatches face_patches;
  NodeGraph graph;
  BoundaryConditions boundary;  ///< rules and patches are those of the mesh
  std::vector<Index32> slots;   ///< of the part's known nodes -> of the mesh's
};

/// The nodes with of_part[n] != 0: whole parts of parts_of_nodes(). Cost O(mesh).
MeshPart mesh_part(HostInstance const& host, Mesh const& mesh, NodeGraph const& graph,
                   BoundaryConditions const& boundary, std::vector<std::uint8_t> const& of_part);

}  // namespace gridmorph::detail
