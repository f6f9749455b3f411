// Real meshes as PLOT3D files: their interfaces, known from the CGNS files, are found again from the points.
#include "io_support.hpp"
#include "support/interface_cells.hpp"
#include "support/plot3d_file.hpp"

#include <gridmorph/boundary/find_interfaces.hpp>
#include <gridmorph/io/mesh_io.hpp>

namespace gridmorph::test {
namespace {

struct Expected {
  char const* name;
  double tolerance;  ///< of the smallest edge; the rotor and stator match to 5 % of a wall cell only
};

class RealPlot3d : public testing::TestWithParam<Expected> {};
INSTANTIATE_TEST_SUITE_P(Meshes, RealPlot3d,
                         testing::Values(Expected{"axial_turbine_stage_H", 0.01}, Expected{"water_turbine", 0.01},
                                         Expected{"slotted_airfoil", 0.01}, Expected{"axialTurbine_7blk", 0.01},
                                         Expected{"multi", 0.01}, Expected{"mdo_tutorial_000_vol", 0.01},
                                         Expected{"717_wl_L2", 0.01}, Expected{"rotorstator", 0.2}),
                         [](auto const& info) { return "mesh_" + std::string(info.param.name); });

TEST_P(RealPlot3d, InterfacesAndPeriodicityAreFoundAgain) {
  auto const cgns = shared_mesh(std::string(GetParam().name) + ".cgns");
  if (cgns.empty()) GTEST_SKIP() << GetParam().name << " is not there; its stand-in is tested";
  Mesh const known = read_mesh(cgns);
  TemporaryFolder const folder;
  write_bytes(folder.file("mesh.p3d"), Plot3dFile({}).bytes(known));
  Mesh mesh = read_mesh(folder.file("mesh.p3d"));
  expect_same_coordinates(mesh.coordinates, known.coordinates);

  // Bare: everything declared is among what is found.
  auto const bare = find_interfaces(mesh, {.tolerance = GetParam().tolerance}).interfaces;
  for (bool const periodic : {false, true}) {
    if (periodic && GetParam().tolerance > 0.1)
      continue;  // with so wide a tolerance its two planes are alike in more ways than one
    auto const found = joined_cells(mesh, bare, periodic), declared = joined_cells(known, known.interfaces, periodic);
    EXPECT_TRUE(std::includes(found.begin(), found.end(), declared.begin(), declared.end()))
        << (periodic ? "periodic: " : "plain: ") << found.size() << " found, " << declared.size() << " declared";
    RecordProperty(periodic ? "periodic" : "plain", int(found.size()));
  }
  // With the boundary known there is nothing else, and the CGNS mesh without its connections says the same.
  mesh.patches = known.patches;
  auto const again = find_interfaces(mesh, {.tolerance = GetParam().tolerance});
  auto const& found = again.interfaces;
  for (auto const& note : again.notes) RecordProperty("note", note);
  for (bool const periodic : {false, true}) {
    auto const joined = joined_cells(mesh, found, periodic), declared = joined_cells(known, known.interfaces, periodic);
    EXPECT_TRUE(std::includes(joined.begin(), joined.end(), declared.begin(), declared.end()));
    // The rotor and stator leave hundreds of face cells to nobody, and evenly spaced ones among them fit one another.
    if (periodic && GetParam().tolerance > 0.1) continue;
    EXPECT_EQ(joined.size(), declared.size()) << testing::PrintToString(again.notes);
  }
}

}  // namespace
}  // namespace gridmorph::test
