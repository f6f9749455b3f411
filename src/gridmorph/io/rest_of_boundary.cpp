#include <gridmorph/io/rest_of_boundary.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>

#include <utility>
#include <vector>

namespace gridmorph::io {

Index add_rest_of_boundary(Mesh& mesh) {
  Index added = 0;
  auto const topology = make_topology(mesh);
  auto const of_face = find_face_patches(mesh, topology);
  std::vector<Patch> rest(mesh.zones.size());
  for (Index f = 0; f < topology.boundary.size(); ++f) {
    auto const nodes = topology.boundary.nodes[f];
    if (of_face.patch[f] == BoundaryFacePatches::open) rest[mesh.zone_of(nodes[0])].faces.add(nodes);
  }
  for (std::size_t z = 0; z < rest.size(); ++z) {
    if (rest[z].faces.size() == 0) continue;
    added += rest[z].faces.size();
    rest[z].zone = int(z);
    rest[z].name = "boundary";
    mesh.patches.push_back(std::move(rest[z]));
  }
  return added;
}

}  // namespace gridmorph::io
