#include <gridmorph/boundary/periodic_axis.hpp>
#include <gridmorph/mesh/extent.hpp>
#include <gridmorph/plan/elements/turning_bodies.hpp>

#include <algorithm>
#include <cmath>
#include <set>

namespace gridmorph {

std::vector<RigidTransform> periodic_moves(HostInstance const& host, Mesh const& mesh, NodeGraph const& graph,
                                           BoundaryConditions const& boundary, int passages) {
  std::set<Index32> joined;
  for (auto const& image : boundary.images) joined.insert({image.node, image.owner});
  std::vector<RigidTransform> out{RigidTransform{}};
  if (joined.empty()) return out;
  double const size = extent_of(host, mesh.coordinates).size();
  for (auto const& connection : mesh.connections) {
    if (!connection.periodic || connection.nodes.empty()) continue;
    std::vector<Vec3> from, to;
    bool free = false;
    for (std::size_t n = 0; n < connection.nodes.size(); ++n) {
      from.push_back(mesh.coordinates[connection.nodes[n]]);
      to.push_back(mesh.coordinates[connection.donor_nodes[n]]);
      free = free || joined.contains(graph.representative[connection.nodes[n]]);
    }
    if (!free) continue;
    RigidTransform const once = fit_periodic(*connection.periodic, from, to, size);
    for (RigidTransform const& step : {once, once.inverse()}) {
      RigidTransform move = step;
      for (int k = 0; k < passages; ++k) {
        if (std::none_of(out.begin(), out.end(),
                         [&](RigidTransform const& other) { return are_alike(move, other, size); }))
          out.push_back(move);
        move = move.then(step);
      }
    }
  }
  return out;
}

}  // namespace gridmorph
