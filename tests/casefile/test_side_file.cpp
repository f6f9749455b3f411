// Side files: what they add to a mesh, what they refuse, and that what is written is read.
#include "case_text.hpp"
#include "support/interface_cells.hpp"
#include "support/mesh_builders.hpp"
#include "support/scramble.hpp"

#include <gridmorph/casefile/side_file.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/topology/coverage.hpp>

namespace gridmorph::testing {
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
}  // namespace gridmorph::testing
