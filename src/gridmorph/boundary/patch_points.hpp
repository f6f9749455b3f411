// Node positions of patches.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <algorithm>
#include <vector>

namespace gridmorph {

/// Calls f(flat node number) for the nodes of a range, i fastest.
template <class F>
void for_each_node(Zone const& zone, IndexRange const& range, F const& f) {
  for (int k = range.begin[2]; k < range.end[2]; ++k)
    for (int j = range.begin[1]; j < range.end[1]; ++j)
      for (int i = range.begin[0]; i < range.end[0]; ++i) f(zone.node({i, j, k}));
}

/// Whether two patches have nodes of one zone in common.
inline bool share_nodes(Patch const& a, Patch const& b) {
  bool shared = a.zone == b.zone;
  for (int axis = 0; axis < 3; ++axis)
    shared =
        shared && std::max(a.range.begin[axis], b.range.begin[axis]) < std::min(a.range.end[axis], b.range.end[axis]);
  return shared;
}

/// Positions of all nodes of the patches, patch after patch, i fastest.
inline std::vector<Vec3> patch_points(Mesh const& mesh, std::vector<int> const& patches) {
  std::vector<Vec3> points;
  for (int p : patches)
    for_each_node(mesh.zones[mesh.patches[p].zone], mesh.patches[p].range,
                  [&](Index n) { points.push_back(mesh.coordinates[n]); });
  return points;
}

}  // namespace gridmorph
