// Connections in the many ways files write them.
#include "block_lattice.hpp"
#include "io_support.hpp"
#include "mll_file.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/io/cgns/cgns_file.hpp>
#include <gridmorph/io/mesh_io.hpp>

#include <algorithm>
#include <functional>
#include <numbers>

namespace gridmorph::test {
namespace {

class Connections : public testing::Test {
 protected:
  /// Calls change(file, connection node) for every 1-to-1 interface of the file.
  void edit(std::function<void(cgns::File&, cgns::Node const&)> const& change) const {
    cgns::File file(path_, cgns::File::Mode::modify);
    auto const tree = file.tree();
    for (auto const* base : tree.all("CGNSBase_t"))
      for (auto const* zone : base->all("Zone_t"))
        for (auto const* connectivity : zone->all("ZoneGridConnectivity_t"))
          for (auto const& node : connectivity->children) change(file, node);
    file.close();
  }

  static std::vector<std::int32_t> integers(cgns::File const& file, cgns::Node const& node) {
    auto const values = file.integers(node);
    return {values.begin(), values.end()};
  }

  static bool noted(Mesh const& mesh, std::string const& what) {
    return std::any_of(mesh.notes.begin(), mesh.notes.end(),
                       [&](auto const& n) { return n.find(what) != std::string::npos; });
  }

  static void expect_same_interfaces(Mesh const& a, Mesh const& b) {
    ASSERT_EQ(a.interfaces.size(), b.interfaces.size());
    for (std::size_t n = 0; n < a.interfaces.size(); ++n) {
      EXPECT_EQ(a.interfaces[n].range, b.interfaces[n].range);
      EXPECT_EQ(a.interfaces[n].to_donor.orientation, b.interfaces[n].to_donor.orientation);
      EXPECT_EQ(a.interfaces[n].to_donor.own_origin, b.interfaces[n].to_donor.own_origin);
      EXPECT_EQ(a.interfaces[n].to_donor.donor_origin, b.interfaces[n].to_donor.donor_origin);
    }
  }

  TemporaryFolder folder_;
  std::string const path_ = folder_.file("m.cgns");
  Lattice const brick_{{{{0, 3, 7}, {0, 2, 5}, {0, 4, 6}}}};
};

TEST_F(Connections, RangesMayRunBackwardsAlongAnyAxis) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    write_mesh(path_, LatticeBuilder(brick_, seed).build());
    Mesh const before = read_mesh(path_);
    std::mt19937 random(seed);
    edit([&](cgns::File& file, cgns::Node const& node) {
      auto own = integers(file, *node.child("PointRange")), donor = integers(file, *node.child("PointRangeDonor"));
      auto const transform = integers(file, *node.child("Transform"));
      for (int a = 0; a < 3; ++a) {
        if (random() % 2 == 0) continue;
        int const d = std::abs(transform[a]) - 1;
        std::swap(own[a], own[a + 3]);
        std::swap(donor[d], donor[d + 3]);
      }
      file.write(*node.child("PointRange"), own.data());
      file.write(*node.child("PointRangeDonor"), donor.data());
    });
    Mesh const after = read_mesh(path_);
    expect_same_interfaces(before, after);
    EXPECT_EQ(largest_mismatch(after, false), 0.0);
    EXPECT_TRUE(after.notes.empty());
  }
}

TEST_F(Connections, AZeroInTransformIsRebuiltAndTheNormalSignDoesNotMatter) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    write_mesh(path_, LatticeBuilder(brick_, seed).build());
    Mesh const before = read_mesh(path_);
    std::mt19937 random(seed);
    edit([&](cgns::File& file, cgns::Node const& node) {
      auto const own = integers(file, *node.child("PointRange"));
      auto transform = integers(file, *node.child("Transform"));
      int const normal = own[0] == own[3] ? 0 : own[1] == own[4] ? 1 : 2;
      switch (random() % 3) {
        case 0: transform[normal] = 0; break;
        case 1: transform[normal] = -transform[normal]; break;
        default: transform[random() % 3] = 0;
      }
      file.write(*node.child("Transform"), transform.data());
    });
    expect_same_interfaces(before, read_mesh(path_));
  }
}

TEST_F(Connections, DonorRangesWrittenAscendingAreUnderstood) {
  write_mesh(path_, LatticeBuilder(brick_, 3).build());
  Mesh const before = read_mesh(path_);
  edit([&](cgns::File& file, cgns::Node const& node) {
    auto donor = integers(file, *node.child("PointRangeDonor"));
    for (int a = 0; a < 3; ++a)
      if (donor[a] > donor[a + 3]) std::swap(donor[a], donor[a + 3]);
    file.write(*node.child("PointRangeDonor"), donor.data());
  });
  Mesh const after = read_mesh(path_);
  expect_same_interfaces(before, after);
  EXPECT_TRUE(noted(after, "without direction"));
}

TEST_F(Connections, TwoDimensionalFilesHaveTheirFreedomsToo) {
  Lattice lattice{{{{0, 3, 7}, {0, 4, 6}, {0, 1}}}};
  lattice.two_dimensional = true;
  write_mesh(path_, LatticeBuilder(lattice, 3).build());
  Mesh const before = read_mesh(path_);
  ASSERT_EQ(before.interfaces.size(), 8U);
  edit([&](cgns::File& file, cgns::Node const& node) {
    auto own = integers(file, *node.child("PointRange")), donor = integers(file, *node.child("PointRangeDonor"));
    std::swap_ranges(own.begin(), own.begin() + 2, own.begin() + 2);
    std::swap_ranges(donor.begin(), donor.begin() + 2, donor.begin() + 2);
    file.write(*node.child("PointRange"), own.data());
    file.write(*node.child("PointRangeDonor"), donor.data());
  });
  expect_same_interfaces(before, read_mesh(path_));
}

TEST_F(Connections, EverythingWrongIsReportedAtOnceWithItsPlace) {
  MllFile file(path_);
  int const a = file.box("A", {4, 3, 5});
  file.box("B", {4, 3, 5}, {3, 0, 0});
  // The library refuses to write most of what is wrong, so the values are put into its file afterwards.
  struct Wrong {
    char const* interface;
    char const* node;
    std::vector<std::int64_t> values;
  };
  Wrong const all[] = {{"too far", "PointRange", {4, 1, 1, 4, 3, 9}},
                       {"donor too far", "PointRangeDonor", {1, 1, 1, 1, 9, 5}},
                       {"twice the same axis", "Transform", {1, 2, 2}},
                       {"other shape", "PointRangeDonor", {1, 1, 1, 1, 3, 4}},
                       {"turned", "Transform", {1, 3, 2}},
                       {"normal to side", "Transform", {2, 1, 3}},
                       {"inside", "PointRange", {2, 1, 1, 2, 3, 5}}};
  file.one_to_one(a, "unknown donor", "Nobody", {4, 1, 1, 4, 3, 5}, {1, 1, 1, 1, 3, 5}, {1, 2, 3});
  for (auto const& w : all) file.one_to_one(a, w.interface, "B", {4, 1, 1, 4, 3, 5}, {1, 1, 1, 1, 3, 5}, {1, 2, 3});
  file.close();
  edit([&](cgns::File& edited, cgns::Node const& node) {
    for (auto const& w : all) {
      if (node.name != w.interface) continue;
      auto const& child = *node.child(w.node);
      std::vector<std::int32_t> const narrow(w.values.begin(), w.values.end());
      edited.write(child, edited.type(child) == "I8" ? static_cast<void const*>(w.values.data()) : narrow.data());
    }
  });
  auto const message = message_of<MeshError>([&] { read_mesh(path_); });
  for (auto const* part :
       {"interface 'unknown donor': range [4:4, 1:3, 1:5] names donor zone 'Nobody'", "(zones: 'A', 'B')",
        "interface 'too far': range [4:4, 1:3, 1:9] is outside zone 'A', which is [1:4, 1:3, 1:5]",
        "interface 'donor too far': donor range [1:1, 1:9, 1:5] is outside zone 'B'", "'twice the same axis'",
        "[1, 2, 2]", "not a signed permutation", "'other shape'", "'turned'", "another shape", "'normal to side'",
        "carries the face normal i to j", "'inside'", "not on a face"})
    EXPECT_NE(message.find(part), std::string::npos) << part << "\n" << message;
  EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 7) << message;
}

TEST_F(Connections, AnglesFollowTheUnitsOfTheFile) {
  for (bool const declared : {true, false}) {
    MllFile file(path_);
    int const zone = file.box("A", {3, 3, 3});
    if (declared) {
      MllFile::check(cg_goto(file.file(), file.base(), "end"));
      MllFile::check(cg_dataclass_write(CGNS_ENUMV(Dimensional)));
      MllFile::check(cg_units_write(CGNS_ENUMV(Kilogram), CGNS_ENUMV(Meter), CGNS_ENUMV(Second), CGNS_ENUMV(Kelvin),
                                    CGNS_ENUMV(Degree)));
    }
    int const number = file.one_to_one(zone, "per", "A", {1, 1, 1, 1, 3, 3}, {3, 1, 1, 3, 3, 3}, {1, 2, 3});
    float const center[3] = {1, 2, 3}, angle[3] = {0, 0, 36}, translation[3] = {0, 0, 5};
    MllFile::check(cg_1to1_periodic_write(file.file(), file.base(), zone, number, center, angle, translation));
    file.close();
    Mesh const mesh = read_mesh(path_);
    ASSERT_TRUE(mesh.interfaces.at(0).periodic);
    auto const& periodic = *mesh.interfaces[0].periodic;
    double const turn = std::numbers::pi / 5;
    EXPECT_NEAR(periodic.rotation_angle_rad.z, turn, 1e-7);
    Vec3 const expected{1 + std::cos(turn), 2 + std::sin(turn), 12};
    EXPECT_LT(distance(periodic.declared(Vec3{2, 2, 7}), expected), 1e-6);
    EXPECT_EQ(noted(mesh, "taken as degrees"), !declared);
  }
}

TEST_F(Connections, AnglesTurnAboutXThenYThenZ) {
  MllFile file(path_);
  int const zone = file.box("A", {3, 3, 3});
  int const number = file.one_to_one(zone, "per", "A", {1, 1, 1, 1, 3, 3}, {3, 1, 1, 3, 3, 3}, {1, 2, 3});
  float const quarter = float(std::numbers::pi / 2), center[3] = {0, 0, 0}, angle[3] = {quarter, quarter, 0},
              translation[3] = {0, 0, 0};
  MllFile::check(cg_1to1_periodic_write(file.file(), file.base(), zone, number, center, angle, translation));
  file.close();
  Mesh const mesh = read_mesh(path_);
  // y to z about x, then z to x about y; z to -y about x, where y stays.
  EXPECT_LT(distance(mesh.interfaces.at(0).periodic->declared(Vec3{0, 1, 0}), Vec3{1, 0, 0}), 1e-6);
  EXPECT_LT(distance(mesh.interfaces[0].periodic->declared(Vec3{0, 0, 1}), Vec3{0, -1, 0}), 1e-6);
}

class GeneralConnections : public Connections {
 protected:
  int connect(MllFile& file, int zone, char const* name, CGNS_ENUMT(GridConnectivityType_t) type,
              CGNS_ENUMT(GridLocation_t) location, CGNS_ENUMT(PointSetType_t) set, std::vector<cgsize_t> const& points,
              std::vector<cgsize_t> const& donor_points) {
    int number = 0;
    MllFile::check(cg_conn_write(file.file(), file.base(), zone, name, location, type, set, cgsize_t(points.size()) / 3,
                                 points.data(), "B", CGNS_ENUMV(Structured), CGNS_ENUMV(PointListDonor),
                                 CGNS_ENUMV(DataTypeNull), cgsize_t(donor_points.size()) / 3, donor_points.data(),
                                 &number));
    return number;
  }
};

// Zone A ends at x = 3 with nodes (4, j, k); zone B starts there, with its j and k swapped and j running down.
TEST_F(GeneralConnections, MatchingListsBecomeInterfaces) {
  MllFile file(path_);
  int const a = file.box("A", {4, 3, 5});
  file.box("B", {4, 5, 3}, {3, 0, 0});
  std::vector<cgsize_t> nodes, donors, faces, donor_faces;
  for (int k = 1; k <= 5; ++k)
    for (int j = 1; j <= 3; ++j) {
      nodes.insert(nodes.end(), {4, j, k});
      donors.insert(donors.end(), {1, 6 - k, j});
      if (j == 3 || k == 5) continue;
      faces.insert(faces.end(), {4, j, k});
      donor_faces.insert(donor_faces.end(), {1, 5 - k, j});
    }
  connect(file, a, "nodes", CGNS_ENUMV(Abutting1to1), CGNS_ENUMV(Vertex), CGNS_ENUMV(PointList), nodes, donors);
  connect(file, a, "faces", CGNS_ENUMV(Abutting1to1), CGNS_ENUMV(FaceCenter), CGNS_ENUMV(PointList), faces,
          donor_faces);
  connect(file, a, "range", CGNS_ENUMV(Abutting1to1), CGNS_ENUMV(Vertex), CGNS_ENUMV(PointRange), {4, 1, 1, 4, 3, 5},
          donors);
  file.close();
  Mesh const mesh = read_mesh(path_);
  EXPECT_TRUE(mesh.patches.empty());
  ASSERT_EQ(mesh.interfaces.size(), 3U);
  for (auto const& face : mesh.interfaces) {
    SCOPED_TRACE(face.name);
    EXPECT_EQ(face.range, (IndexRange{{3, 0, 0}, {4, 3, 5}}));
    EXPECT_EQ(face.to_donor(Index3{3, 0, 0}), (Index3{0, 4, 0}));
    EXPECT_EQ(face.to_donor(Index3{3, 2, 4}), (Index3{0, 0, 2}));
    EXPECT_EQ(face.to_donor(Index3{4, 0, 0}), (Index3{1, 4, 0}));
  }
}

TEST_F(GeneralConnections, OthersBecomePatchesOfTheirOwnNames) {
  MllFile file(path_);
  int const a = file.box("A", {4, 3, 5});
  file.box("B", {4, 5, 3}, {3, 0, 0});
  std::vector<cgsize_t> const face{4, 1, 1, 4, 3, 5}, some{1, 1, 1, 1, 2, 1};
  connect(file, a, "sliding", CGNS_ENUMV(Abutting), CGNS_ENUMV(Vertex), CGNS_ENUMV(PointRange), face, some);
  connect(file, a, "plane overset", CGNS_ENUMV(Overset), CGNS_ENUMV(Vertex), CGNS_ENUMV(PointRange), face, some);
  connect(file, a, "overlap", CGNS_ENUMV(Abutting), CGNS_ENUMV(FaceCenter), CGNS_ENUMV(PointRange), {1, 1, 1, 1, 2, 4},
          some);
  connect(file, a, "fringe", CGNS_ENUMV(Overset), CGNS_ENUMV(CellCenter), CGNS_ENUMV(PointList),
          {1, 1, 1, 2, 2, 2, 3, 1, 4}, some);
  std::vector<cgsize_t> scrambled;
  for (int n = 0; n < 15; ++n) scrambled.insert(scrambled.end(), {1, 1 + (7 * n % 15) % 5, 1 + (7 * n % 15) / 5});
  connect(file, a, "scrambled", CGNS_ENUMV(Abutting1to1), CGNS_ENUMV(Vertex), CGNS_ENUMV(PointRange), face, scrambled);
  file.close();
  Mesh const mesh = read_mesh(path_);
  EXPECT_TRUE(mesh.interfaces.empty());
  ASSERT_EQ(mesh.patches.size(), 4U);
  for (auto const& patch : mesh.patches) EXPECT_EQ(patch.kind, PatchKind::connection);
  EXPECT_EQ(mesh.patches[0].name, "sliding");
  EXPECT_EQ(mesh.patches[0].bc_type, "Abutting");
  EXPECT_EQ(mesh.patches[0].range, (IndexRange{{3, 0, 0}, {4, 3, 5}}));
  EXPECT_EQ(mesh.patches[1].name, "plane overset");
  EXPECT_EQ(mesh.patches[1].bc_type, "Overset");
  EXPECT_EQ(mesh.patches[2].name, "overlap");
  EXPECT_EQ(mesh.patches[2].range, (IndexRange{{0, 0, 0}, {1, 3, 5}}));
  EXPECT_EQ(mesh.patches[3].name, "scrambled");
  EXPECT_TRUE(noted(mesh, "'fringe'"));
  EXPECT_TRUE(noted(mesh, "'scrambled'"));
}

}  // namespace
}  // namespace gridmorph::test
