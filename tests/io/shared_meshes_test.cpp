// Real meshes, and stand-ins for those that may not be passed on: counts and matches as their descriptions state them.
#include "io_support.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/io/mesh_io.hpp>

#include <algorithm>
#include <numeric>

namespace gridmorph::test {
namespace {

struct Expected {
  char const* file;
  int zones;
  int interfaces;  ///< plain ones
  int periodic;
  Index nodes;
  double mismatch;           ///< of plain interfaces, as a length
  double periodic_mismatch;  ///< angles are declared in single precision
};

// Zones, interfaces and node counts as in the description of the meshes, or counted with another CGNS reader.
Expected const expected[] = {
    {"axial_turbine_stage_H.cgns", 2, 0, 8, 81 * 37 * 33 + 77 * 37 * 29, 0, 5e-9 * 1.08},
    {"water_turbine.cgns", 7, 8, 10, 6050, 1e-15, 5e-9},
    {"slotted_airfoil.cgns", 4, 16, 0, 58576, 0, 0},
    {"axialTurbine_7blk.cgns", 7, 8, 10, 6050, 1e-15, 5e-9},
    {"rotorstator.cgns", 14, 24, 4, 36748, 1.2e-5, 1.2e-5},
    {"mdo_tutorial_000_vol.cgns", 38, 146, 0, 36650, 0, 0},
    {"multi.cgns", 4, 16, 0, 58576, 0, 0},
    {"717_wl_L2.cgns", 5, 16, 0, 18753, 0, 0},
};

class SharedMesh : public testing::TestWithParam<Expected> {
 protected:
  void SetUp() override {
    path_ = shared_mesh(GetParam().file);
    if (path_.empty()) GTEST_SKIP() << GetParam().file << " is not there; its stand-in is tested";
  }
  std::string path_;
};

TEST_P(SharedMesh, HasTheZonesAndInterfacesItIsKnownFor) {
  Mesh const mesh = read_mesh(path_);
  EXPECT_EQ(int(mesh.zones.size()), GetParam().zones);
  auto const periodic = std::count_if(mesh.interfaces.begin(), mesh.interfaces.end(),
                                      [](auto const& i) { return i.periodic.has_value(); });
  EXPECT_EQ(periodic, GetParam().periodic);
  EXPECT_EQ(int(mesh.interfaces.size()) - periodic, GetParam().interfaces);
  EXPECT_EQ(mesh.n_nodes(), GetParam().nodes);
  EXPECT_EQ(mesh.dimension, 3);
  EXPECT_TRUE(mesh.notes.empty()) << mesh.notes.front();
}

TEST_P(SharedMesh, InterfaceNodesCoincide) {
  Mesh const mesh = read_mesh(path_);
  EXPECT_LE(largest_mismatch(mesh, false), GetParam().mismatch);
  EXPECT_LE(largest_mismatch(mesh, true), GetParam().periodic_mismatch);
}

TEST_P(SharedMesh, EveryInterfaceIsStoredFromBothSides) {
  Mesh const mesh = read_mesh(path_);
  for (auto const& face : mesh.interfaces) {
    bool const there = std::any_of(mesh.interfaces.begin(), mesh.interfaces.end(), [&](auto const& other) {
      return other.zone == face.donor_zone && other.donor_zone == face.zone &&
             other.range == face.to_donor(face.range) &&
             other.to_donor.orientation == face.to_donor.orientation.inverse();
    });
    EXPECT_TRUE(there) << face.name;
  }
}

// A step through an interface and on into the donor must lead away from the own zone.
TEST_P(SharedMesh, InterfaceMapsContinueIntoTheDonor) {
  Mesh const mesh = read_mesh(path_);
  for (auto const& face : mesh.interfaces) {
    auto const& zone = mesh.zones[face.zone];
    auto const& donor = mesh.zones[face.donor_zone];
    int normal = 0;
    while (face.range.extent(normal) != 1) ++normal;
    Index3 beyond = face.range.begin;
    beyond[normal] += face.range.begin[normal] == 0 ? -1 : 1;
    Index3 const there = face.to_donor(beyond);
    EXPECT_TRUE((IndexRange{{0, 0, 0}, donor.extent}.contains(there))) << zone.name << " " << face.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Meshes, SharedMesh, testing::ValuesIn(expected), [](auto const& info) {
  std::string name = info.param.file;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
  return name;
});

TEST(SharedMeshes, FamiliesAndSubRangesOfTheTurbineStage) {
  auto const path = shared_mesh("axial_turbine_stage_H.cgns");
  Mesh const mesh = read_mesh(path);
  ASSERT_EQ(mesh.patches.size(), 12U);
  EXPECT_EQ(mesh.families.size(), 7U);
  auto const& blade =
      *std::find_if(mesh.patches.begin(), mesh.patches.end(), [](auto const& p) { return p.name == "blade_ss"; });
  EXPECT_EQ(blade.range, (IndexRange{{28, 0, 32}, {65, 37, 33}}));
  EXPECT_EQ(blade.kind, PatchKind::wall);
  EXPECT_EQ(blade.bc_type, "BCWallViscous");
  EXPECT_EQ(blade.families, std::vector<std::string>{"BLADE1"});
}

TEST(StandIns, SlottedAirfoilIsWiredOnPartsOfFacesWithWakeCutsAndThinCells) {
  Mesh const mesh = read_mesh(shared_mesh("slotted_airfoil.cgns"));
  int cuts = 0;
  for (auto const& face : mesh.interfaces) {
    EXPECT_LT(face.range.extent(1), mesh.zones[face.zone].extent[1]) << face.name;
    cuts += face.zone == face.donor_zone ? 1 : 0;
  }
  EXPECT_EQ(cuts, 6);
  int walls = 0;
  double first = 1;
  for (auto const& patch : mesh.patches) {
    if (patch.kind != PatchKind::wall) continue;
    ++walls;
    Zone const& zone = mesh.zones[patch.zone];
    EXPECT_LT(patch.range.extent(1), zone.extent[1]);
    for (int j = patch.range.begin[1]; j < patch.range.end[1]; ++j)
      first = std::min(first, distance(mesh.coordinates[zone.node({0, j, 0})], mesh.coordinates[zone.node({0, j, 1})]));
  }
  EXPECT_EQ(walls, 3);
  EXPECT_LT(first, 3e-6);
}

TEST(StandIns, RowsOfTheWaterTurbineMeetAtMixingPlanesWithoutInterfaces) {
  Mesh const mesh = read_mesh(shared_mesh("water_turbine.cgns"));
  auto const row = [&](int zone) { return mesh.zones[zone].name.substr(0, 2); };
  for (auto const& face : mesh.interfaces) EXPECT_EQ(row(face.zone), row(face.donor_zone)) << face.name;
  std::vector<std::string> sides;
  for (auto const& patch : mesh.patches)
    if (patch.families == std::vector<std::string>{"MIXING"}) sides.push_back(row(patch.zone));
  std::sort(sides.begin(), sides.end());
  EXPECT_EQ(sides, (std::vector<std::string>{"DT", "GV", "RU", "RU"}));
}

TEST(SharedMeshes, OneReaderTakesBlocksAndElementsOfEveryFormat) {
  Mesh const coil = read_mesh(shared_mesh("heated_coil.cgns"));
  EXPECT_FALSE(coil.is_structured());
  EXPECT_GT(coil.n_elements(), 0);
  EXPECT_EQ(coil.n_cells(), 0);
  EXPECT_FALSE(coil.zones.front().is_block());
  Mesh const blade = read_mesh(shared_mesh("mesh_vki_turbine.su2"));
  EXPECT_FALSE(blade.is_structured());
  EXPECT_EQ(blade.dimension, 2);
  Mesh const turbine = read_mesh(shared_mesh("water_turbine.cgns"));
  EXPECT_TRUE(turbine.is_structured());
  EXPECT_EQ(turbine.n_elements(), 0);
  EXPECT_GT(turbine.n_cells(), 0);
}

}  // namespace
}  // namespace gridmorph::test
