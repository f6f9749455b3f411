// What is written is read back as it was, and other readers of CGNS files see the same.
#include "block_lattice.hpp"
#include "io_support.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/io/mesh_io.hpp>

#include <cgnslib.h>
#include <gtest/gtest.h>

#include <set>
#include <tuple>

namespace gridmorph::test {
namespace {

void expect_same_mesh(Mesh const& a, Mesh const& b) {
  ASSERT_EQ(a.zones.size(), b.zones.size());
  for (std::size_t z = 0; z < a.zones.size(); ++z) {
    EXPECT_EQ(a.zones[z].name, b.zones[z].name);
    EXPECT_EQ(a.zones[z].extent, b.zones[z].extent);
    EXPECT_EQ(a.zones[z].first_node, b.zones[z].first_node);
    EXPECT_EQ(a.zones[z].single_precision, b.zones[z].single_precision);
  }
  ASSERT_EQ(a.interfaces.size(), b.interfaces.size());
  for (std::size_t n = 0; n < a.interfaces.size(); ++n) {
    auto const &p = a.interfaces[n], &q = b.interfaces[n];
    SCOPED_TRACE(p.name);
    EXPECT_EQ(p.name, q.name);
    EXPECT_EQ(p.zone, q.zone);
    EXPECT_EQ(p.donor_zone, q.donor_zone);
    EXPECT_EQ(p.range, q.range);
    EXPECT_EQ(p.to_donor.orientation, q.to_donor.orientation);
    EXPECT_EQ(p.to_donor(p.range.begin), q.to_donor(p.range.begin));
    EXPECT_EQ(q.to_donor.own_origin, q.range.begin);
    ASSERT_EQ(p.periodic.has_value(), q.periodic.has_value());
    if (p.periodic) {
      for (Vec3 const x : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0.3, 0.2, 1}})
        EXPECT_LT(distance(p.periodic->declared(x), q.periodic->declared(x)), 1e-7);
    }
  }
  EXPECT_EQ(a.dimension, b.dimension);
}

using PatchKey = std::tuple<int, std::string, std::string, PatchKind, std::vector<std::string>, Index3, Index3>;
std::multiset<PatchKey> keys(Mesh const& mesh) {
  std::multiset<PatchKey> out;
  for (auto const& p : mesh.patches)
    out.insert({p.zone, p.name, p.bc_type, p.kind, p.families, p.range.begin, p.range.end});
  return out;
}

class RoundTrip : public testing::TestWithParam<FileFormat> {
 protected:
  TemporaryFolder folder_;
};

TEST_P(RoundTrip, BlocksInAnyOrientationComeBackExactly) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(seed);
    Mesh const mesh = LatticeBuilder({{{{0, 3, 7}, {0, 2, 5}, {0, 4, 6}}}}, seed).build();
    ASSERT_EQ(largest_mismatch(mesh, false), 0.0);
    auto const path = folder_.file("blocks.cgns");
    write_mesh(path, mesh, {.format = GetParam()});
    Mesh const back = read_mesh(path);
    expect_same_mesh(mesh, back);
    EXPECT_EQ(keys(mesh), keys(back));
    expect_same_coordinates(mesh.coordinates, back.coordinates);
    EXPECT_TRUE(back.notes.empty()) << back.notes.front();
  }
}

TEST_P(RoundTrip, PeriodicInterfacesKeepTheirRotation) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    Lattice lattice{{{{0, 3, 7}, {0, 4}, {0, 2, 5}}}};
    lattice.periodic = true;
    Mesh const mesh = LatticeBuilder(lattice, seed).build();
    ASSERT_LT(largest_mismatch(mesh, true), 1e-14);
    auto const path = folder_.file("periodic.cgns");
    write_mesh(path, mesh, {.format = GetParam()});
    Mesh const back = read_mesh(path);
    expect_same_mesh(mesh, back);
    EXPECT_EQ(largest_mismatch(back, false), 0.0);
    EXPECT_LT(largest_mismatch(back, true), 1e-7);  // the file carries the angle in single precision
  }
}

TEST_P(RoundTrip, SinglePrecisionStaysSinglePrecision) {
  Lattice lattice{{{{0, 3, 7}, {0, 4}, {0, 2, 5}}}};
  lattice.single_precision = true;
  Mesh const mesh = LatticeBuilder(lattice, 5).build();
  auto const path = folder_.file("single.cgns");
  write_mesh(path, mesh, {.format = GetParam()});
  Mesh const back = read_mesh(path);
  expect_same_mesh(mesh, back);
  expect_same_coordinates(mesh.coordinates, back.coordinates);
}

TEST_P(RoundTrip, TwoDimensionalMeshesGetTheirSecondPlaneBack) {
  for (int physical : {2, 3}) {
    Lattice lattice{{{{0, 3, 7}, {0, 4, 6}, {0, 1}}}};
    lattice.two_dimensional = true;
    Mesh const mesh = LatticeBuilder(lattice, 3).build();
    auto const path = folder_.file("plane.cgns");
    write_mesh(path, mesh, {.format = GetParam(), .physical_dimension = physical});
    Mesh const back = read_mesh(path);
    expect_same_mesh(mesh, back);
    EXPECT_EQ(keys(mesh), keys(back));
    EXPECT_EQ(largest_mismatch(back, false), 0.0);
    double const thickness = back.coordinates.z(back.zones[0].node({0, 0, 1}));
    EXPECT_NEAR(thickness, std::sqrt(2.0 / 42), 0.2 * std::sqrt(2.0 / 42));  // an area of about 2 in 7 x 6 cells
    for (auto const& zone : back.zones)
      for (int j = 0; j < zone.extent[1]; ++j)
        for (int i = 0; i < zone.extent[0]; ++i) {
          Vec3 const below = back.coordinates[zone.node({i, j, 0})], above = back.coordinates[zone.node({i, j, 1})];
          EXPECT_EQ(below, mesh.coordinates[zone.node({i, j, 0})]);
          EXPECT_EQ(above, (Vec3{below.x, below.y, thickness}));
        }
  }
}

TEST_P(RoundTrip, SeveralBasesKeepTheirZonesApart) {
  Mesh mesh = LatticeBuilder({{{{0, 3, 5}, {0, 2}, {0, 2}}}}, 2).build();
  mesh.zones[0].name = "Stator/Zone 1";
  mesh.zones[1].name = "Rotor/Zone 1";
  auto const path = folder_.file("bases.cgns");
  write_mesh(path, mesh, {.format = GetParam()});
  expect_same_mesh(mesh, read_mesh(path));
}

INSTANTIATE_TEST_SUITE_P(Formats, RoundTrip, testing::Values(FileFormat::cgns_hdf5, FileFormat::cgns_adf),
                         [](auto const& info) {
                           return std::string(info.param == FileFormat::cgns_hdf5 ? "hdf5" : "adf");
                         });

TEST(WriteMesh, PatchesOnPartsOfFacesAndSharedNamesComeBack) {
  Mesh mesh = LatticeBuilder({{{{0, 6}, {0, 4}, {0, 3}}}}, 1).build();
  mesh.patches.clear();
  mesh.patches.push_back({"part", "BCWall", PatchKind::wall, {"Group/Part", "More"}, 0, {{0, 0, 0}, {1, 3, 2}}});
  mesh.patches.push_back({"part", "BCInflow", PatchKind::inflow, {}, 0, {{0, 2, 0}, {1, 5, 4}}});
  mesh.patches.push_back({"sliding",
                          "Abutting",
                          PatchKind::connection,
                          {},
                          0,
                          {{mesh.zones[0].extent[0] - 1, 0, 0}, mesh.zones[0].extent}});
  for (auto& p : mesh.patches)
    for (int a = 0; a < 3; ++a) p.range.end[a] = std::min(p.range.end[a], mesh.zones[0].extent[a]);
  TemporaryFolder const folder;
  write_mesh(folder.file("m.cgns"), mesh);
  Mesh const back = read_mesh(folder.file("m.cgns"));
  ASSERT_EQ(back.patches.size(), 3U);
  EXPECT_EQ(back.patches[0].name, "part");
  EXPECT_EQ(back.patches[0].families, (std::vector<std::string>{"Group/Part", "More"}));
  EXPECT_EQ(back.patches[0].bc_type, "BCWall");
  EXPECT_EQ(back.patches[1].name, "part_2");
  EXPECT_EQ(back.patches[1].bc_type, "BCInflow");
  EXPECT_EQ(back.patches[2].bc_type, "UserDefined");
  for (int p = 0; p < 3; ++p) EXPECT_EQ(back.patches[p].range, mesh.patches[p].range);
  EXPECT_EQ(back.families, (std::vector<std::string>{"Group", "Group/Part", "More"}));
}

TEST(WriteMesh, TheMidLevelLibraryReadsTheSameFile) {
  Lattice lattice{{{{0, 3, 7}, {0, 4}, {0, 2, 5}}}};
  lattice.periodic = true;
  Mesh const mesh = LatticeBuilder(lattice, 11).build();
  TemporaryFolder const folder;
  write_mesh(folder.file("m.cgns"), mesh);
  int file = 0;
  ASSERT_EQ(cg_open(folder.file("m.cgns").c_str(), CG_MODE_READ, &file), CG_OK) << cg_get_error();
  int zones = 0;
  cg_nzones(file, 1, &zones);
  ASSERT_EQ(zones, int(mesh.zones.size()));
  std::size_t patches = 0, interfaces = 0;
  for (int z = 1; z <= zones; ++z) {
    char name[33], donor[33];
    cgsize_t size[9], range[6], donor_range[6];
    cg_zone_read(file, 1, z, name, size);
    EXPECT_EQ(name, mesh.zones[z - 1].name);
    for (int a = 0; a < 3; ++a) EXPECT_EQ(size[a], mesh.zones[z - 1].extent[a]);
    std::vector<double> y(mesh.zones[z - 1].size());
    cgsize_t const one[3] = {1, 1, 1};
    ASSERT_EQ(cg_coord_read(file, 1, z, "CoordinateY", CGNS_ENUMV(RealDouble), one, size, y.data()), CG_OK);
    EXPECT_EQ(
        std::memcmp(y.data(), mesh.coordinates.y.data() + mesh.zones[z - 1].first_node, y.size() * sizeof(double)), 0);
    int count = 0;
    cg_nbocos(file, 1, z, &count);
    patches += std::size_t(count);
    cg_n1to1(file, 1, z, &count);
    for (int c = 1; c <= count; ++c) {
      int transform[3];
      ASSERT_EQ(cg_1to1_read(file, 1, z, c, name, donor, range, donor_range, transform), CG_OK);
      auto const& face = mesh.interfaces[interfaces++];
      EXPECT_EQ(donor, mesh.zones[face.donor_zone].name);
      for (int a = 0; a < 3; ++a) {
        auto const& o = face.to_donor.orientation;
        EXPECT_EQ(transform[a], o.sign[a] * (o.axis[a] + 1));
        EXPECT_EQ(range[a], face.range.begin[a] + 1);
        EXPECT_EQ(range[a + 3], face.range.end[a]);
      }
      float center[3], turn[3], translation[3];
      int const has = cg_1to1_periodic_read(file, 1, z, c, center, turn, translation);
      EXPECT_EQ(has == CG_OK, face.periodic.has_value());
      if (has == CG_OK && face.periodic) {
        EXPECT_EQ(turn[2], float(face.periodic->rotation_angle_rad.z));
      }
    }
  }
  EXPECT_EQ(patches, mesh.patches.size());
  EXPECT_EQ(interfaces, mesh.interfaces.size());
  int families = 0;
  cg_nfamilies(file, 1, &families);
  EXPECT_EQ(families, 3);  // Walls, y_low wall, y_high wall
  cg_close(file);
}

}  // namespace
}  // namespace gridmorph::test
