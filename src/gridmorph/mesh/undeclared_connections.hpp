// Zones that touch although the file does not say so.
#pragma once

#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <string>
#include <vector>

namespace gridmorph {

/// Two patches of different zones whose nodes coincide one by one, but are paired by no connection.
struct TouchingPatches {
  int patch = -1, other = -1;       ///< numbers in UnstructuredMesh::patches, patch < other
  std::vector<Number> nodes;        ///< of patch, ascending
  std::vector<Number> other_nodes;  ///< of other, as many
};

/// All such pairs, by position within `tolerance`. Only patches with equally many nodes are looked at; n log n in their nodes.
std::vector<TouchingPatches> undeclared_connections(UnstructuredMesh const& mesh, double tolerance);

/// "patches 'a' (BC ...) and 'b' (BC ...) coincide in 2261 nodes, but no connection joins them: ..."
std::string describe(UnstructuredMesh const& mesh, TouchingPatches const& pair);

}  // namespace gridmorph
