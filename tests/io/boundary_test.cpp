// Boundary conditions in the many ways files write them.
#include "io_support.hpp"
#include "mll_file.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/io/cgns/cgns_file.hpp>
#include <gridmorph/io/mesh_io.hpp>

#include <algorithm>
#include <array>
#include <optional>

namespace gridmorph::test {
namespace {

Patch const* find_patch(Mesh const& mesh, std::string const& name) {
  auto const found =
      std::find_if(mesh.patches.begin(), mesh.patches.end(), [&](auto const& p) { return p.name == name; });
  return found == mesh.patches.end() ? nullptr : &*found;
}

bool noted(Mesh const& mesh, std::string const& name, std::string const& what) {
  return std::any_of(mesh.notes.begin(), mesh.notes.end(), [&](auto const& n) {
    return n.find("'" + name + "'") != std::string::npos && n.find(what) != std::string::npos;
  });
}

class Boundary : public testing::Test {
 protected:
  TemporaryFolder folder_;
  std::string const path_ = folder_.file("m.cgns");
};

TEST_F(Boundary, RangesOfNodesAndFacesMeanTheSamePatch) {
  struct Case {
    char const* name;
    CGNS_ENUMT(GridLocation_t) location;
    std::vector<cgsize_t> range;
    std::optional<IndexRange> expected;
  };
  // Zone of 5 x 4 x 3 nodes.
  IndexRange const i_max{{4, 0, 0}, {5, 4, 3}}, k_part{{1, 1, 0}, {4, 3, 1}}, strip{{1, 0, 0}, {4, 1, 2}};
  Case const cases[] = {
      {"nodes", CGNS_ENUMV(Vertex), {5, 1, 1, 5, 4, 3}, i_max},
      {"nodes backwards", CGNS_ENUMV(Vertex), {5, 4, 1, 5, 1, 3}, i_max},
      {"faces", CGNS_ENUMV(FaceCenter), {5, 1, 1, 5, 3, 2}, i_max},
      {"i faces", CGNS_ENUMV(IFaceCenter), {5, 1, 1, 5, 3, 2}, i_max},
      {"faces backwards", CGNS_ENUMV(FaceCenter), {5, 3, 2, 5, 1, 1}, i_max},
      {"nodes called faces", CGNS_ENUMV(FaceCenter), {5, 1, 1, 5, 4, 3}, i_max},
      {"part", CGNS_ENUMV(Vertex), {2, 2, 1, 4, 3, 1}, k_part},
      {"part in faces", CGNS_ENUMV(KFaceCenter), {2, 2, 1, 3, 2, 1}, k_part},
      {"strip", CGNS_ENUMV(JFaceCenter), {2, 1, 1, 3, 1, 1}, strip},
      {"strip without direction", CGNS_ENUMV(FaceCenter), {2, 1, 1, 3, 1, 1}, std::nullopt},
      {"volume", CGNS_ENUMV(Vertex), {1, 1, 1, 5, 4, 3}, std::nullopt},
      {"inside", CGNS_ENUMV(Vertex), {3, 1, 1, 3, 4, 3}, std::nullopt},
      {"line", CGNS_ENUMV(Vertex), {1, 1, 1, 5, 1, 1}, std::nullopt},
      {"point", CGNS_ENUMV(Vertex), {1, 1, 1, 1, 1, 1}, std::nullopt},
      {"cells", CGNS_ENUMV(CellCenter), {1, 1, 1, 1, 3, 2}, std::nullopt},
  };
  MllFile file(path_);
  int const zone = file.box("Zone", {5, 4, 3});
  for (auto const& c : cases) file.bc(zone, c.name, CGNS_ENUMV(BCWall), CGNS_ENUMV(PointRange), c.range, c.location);
  file.close();
  Mesh const mesh = read_mesh(path_);
  for (auto const& c : cases) {
    SCOPED_TRACE(c.name);
    auto const* patch = find_patch(mesh, c.name);
    ASSERT_EQ(patch != nullptr, c.expected.has_value());
    if (patch) {
      EXPECT_EQ(patch->range, *c.expected);
      EXPECT_EQ(patch->kind, PatchKind::wall);
    } else {
      EXPECT_TRUE(noted(mesh, c.name, "skipped"));
    }
  }
}

TEST_F(Boundary, PointListsThatFillAFaceRectangleBecomeRanges) {
  MllFile file(path_);
  int const zone = file.box("Zone", {4, 3, 3});
  std::vector<cgsize_t> nodes, faces, hole;
  for (int k = 3; k >= 1; --k)  // any order
    for (int j = 1; j <= 3; ++j) {
      nodes.insert(nodes.end(), {1, j, k});
      if (j < 3 && k < 3) faces.insert(faces.end(), {4, j, k});
      if (j != 2 || k != 2) hole.insert(hole.end(), {1, j, k});
    }
  file.bc(zone, "nodes", CGNS_ENUMV(BCInflow), CGNS_ENUMV(PointList), nodes);
  file.bc(zone, "faces", CGNS_ENUMV(BCOutflow), CGNS_ENUMV(PointList), faces, CGNS_ENUMV(FaceCenter));
  file.bc(zone, "hole", CGNS_ENUMV(BCWall), CGNS_ENUMV(PointList), hole);
  file.close();
  Mesh const mesh = read_mesh(path_);
  ASSERT_TRUE(find_patch(mesh, "nodes") && find_patch(mesh, "faces"));
  EXPECT_EQ(find_patch(mesh, "nodes")->range, (IndexRange{{0, 0, 0}, {1, 3, 3}}));
  EXPECT_EQ(find_patch(mesh, "faces")->range, (IndexRange{{3, 0, 0}, {4, 3, 3}}));
  EXPECT_EQ(find_patch(mesh, "hole"), nullptr);
  EXPECT_TRUE(noted(mesh, "hole", "does not fill"));
}

TEST_F(Boundary, ElementRangesOfOldFilesAreFacesUnlessTheyReachTheLastNode) {
  {
    MllFile file(path_);
    file.box("Zone", {5, 4, 3});
    file.close();
  }
  {
    // The library writes ElementRange no more, so the nodes are put into the tree one by one.
    cgns::File file(path_, cgns::File::Mode::modify);
    auto const tree = file.tree();
    double const zone_bc = file.create(file.id(*tree.child("Base")->child("Zone")), "ZoneBC", "ZoneBC_t");
    auto const add = [&](char const* name, std::array<std::int32_t, 6> const& range) {
      file.create(file.create_text(zone_bc, name, "BC_t", "BCWall"), "ElementRange", "IndexRange_t", "I4", {3, 2},
                  range.data());
    };
    add("faces", {1, 1, 1, 1, 3, 2});
    add("part", {1, 1, 1, 1, 2, 2});
    add("nodes", {1, 1, 1, 1, 4, 3});
    file.close();
  }
  Mesh const mesh = read_mesh(path_);
  EXPECT_EQ(find_patch(mesh, "faces")->range, (IndexRange{{0, 0, 0}, {1, 4, 3}}));
  EXPECT_EQ(find_patch(mesh, "part")->range, (IndexRange{{0, 0, 0}, {1, 3, 3}}));
  EXPECT_EQ(find_patch(mesh, "nodes")->range, (IndexRange{{0, 0, 0}, {1, 4, 3}}));
}

TEST_F(Boundary, FamiliesGiveTheirType) {
  MllFile file(path_);
  int const zone = file.box("Zone", {3, 3, 3});
  int family = 0, number = 0;
  MllFile::check(cg_family_write(file.file(), file.base(), "Blade", &family));
  MllFile::check(cg_fambc_write(file.file(), file.base(), family, "FamBC", CGNS_ENUMV(BCWallViscous), &number));
  MllFile::check(cg_family_write(file.file(), file.base(), "Untyped", &family));
  auto const with_family = [&](char const* name, char const* family_name, std::vector<cgsize_t> const& range) {
    int const bc = file.bc(zone, name, CGNS_ENUMV(FamilySpecified), CGNS_ENUMV(PointRange), range);
    MllFile::check(cg_goto(file.file(), file.base(), "Zone_t", zone, "ZoneBC_t", 1, "BC_t", bc, "end"));
    MllFile::check(cg_famname_write(family_name));
  };
  with_family("ss", "Blade", {1, 1, 1, 1, 3, 3});
  MllFile::check(cg_multifam_write("also", "Rotor"));
  with_family("untyped", "Untyped", {3, 1, 1, 3, 3, 3});
  with_family("nowhere", "Nowhere", {1, 1, 1, 3, 1, 3});
  file.close();
  Mesh const mesh = read_mesh(path_);
  EXPECT_EQ(find_patch(mesh, "ss")->bc_type, "BCWallViscous");
  EXPECT_EQ(find_patch(mesh, "ss")->kind, PatchKind::wall);
  EXPECT_EQ(find_patch(mesh, "ss")->families, (std::vector<std::string>{"Blade", "Rotor"}));
  for (auto const* name : {"untyped", "nowhere"}) {
    EXPECT_EQ(find_patch(mesh, name)->kind, PatchKind::other);
    EXPECT_TRUE(noted(mesh, name, "FamilySpecified"));
  }
  EXPECT_EQ(mesh.families, (std::vector<std::string>{"Blade", "Untyped"}));
}

TEST_F(Boundary, FamilyTreesAreFollowedByTheirPaths) {
  Mesh mesh;
  {
    MllFile file(path_);
    int const zone = file.box("Zone", {3, 3, 3});
    file.bc(zone, "leaf", CGNS_ENUMV(FamilySpecified), CGNS_ENUMV(PointRange), {1, 1, 1, 1, 3, 3});
    file.bc(zone, "with base", CGNS_ENUMV(FamilySpecified), CGNS_ENUMV(PointRange), {3, 1, 1, 3, 3, 3});
    file.close();
  }
  {
    cgns::File file(path_, cgns::File::Mode::modify);
    auto const tree = file.tree();
    auto const& base = *tree.child("Base");
    double const row = file.create(file.id(base), "Row 1", "Family_t");
    file.create_text(row, "FamilyBC", "FamilyBC_t", "BCWall");
    double const blade = file.create(row, "Blade", "Family_t");
    file.create_text(file.create(blade, "Inlet", "Family_t"), "FamilyBC", "FamilyBC_t", "BCInflow");
    auto const& bcs = *base.child("Zone")->child("ZoneBC");
    file.create_text(file.id(*bcs.child("leaf")), "FamilyName", "FamilyName_t", "Row 1/Blade");
    file.create_text(file.id(*bcs.child("with base")), "FamilyName", "FamilyName_t", "Base/Row 1/Blade/Inlet");
    file.close();
  }
  mesh = read_mesh(path_);
  EXPECT_EQ(find_patch(mesh, "leaf")->bc_type, "BCWall");  // of the family above
  EXPECT_EQ(find_patch(mesh, "with base")->bc_type, "BCInflow");
  EXPECT_EQ(mesh.families, (std::vector<std::string>{"Row 1", "Row 1/Blade", "Row 1/Blade/Inlet"}));
}

TEST_F(Boundary, RangesOutOfBoundsAreAllReportedAtOnce) {
  MllFile file(path_);
  int const zone = file.box("Zone", {5, 4, 3});
  file.bc(zone, "too long", CGNS_ENUMV(BCWall), CGNS_ENUMV(PointRange), {1, 1, 1, 1, 5, 3});
  file.bc(zone, "zero", CGNS_ENUMV(BCWall), CGNS_ENUMV(PointRange), {0, 1, 1, 0, 4, 3});
  file.bc(zone, "list", CGNS_ENUMV(BCWall), CGNS_ENUMV(PointList), {1, 1, 1, 1, 1, 99});
  file.close();
  auto const message = message_of<MeshError>([&] { read_mesh(path_); });
  for (auto const* part :
       {"m.cgns", "zone 'Zone'", "BC 'too long'", "[1:1, 1:5, 1:3]", "[1:5, 1:4, 1:3]", "BC 'zero'", "BC 'list'"})
    EXPECT_NE(message.find(part), std::string::npos) << part << "\n" << message;
  EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 2);
}

}  // namespace
}  // namespace gridmorph::test
