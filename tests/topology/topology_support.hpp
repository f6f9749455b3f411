// Topology of a mesh without any motion: patches of different families stay on different blocks.
#pragma once

#include <gridmorph/plan/topology.hpp>

#include <map>
#include <string>
#include <vector>

namespace gridmorph::test {

inline MergeLimits limits_by_family(Mesh const& mesh) {
  MergeLimits limits;
  std::map<std::string, int> labels;
  for (Patch const& p : mesh.patches)
    limits.patch_label.push_back(labels.try_emplace(p.families.front(), int(labels.size())).first->second);
  limits.interface_label.assign(mesh.interfaces.size(), 0);
  return limits;
}

/// Connected, checked, cut and merged.
inline Topology topology_of(Mesh const& mesh) {
  Links links = connect(mesh, {});
  check_coverage(mesh, links);
  return build_topology(mesh, std::move(links), limits_by_family(mesh));
}

/// Classes of entities of one dimension (0 corners, 1 edges, 2 faces, 3 pieces).
inline int count_classes(Lattice const& lattice, int dimension) {
  int count = 0;
  for (int c = 0; c < lattice.n_classes(); ++c)
    count += lattice.dimension(lattice.copies(c).front().entity) == dimension;
  return count;
}

/// Euler characteristic of the cell complex: corners - edges + faces - pieces.
inline int euler(Lattice const& lattice) {
  return count_classes(lattice, 0) - count_classes(lattice, 1) + count_classes(lattice, 2) - count_classes(lattice, 3);
}

}  // namespace gridmorph::test
