#include <gridmorph/mesh/as_hexahedra.hpp>
#include <gridmorph/plan/elements/background.hpp>
#include <gridmorph/plan/elements/locate.hpp>

namespace gridmorph {

FarRows background_rows(HostInstance const& host, Background const& background, Coordinates const& coordinates,
                        std::span<Index32 const> nodes) {
  if (background.lattice) return lattice_rows(host, background, coordinates, nodes);
  Mesh const cells = as_hexahedra(background.mesh);
  std::vector<Vec3> points;
  for (Index32 const n : nodes) points.push_back(coordinates[n]);
  std::vector<Location> const locations = locate(host, cells, points);
  LocateReport const report = summarise(locations);
  return {interpolation_rows(host, cells, locations, nodes), report.outside, report.largest_distance};
}

}  // namespace gridmorph
