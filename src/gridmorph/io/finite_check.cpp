#include <gridmorph/io/finite_check.hpp>
#include <gridmorph/mesh/extent.hpp>

#include <cmath>

namespace gridmorph::io {

void check_finite(Mesh const& mesh, Coordinates const& coordinates, std::string const& where, Problems& problems) {
  if (extent_of(coordinates).usable()) return;
  for (auto const& zone : mesh.zones) {
    Index bad = 0, first = -1;
    for (Index n = zone.first_node; n < zone.first_node + zone.size(); ++n) {
      if (is_usable(coordinates[n])) continue;
      if (bad++ == 0) first = n;
    }
    if (bad == 0) continue;
    Vec3 const p = coordinates[first];
    problems.add(where + ": " + std::to_string(bad) + (bad == 1 ? " node" : " nodes") + " of zone '" + zone.name +
                 "' have coordinates that are not finite numbers or larger than 1e100, the first is " +
                 describe_node(mesh, first) + " at (" + std::to_string(p.x) + ", " + std::to_string(p.y) + ", " +
                 std::to_string(p.z) + "); repair the mesh where it was made");
  }
}

}  // namespace gridmorph::io
