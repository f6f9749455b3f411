// Side files: what they add to a mesh, what they refuse, and that what is written is read.
#include "case_text.hpp"
#include "support/expect_error.hpp"
#include "support/interface_cells.hpp"
#include "support/mesh_builders.hpp"
#include "support/scramble.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/boundary/coverage.hpp>
#include <gridmorph/case/side_file.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

namespace gridmorph::test {
namespace {

Mesh bare(Mesh mesh) {
  mesh.interfaces.clear();
  mesh.patches.clear();
  mesh.families.clear();
  return mesh;
}

std::vector<std::string> side_problems(std::string const& text, Mesh mesh) {
  return error_lines([&] { add_side_file(text, "mesh.toml", mesh); });
}

TEST(SideFile, WhatIsWrittenIsReadAndCoversTheMesh) {
  for (auto const& make :
       {+[](unsigned s) { return test::bricks_with_t_junctions(s); },
        +[](unsigned s) { return test::annulus_sector({}, s); }, +[](unsigned s) { return test::c_grid(s); },
        +[](unsigned s) { return test::translational(1, s); }})
    for (unsigned seed = 1; seed < 5; ++seed) {
      Mesh const known = test::scramble(make(seed), {.seed = seed, .cuts = 2}).mesh;
      Mesh mesh = bare(known);
      mesh.patches = known.patches;  // nothing but what is periodic by intention
      FoundInterfaces const found = find_interfaces(mesh);
      Mesh read = bare(known);
      Mesh const nothing = bare(known);
      add_side_file(side_file_text(nothing, found), "mesh.toml", read);
      for (bool const periodic : {false, true})
        EXPECT_EQ(test::joined_cells(read, read.interfaces, periodic),
                  test::joined_cells(known, known.interfaces, periodic));
      EXPECT_TRUE(test::flaws(read, 1e-6).empty()) << test::flaws(read, 1e-6).front();
      EXPECT_NO_THROW(connect_and_check(read, {}));
    }
}

/// Four boxes round a square hole: the hole is one body, the outside has six sides.
TEST(SideFile, OpenFacesThatContinueOneAnotherHaveOneName) {
  test::MeshBuilder builder("frame");
  for (auto const& [x, y, nx, ny] : {std::array{0, 0, 4, 1}, {0, 1, 1, 2}, {3, 1, 1, 2}, {0, 3, 4, 1}})
    builder.zone("z" + std::to_string(x) + std::to_string(y), {2 * nx + 1, 2 * ny + 1, 5}, [x, y](Index3 const& p) {
      return Vec3{x + 0.5 * p[0], y + 0.5 * p[1], 0.4 * p[2]};
    });
  Mesh mesh = builder.finish();
  Mesh read = mesh;
  add_side_file(side_file_text(mesh, find_interfaces(mesh)), "mesh.toml", read);
  std::map<std::string, Index> area;  // in cells
  for (auto const& patch : read.patches) {
    Index cells = 1;
    for (int a = 0; a < 3; ++a) cells *= std::max(1, patch.range.extent(a) - 1);
    area[patch.name] += cells;
  }
  std::map<std::string, Index> const expected{{"body", 4 * 4 * 4}, {"x_min", 8 * 4}, {"x_max", 8 * 4},
                                              {"y_min", 8 * 4},    {"y_max", 8 * 4}, {"z_min", 64 - 16},
                                              {"z_max", 64 - 16}};
  EXPECT_EQ(area, expected) << ::testing::PrintToString(find_interfaces(mesh).notes);
}

/// SU2 files keep periodic pairs in the solver's configuration, and say nothing of kinds.
TEST(SideFile, SaysKindsAndPeriodicPairsOfMarkers) {
  Mesh const mesh = test::flat_box(3, 2, 2);  // 3 wide, 2 high
  auto const text = [](double pitch) {
    return "[[patch]]\nname = \"i_min\"\nkind = \"inflow\"\nfamily = \"ends\"\n[[periodic]]\nname = \"pitch\"\n" +
           fmt::format("translation = [0, {}, 0]\n", pitch) +
           "[[interface]]\npatch = \"j_min\"\ndonor_patch = \"j_max\"\nperiodic = \"pitch\"\n";
  };
  for (double const sense : {1.0, -1.0}) {  // either side may be named first
    Mesh read = mesh;
    add_side_file(text(2 * sense), "mesh.toml", read);
    ASSERT_EQ(read.connections.size(), 1u);
    EXPECT_EQ(read.connections[0].nodes.size(), 4u);
    EXPECT_EQ(largest_mismatch(read, read.connections[0]), 0);
    for (auto const& patch : read.patches)
      if (patch.name == "i_min") {
        EXPECT_EQ(patch.families, (std::vector<std::string>{"ends"}));
        EXPECT_EQ(patch.kind, PatchKind::inflow);
      }
  }
  auto const message = test::message_of<ConfigError>([&] {
    Mesh read = mesh;
    add_side_file(text(5) + "[[patch]]\nname = \"k_min\"\n", "mesh.toml", read);
  });
  for (auto const* part : {"mesh.toml:9", "4 of its 4 nodes", "mesh.toml:13", "'k_min'"})
    EXPECT_NE(message.find(part), std::string::npos) << message;
}

TEST(SideFile, SaysPatchesFamiliesAndZoneNames) {
  Mesh mesh = bare(test::box({4, 5, 6}, test::Shape::straight, 1));
  add_side_file(
      "zone_names = [\"passage\"]\n"
      "[[patch]]\nname = \"ps\"\nfamily = [\"blade\", \"moving\"]\nkind = \"wall\"\nzone = \"passage\"\nface = "
      "\"i_max\"\n"
      "[[patch]]\nname = \"in\"\nkind = \"inflow\"\nzone = 1\nrange = [[4, 1, 1], [1, 1, 3]]\n",
      "mesh.toml", mesh);
  ASSERT_EQ(mesh.patches.size(), 2u);
  EXPECT_EQ(mesh.zones[0].name, "passage");
  EXPECT_EQ(mesh.patches[0].families, (std::vector<std::string>{"blade", "moving"}));
  EXPECT_EQ(mesh.families, (std::vector<std::string>{"blade", "moving"}));
  EXPECT_EQ(mesh.patches[0].kind, PatchKind::wall);
  EXPECT_EQ(mesh.patches[0].range, (IndexRange{{3, 0, 0}, {4, 5, 6}}));
  EXPECT_EQ(mesh.patches[1].range, (IndexRange{{0, 0, 0}, {4, 1, 3}}));
}

TEST(SideFile, EveryProblemIsReportedWithItsLine) {
  Mesh const mesh = bare(test::box({4, 5, 6}, test::Shape::straight, 1));
  auto const lines = side_problems(
      "zone_names = [\"a\", \"b\"]\n"
      "[[patch]]\nname = \"p\"\nzone = 2\nface = \"i_min\"\n"
      "[[patch]]\nname = \"p\"\nzone = 1\nface = \"i_mid\"\n"
      "[[patch]]\nname = \"p\"\nzone = 1\nrange = [[1, 1, 1], [1, 6, 6]]\n"
      "[[patch]]\nname = \"p\"\nzone = 1\nrange = [[2, 1, 1], [2, 5, 6]]\n"
      "[[interface]]\nzone = 1\nface = \"i_min\"\ndonor_zone = 1\ndonor_face = \"j_max\"\ntransform = [1, 2, 3]\n"
      "[[interface]]\nzone = 1\nface = \"i_min\"\ndonor_zone = 1\ndonor_face = \"i_max\"\ntransform = [1, 2, 2]\n"
      "[[periodic]]\nname = \"x\"\nangle_deg = 3\n"
      "[[ptach]]\n",
      mesh);
  EXPECT_TRUE(reported(lines, "mesh.toml:1", {"zone_names", "2 names", "1 zones"}));
  EXPECT_TRUE(reported(lines, "mesh.toml:4", {"no zone 2"}));
  EXPECT_TRUE(reported(lines, "mesh.toml:9", {"i_mid", "i_min"}));
  EXPECT_TRUE(reported(lines, "mesh.toml:13", {"no part of one face", "[1:4, 1:5, 1:6]"}));
  EXPECT_TRUE(reported(lines, "mesh.toml:17", {"no part of one face"}));
  EXPECT_TRUE(reported(lines, "mesh.toml:23", {"does not carry"}));
  EXPECT_TRUE(reported(lines, "mesh.toml:29", {"1, 2 and 3 in some order"}));
  EXPECT_TRUE(reported(lines, "mesh.toml:30", {"axis and angle_deg"}));
  EXPECT_TRUE(reported(lines, "mesh.toml:33", {"unknown key 'ptach'", "patch"}));
}

TEST(SideFile, IsTheFileOfTheSameNameUnlessThatIsACaseFile) {
  TemporaryFolder const folder;
  EXPECT_FALSE(find_side_file(folder.path("wing.p3d")));
  folder.write("wing.toml", "[mesh]\ninput = \"wing.p3d\"\n");
  EXPECT_FALSE(find_side_file(folder.path("wing.p3d")));
  folder.write("wing.toml", "format = \"binary\"\n");
  EXPECT_EQ(find_side_file(folder.path("wing.p3d")), folder.path("wing.toml"));
}

}  // namespace
}  // namespace gridmorph::test
