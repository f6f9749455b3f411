#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/as_hexahedra.hpp>
#include <gridmorph/mesh/block_elements.hpp>

#include <limits>

namespace gridmorph {

Mesh as_hexahedra(Mesh const& mesh) {
  if (mesh.n_nodes() > std::numeric_limits<Index32>::max())
    throw MeshError("'" + mesh.source + "' has " + std::to_string(mesh.n_nodes()) +
                    " nodes; as an unstructured mesh it may have at most " +
                    std::to_string(std::numeric_limits<Index32>::max()));
  Mesh out;
  out.source = mesh.source;
  out.families = mesh.families;
  out.coordinates = Coordinates(mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) out.coordinates.set(n, mesh.coordinates[n]);
  out.elements.type.reserve(mesh.n_cells());
  out.elements.nodes.first.reserve(mesh.n_cells() + 1);
  out.elements.nodes.item.reserve(8 * std::size_t(mesh.n_cells()));
  for (auto const& zone : mesh.zones) {
    int const added = out.add_zone(zone.name, zone.size());
    out.zones[added].single_precision = zone.single_precision;
    add_cells(out, zone, mesh.coordinates);
  }
  for (auto const& patch : mesh.patches) out.patches.push_back(as_faces(mesh, patch));
  for (auto const& face : mesh.interfaces) out.connections.push_back(node_pairs(mesh, face));
  return out;
}

}  // namespace gridmorph
