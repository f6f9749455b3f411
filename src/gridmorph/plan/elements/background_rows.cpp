#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/mesh/as_hexahedra.hpp>
#include <gridmorph/plan/elements/background.hpp>
#include <gridmorph/plan/elements/locate.hpp>

namespace gridmorph {

FarRows background_rows(Background const& background, Coordinates const& coordinates, std::span<Index32 const> nodes) {
  if (background.lattice) return lattice_rows(background, coordinates, nodes);
  using Exec = Kokkos::DefaultHostExecutionSpace;
  Exec const exec;
  Mesh const cells = as_hexahedra(background.mesh);
  ElementLocator<Exec> const locator(exec, cells);
  Kokkos::View<Vec3*, Kokkos::HostSpace> points("gridmorph::far_points", nodes.size());
  for (std::size_t n = 0; n < nodes.size(); ++n) points(n) = coordinates[nodes[n]];
  Kokkos::View<Location*, Kokkos::HostSpace> found("gridmorph::far_locations", nodes.size());
  locator.locate(exec, points, found);
  compat::fence(exec, "gridmorph::background_rows (read by the host)");
  std::span<Location const> const locations(found.data(), found.extent(0));
  LocateReport const report = summarise(locations);
  return {interpolation_rows(cells, locations, nodes), report.outside, report.largest_distance};
}

}  // namespace gridmorph
