// Zones that touch although the file does not say so.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <span>
#include <string>
#include <vector>

namespace gridmorph {

/// Two patches of different zones whose nodes coincide one by one, but are paired by no connection.
struct TouchingPatches {
  int patch = -1, other = -1;        ///< numbers in Mesh::patches, patch < other
  std::vector<Index32> nodes;        ///< of patch, ascending
  std::vector<Index32> other_nodes;  ///< of other, as many
  bool one = false;                  ///< all of them are near enough to be one (nodes_at_one_place())
};

/// All such pairs, by position within `tolerance`. Only patches with equally many nodes are looked at; n log n in their
/// nodes.
std::vector<TouchingPatches> undeclared_connections(Mesh const& mesh, double tolerance);

/// For each node the smallest number among the nodes that are one with it: those that coincident_nodes() declares, and
/// nodes of patches of different zones closer than 1e-8 of the mesh size (or what the precision of its coordinates
/// allows, coordinate_resolution.hpp). Nodes of connections that do not match node to node (sliding planes, overset)
/// are left as they are declared, and so are nodes of different `groups` (one number per node; empty: all alike), as
/// the two sides of a mixing plane between blade rows. n log n in the nodes of patches.
std::vector<Index32> nodes_at_one_place(HostInstance const& host, Mesh const& mesh, std::span<int const> groups = {});
inline std::vector<Index32> nodes_at_one_place(Mesh const& mesh) { return nodes_at_one_place(HostInstance(), mesh); }

/// "patches 'a' (BC ...) and 'b' (BC ...) coincide in 2261 nodes, but no connection joins them: ..."
std::string describe(Mesh const& mesh, TouchingPatches const& pair);

}  // namespace gridmorph
