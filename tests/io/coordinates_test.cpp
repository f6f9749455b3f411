// Coordinates in the many ways files keep them, and files that hold something else.
#include "io_support.hpp"
#include "mll_file.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/io/cgns/cgns_file.hpp>
#include <gridmorph/io/mesh_io.hpp>

#include <algorithm>
#include <limits>
#include <numbers>

namespace gridmorph::test {
namespace {

class CoordinatesInFiles : public testing::Test {
 protected:
  [[nodiscard]] std::string refusal() const {
    return message_of<IoError>([&] { read_mesh(path_); });
  }
  TemporaryFolder folder_;
  std::string const path_ = folder_.file("m.cgns");
};

TEST_F(CoordinatesInFiles, RindPlanesAreLeftOutOnReadingAndLeftAloneOnWriting) {
  for (char const* type : {"R8", "R4"}) {
    std::array<int, 3> const n{3, 4, 2};
    std::array<int, 6> const rind{1, 0, 0, 2, 1, 1};
    std::array<int, 3> const stored{4, 6, 4};
    auto const value = [](int c, int i, int j, int k) { return 1000 * (c + 1) + 100 * i + 10 * j + k; };
    {
      cgns::File file(path_, cgns::File::Mode::create);
      std::array<std::int32_t, 2> const dimensions{3, 3};
      double const base = file.create(file.root(), "Base", "CGNSBase_t", "I4", {2}, dimensions.data());
      std::array<std::int32_t, 9> const size{n[0], n[1], n[2], n[0] - 1, n[1] - 1, n[2] - 1, 0, 0, 0};
      double const zone = file.create(base, "Zone", "Zone_t", "I4", {3, 3}, size.data());
      file.create_text(zone, "ZoneType", "ZoneType_t", "Structured");
      double const grid = file.create(zone, "GridCoordinates", "GridCoordinates_t");
      file.create(grid, "Rind", "Rind_t", "I4", {6}, rind.data());
      for (int c = 0; c < 3; ++c) {
        std::vector<double> values;
        for (int k = 0; k < stored[2]; ++k)
          for (int j = 0; j < stored[1]; ++j)
            for (int i = 0; i < stored[0]; ++i) values.push_back(value(c, i - rind[0], j - rind[2], k - rind[4]));
        std::vector<float> const rounded(values.begin(), values.end());
        auto const name = std::string("Coordinate") + "XYZ"[c];
        file.create(grid, name, "DataArray_t", type, {stored[0], stored[1], stored[2]},
                    type[1] == '8' ? static_cast<void const*>(values.data()) : rounded.data());
      }
      file.close();
    }
    Mesh const mesh = read_mesh(path_);
    ASSERT_EQ(mesh.zones.at(0).extent, (Index3{3, 4, 2}));
    for (int k = 0; k < n[2]; ++k)
      for (int j = 0; j < n[1]; ++j)
        for (int i = 0; i < n[0]; ++i) {
          Vec3 const expected{double(value(0, i, j, k)), double(value(1, i, j, k)), double(value(2, i, j, k))};
          EXPECT_EQ(mesh.coordinates[mesh.zones[0].node({i, j, k})], expected);
        }
    auto const out = folder_.file("out.cgns");
    write_morphed(path_, out, mesh, mesh.coordinates);
    EXPECT_EQ(dump_tree(path_), dump_tree(out));
    Coordinates zero(mesh.n_nodes());
    for (Index m = 0; m < zero.size(); ++m) zero.set(m, {0, 0, 0});
    write_morphed(path_, out, mesh, zero);
    EXPECT_EQ(read_mesh(out).coordinates[5], (Vec3{0, 0, 0}));
    // 4 x 6 x 4 values stored, 3 x 4 x 2 of them nodes.
    auto const raw = payload(dump_tree(out).at("/Base/Zone/GridCoordinates/CoordinateX"));
    int zeros = 0;
    for (std::size_t at = 0; at < raw.size(); at += std::size_t(type[1] - '0'))
      zeros +=
          std::all_of(raw.begin() + long(at), raw.begin() + long(at) + (type[1] - '0'), [](char c) { return c == 0; });
    EXPECT_EQ(zeros, 24);
  }
}

TEST_F(CoordinatesInFiles, TheOriginalGridIsUsedAmongSeveral) {
  MllFile file(path_);
  int const zone = file.box("Zone", {3, 3, 3});
  int number = 0;
  MllFile::check(cg_grid_write(file.file(), file.base(), zone, "Grid#0002", &number));
  MllFile::check(cg_goto(file.file(), file.base(), "Zone_t", zone, "GridCoordinates_t", number, "end"));
  cgsize_t const size[3] = {3, 3, 3};
  std::vector<double> const other(27, 99.0);
  for (auto const* name : {"CoordinateX", "CoordinateY", "CoordinateZ"})
    MllFile::check(cg_array_write(name, CGNS_ENUMV(RealDouble), 3, size, other.data()));
  file.close();
  Mesh const mesh = read_mesh(path_);
  EXPECT_EQ(mesh.coordinates[26], (Vec3{2, 2, 2}));
  ASSERT_EQ(mesh.notes.size(), 1U);
  EXPECT_NE(mesh.notes[0].find("Grid#0002"), std::string::npos);
}

TEST_F(CoordinatesInFiles, NodesThatAreNotFiniteAreCountedPerZone) {
  {
    MllFile file(path_);
    file.box("Good", {3, 3, 3});
    file.box("Bad", {3, 4, 5});
    file.close();
  }
  {
    cgns::File file(path_, cgns::File::Mode::modify);
    auto const tree = file.tree();
    auto const& y = *tree.child("Base")->child("Bad")->child("GridCoordinates")->child("CoordinateY");
    auto values = file.reals(y);
    values[1 + 3 * (2 + 4 * 3)] = std::numeric_limits<double>::quiet_NaN();
    values[59] = std::numeric_limits<double>::infinity();
    file.write(y, values.data());
    file.close();
  }
  auto const message = message_of<MeshError>([&] { read_mesh(path_); });
  EXPECT_NE(message.find("2 nodes of zone 'Bad'"), std::string::npos) << message;
  EXPECT_NE(message.find("i 2, j 3, k 4"), std::string::npos) << message;
  EXPECT_EQ(message.find("Good"), std::string::npos) << message;
}

// The same plate, flat along each of the three index directions of 3-D zones, and lying in each coordinate plane.
TEST_F(CoordinatesInFiles, ZonesOneNodeThickAreTwoDimensional) {
  for (int flat = 0; flat < 3; ++flat) {
    SCOPED_TRACE(flat);
    std::array<int, 3> n{4, 3, 5};
    n[flat] = 1;
    int const along = flat == 0 ? 1 : 0;
    std::array<double, 3> origin{0, 0, 0};
    origin[along] = n[along] - 1;
    MllFile file(path_);
    int const a = file.box("A", n);
    file.box("B", n, origin);
    std::array<cgsize_t, 6> range{1, 1, 1, n[0], n[1], n[2]}, donor = range;
    range[along] = n[along];
    donor[along + 3] = 1;
    file.one_to_one(a, "joint", "B", range, donor, {1, 2, 3});
    std::vector<cgsize_t> edge{1, 1, 1, n[0], n[1], n[2]};
    edge[along + 3] = 1;
    file.bc(a, "edge", CGNS_ENUMV(BCWall), CGNS_ENUMV(PointRange), edge);
    file.bc(a, "plate", CGNS_ENUMV(BCSymmetryPlane), CGNS_ENUMV(PointRange), {1, 1, 1, n[0], n[1], n[2]});
    file.close();
    Mesh const mesh = read_mesh(path_);
    EXPECT_EQ(mesh.dimension, 2);
    Index3 extent{n[0], n[1], n[2]};
    extent[flat] = 2;
    EXPECT_EQ(mesh.zones[0].extent, extent);
    EXPECT_EQ(largest_mismatch(mesh, false), 0.0);
    ASSERT_EQ(mesh.interfaces.size(), 1U);
    EXPECT_EQ(mesh.interfaces[0].range.extent(flat), 2);
    ASSERT_EQ(mesh.patches.size(), 5U);  // the edge and two planes per zone; the plate is noted
    EXPECT_EQ(mesh.patches[0].range.extent(flat), 2);
    EXPECT_EQ(std::count_if(mesh.patches.begin(), mesh.patches.end(),
                            [](auto const& p) { return p.name == "2-D plane" && p.kind == PatchKind::symmetry; }),
              4);
    // Unit cells: the second plane is one unit away along the missing direction.
    Index3 above{1, 1, 1}, below{1, 1, 1};
    below[flat] = 0;
    Vec3 const step = mesh.coordinates[mesh.zones[0].node(above)] - mesh.coordinates[mesh.zones[0].node(below)];
    EXPECT_EQ(step, (Vec3{flat == 0 ? 1.0 : 0.0, flat == 1 ? 1.0 : 0.0, flat == 2 ? 1.0 : 0.0}));
    auto const out = folder_.file("out.cgns");
    write_morphed(path_, out, mesh, mesh.coordinates);
    EXPECT_EQ(dump_tree(path_), dump_tree(out));
  }
}

TEST_F(CoordinatesInFiles, FilesThatHoldSomethingElseAreRefusedWithTheReason) {
  {
    MllFile file(path_);
    file.box("Cylindrical", {3, 3, 3}, {1, 0, 0}, {"CoordinateR", "CoordinateTheta", "CoordinateZ"});
    file.close();
    EXPECT_NE(refusal().find("cylindrical coordinates are not supported"), std::string::npos);
  }
  {
    MllFile file(path_);
    file.close();
    EXPECT_NE(refusal().find("no Zone_t"), std::string::npos);
  }
  {
    MllFile file(path_);
    file.box("Thick", {3, 3, 3});
    file.box("Thin", {3, 3, 1});
    file.close();
    EXPECT_NE(refusal().find("mixes 2-D zones (one node plane: 'Thin')"), std::string::npos);
  }
  {
    MllFile file(path_);
    file.box("Line", {3, 1, 1});
    file.box("Also a line", {1, 1, 9});
    file.close();
    auto const message = refusal();
    EXPECT_NE(message.find("'Line': has one node along two"), std::string::npos) << message;
    EXPECT_NE(message.find("'Also a line'"), std::string::npos) << message;
  }
  {
    MllFile file(path_);
    int zone = 0;
    cgsize_t const size[9] = {3, 3, 3, 2, 2, 2, 0, 0, 0};
    MllFile::check(cg_zone_write(file.file(), file.base(), "Empty", size, CGNS_ENUMV(Structured), &zone));
    file.close();
    EXPECT_NE(refusal().find("'Empty': has no GridCoordinates_t"), std::string::npos);
  }
}

TEST_F(CoordinatesInFiles, CoordinatesInAnotherFileAreReadButNotChanged) {
  {
    MllFile file(folder_.file("grid.cgns"));
    file.box("Zone", {3, 3, 3});
    file.close();
    MllFile linking(path_);
    cgsize_t const size[9] = {3, 3, 3, 2, 2, 2, 0, 0, 0};
    int zone = 0;
    MllFile::check(cg_zone_write(linking.file(), linking.base(), "Zone", size, CGNS_ENUMV(Structured), &zone));
    MllFile::check(cg_goto(linking.file(), linking.base(), "Zone_t", zone, "end"));
    MllFile::check(cg_link_write("GridCoordinates", "grid.cgns", "/Base/Zone/GridCoordinates"));
    linking.close();
  }
  Mesh const mesh = read_mesh(path_);
  EXPECT_EQ(mesh.coordinates[26], (Vec3{2, 2, 2}));
  auto const before = bytes_of(folder_.file("grid.cgns"));
  auto const message =
      message_of<IoError>([&] { write_morphed(path_, folder_.file("out.cgns"), mesh, mesh.coordinates); });
  EXPECT_NE(message.find("is a link"), std::string::npos) << message;
  EXPECT_EQ(bytes_of(folder_.file("grid.cgns")), before);
  EXPECT_FALSE(std::filesystem::exists(folder_.file("out.cgns")));
}

TEST_F(CoordinatesInFiles, TopologyCanBeReadWithoutCoordinates) {
  MllFile file(path_);
  file.box("Zone", {3, 3, 3});
  file.close();
  Mesh const mesh = read_mesh(path_, {.coordinates = false});
  EXPECT_EQ(mesh.n_nodes(), 27);
  EXPECT_EQ(mesh.coordinates.size(), 0);
}

}  // namespace
}  // namespace gridmorph::test
