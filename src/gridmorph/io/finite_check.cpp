#include <gridmorph/core/text.hpp>
#include <gridmorph/io/finite_check.hpp>
#include <gridmorph/mesh/check_coordinates.hpp>

namespace gridmorph::io {

std::string unusable_nodes(std::string const& where, Index count, std::string const& zone, std::string const& first,
                           Vec3 const& at) {
  return where + ": " + std::to_string(count) + (count == 1 ? " node" : " nodes") + " of zone '" + zone +
         "' have coordinates that are not finite numbers or larger than 1e100, the first is " + first + " at " +
         to_text(at, 9) + "; repair the mesh where it was made";
}

void check_finite(Mesh const& mesh, Coordinates const& coordinates, std::string const& where, Problems& problems) {
  if (extent_of(coordinates).usable()) return;
  for (auto const& zone : mesh.zones) {
    Index bad = 0, first = -1;
    for (Index n = zone.first_node; n < zone.first_node + zone.size(); ++n) {
      if (is_usable(coordinates[n])) continue;
      if (bad++ == 0) first = n;
    }
    if (bad == 0) continue;
    problems.add(unusable_nodes(where, bad, zone.name, describe_node(mesh, first), coordinates[first]));
  }
}

void check_places(Mesh const& mesh, std::string const& path, Problems& problems) {
  MeshExtent const extent = extent_of(mesh.coordinates);
  if (!extent.usable()) check_finite(mesh, mesh.coordinates, path, problems);
  for (std::string const& what : find_misplaced(mesh, extent)) problems.add(path + ": " + what);
}

}  // namespace gridmorph::io
