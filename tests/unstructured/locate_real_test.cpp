// Points in real meshes: every node and the middle of every element lies inside.
#include "support/shared_mesh.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/plan/elements/locate.hpp>

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace gridmorph::test {
namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;

std::vector<Location> locate(Mesh const& mesh, std::vector<Vec3> const& points) {
  std::vector<Location> out(points.size());
  ElementLocator<Exec> const locator(Exec(), mesh);
  locator.locate(Exec(), Kokkos::View<Vec3 const*, Kokkos::HostSpace>(points.data(), points.size()),
                 Kokkos::View<Location*, Kokkos::HostSpace>(out.data(), out.size()));
  Exec().fence();
  return out;
}

class LocateReal : public testing::TestWithParam<char const*> {};
INSTANTIATE_TEST_SUITE_P(Meshes, LocateReal,
                         testing::Values("heated_coil.cgns", "water_turbine.cgns", "slotted_airfoil.cgns",
                                         "HeatingCoil.cgns", "mesh_vki_turbine.su2", "axial_turbine_stage_H.cgns",
                                         "axialTurbine_7blk.cgns", "rotorstator.cgns", "mdo_tutorial_000_vol.cgns",
                                         "multi.cgns", "717_wl_L2.cgns"),
                         [](auto const& info) {
                           std::string name = info.param;
                           name.resize(name.find('.'));
                           return name[0] == '7' ? "wing_" + name : name;
                         });

TEST_P(LocateReal, NodesAndMiddlesOfElementsLieInside) {
  auto const path = shared_mesh(GetParam());
  if (path.empty()) GTEST_SKIP() << GetParam() << " is not there; its stand-in is tested";
  std::string const name = GetParam();
  auto const mesh = mesh_kind(path) == MeshKind::unstructured ? read_mesh(path) : as_hexahedra(read_mesh(path));
  std::vector<Vec3> points;
  for (Index n = 0; n < mesh.n_nodes(); ++n) points.push_back(mesh.coordinates[n]);
  for (Index e = 0; e < mesh.n_elements(); ++e) {
    Location middle;
    middle.element = Index32(e);
    ElementType const type = mesh.elements.type[e];
    middle.local = type == ElementType::tetrahedron ? Vec3{0.25, 0.25, 0.25}
                   : type == ElementType::triangle || type == ElementType::prism
                       ? Vec3{1.0 / 3, 1.0 / 3, type == ElementType::prism ? 0.5 : 0}
                   : type == ElementType::pyramid ? Vec3{0.375, 0.375, 0.25}
                                                  : Vec3{0.5, 0.5, mesh.dimension == 2 ? 0 : 0.5};
    points.push_back(position(mesh, middle));
  }
  auto const found = locate(mesh, points);
  auto const report = summarise(found);
  EXPECT_EQ(report.outside, 0) << name << ": up to " << report.largest_distance << " outside, the worst is number "
                               << report.worst << " of " << mesh.n_nodes() << " nodes and then elements";
  double const tolerance = 1e-12 * mesh.size();
  Index elsewhere = 0;
  for (std::size_t n = 0; n < points.size(); ++n) {
    ASSERT_GE(found[n].element, 0);
    EXPECT_LT(distance(position(mesh, found[n]), points[n]), 2 * tolerance);
    if (Index(n) >= mesh.n_nodes() && found[n].element != Index32(Index(n) - mesh.n_nodes())) ++elsewhere;
  }
  bool const zones_overlap = name == "rotorstator.cgns";
  EXPECT_EQ(elsewhere > 0, zones_overlap);
  // Nodes take their own value, or that of one at the same place in another zone.
  std::vector<Index32> targets(mesh.n_nodes());
  for (std::size_t n = 0; n < targets.size(); ++n) targets[n] = Index32(n);
  auto const rows = interpolation_rows({}, mesh, std::span<Location const>(found).first(targets.size()), targets);
  Index several = 0;
  for (Index n = 0; n < rows.size(); ++n) {
    if (rows.first[n + 1] - rows.first[n] != 1) {
      ++several;
      continue;
    }
    EXPECT_LT(distance(mesh.coordinates[rows.item[rows.first[n]]], mesh.coordinates[n]), tolerance);
  }
  // Rows of the stand-in turbine touch along planes, where nodes of the one lie on faces of the other.
  EXPECT_EQ(several > 0, zones_overlap || name == "water_turbine.cgns");
}

}  // namespace
}  // namespace gridmorph::test
