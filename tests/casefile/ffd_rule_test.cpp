// The keys of rule = "ffd", its tables and its lattices in files.
#include "case_text.hpp"

#include <fstream>

namespace gridmorph::test {
namespace {

FfdRule ffd_of(std::string const& lines) { return std::get<FfdRule>(rule_of("rule = \"ffd\"\n" + lines)); }

std::vector<std::string> ffd_problems(std::string const& lines) {
  return problems_of(case_with_rule("rule = \"ffd\"\n" + lines));
}

void write(std::filesystem::path const& file, std::string const& text) { std::ofstream(file) << text; }

/// A lattice of 2 x 2 x 3 control points as PLOT3D: the box of [0, 1] x [0, 2] x [0, 4], moved.
std::string lattice_text(Vec3 const& by, double lift = 0) {
  std::string x, y, z;
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 2; ++i) {
        x += std::to_string(by.x + i) + " ";
        y += std::to_string(by.y + 2 * j) + " ";
        z += std::to_string(by.z + 2 * k + (k == 1 && i == 1 ? lift : 0)) + " ";
      }
  return "1\n2 2 3\n" + x + "\n" + y + "\n" + z + "\n";
}

TEST(FfdRuleText, DisplacesGroupsOfControlPointsWhichAddUp) {
  FfdRule const rule = ffd_of(
      "counts = [4, 3, 2]\nbox = { from = [0, 0, 0], to = [1, 2, 3] }\ncontinuity = 2\nopen_faces = [\"i-min\", "
      "\"k-max\"]\n"
      "points = [ { at = [4, [2, 3], \"all\"], d = [0, 0, 1] }, { at = [4, 2, 1], d = [0.5, 0, 0] } ]");
  EXPECT_EQ(rule.counts, (std::array<int, 3>{4, 3, 2}));
  EXPECT_EQ(rule.degree, (std::array<int, 3>{3, 2, 1}));
  EXPECT_EQ(rule.continuity, 2);
  EXPECT_EQ(rule.open, (std::array<bool, 6>{true, false, false, false, false, true}));
  ASSERT_TRUE(rule.box);
  EXPECT_EQ(rule.box->edges[1], (Vec3{0, 2, 0}));
  int moved = 0;
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 4; ++i) {
        Vec3 const d = rule.displacement[rule.number(i, j, k)];
        Vec3 const expected = i == 3 && j == 1 && k == 0 ? Vec3{0.5, 0, 1} : i == 3 && j >= 1 ? Vec3{0, 0, 1} : Vec3{};
        EXPECT_EQ(d, expected);
        moved += d == Vec3{} ? 0 : 1;
      }
  EXPECT_EQ(moved, 4);
}

TEST(FfdRuleText, MovesControlPointsRigidlyFromWhereTheyAre) {
  FfdRule const rule = ffd_of(
      "counts = [2, 2, 3]\nbox = { origin = [1, 0, 0], i = [2, 0, 0], j = [0, 1, 0], k = [0, 0, 4] }\n"
      "points = { at = [\"all\", 1, 3], scale = { factor = 2, origin = [1, 0, 0] }, rotation = { axis = [0, 0, 1], "
      "origin "
      "= [1, 0, 0], angle_deg = 90 }, translation = [0, 0, 1] }");
  EXPECT_VEC3_NEAR(rule.displacement[rule.number(0, 0, 2)], (Vec3{0, 0, 5}),
                   1e-15);  // at (1, 0, 4): z doubled, then one up
  EXPECT_VEC3_NEAR(rule.displacement[rule.number(1, 0, 2)], (Vec3{-2, 4, 5}), 1e-15);
  EXPECT_EQ(rule.displacement[rule.number(1, 1, 2)], Vec3{});
}

TEST(FfdRuleText, DegreesAreBernsteinOrAsGivenAndAmplitudesShares) {
  std::string const rest = "counts = [6, 3, 1]\npoints = { at = [1, 1, 1], d = [1, 0, 0] }\n";
  EXPECT_EQ(ffd_of(rest).degree, (std::array<int, 3>{5, 2, 0}));
  EXPECT_EQ(ffd_of(rest + "degree = 3").degree, (std::array<int, 3>{3, 2, 0}));
  EXPECT_EQ(ffd_of(rest + "degree = [4, 1, 0]").degree, (std::array<int, 3>{4, 1, 0}));
  EXPECT_EQ(ffd_of(rest).share, 1);
  EXPECT_EQ(ffd_of(rest + "amplitude = 0.25").share, 0.25);
  EXPECT_EQ(ffd_of(rest).margin, 0.05);
  EXPECT_FALSE(ffd_of(rest + "margin = 0.5").box);
}

TEST(FfdRuleText, ReadsTablesAndLattices) {
  TemporaryFolder const folder;
  write(folder / "points.csv", "# comment\nk, j, i, dx, dy, dz\n3, 1, 2, 0.5, 0, -1\n1, 2, 1, 1, 2, 3\n");
  write(folder / "lattice.xyz", lattice_text({5, 0, 0}));
  write(folder / "deformed.xyz", lattice_text({5, 0, 0.25}, 0.5));
  auto const read = [&](std::string const& lines) {
    return std::get<FfdRule>(
        parse_case_file(case_with_rule("rule = \"ffd\"\n" + lines), (folder / "case.toml").string())
            .motion.rules.at(0)
            .rule);
  };
  FfdRule const table = read("counts = [2, 2, 3]\nfile = \"points.csv\"");
  EXPECT_EQ(table.displacement[table.number(1, 0, 2)], (Vec3{0.5, 0, -1}));
  EXPECT_EQ(table.displacement[table.number(0, 1, 0)], (Vec3{1, 2, 3}));
  FfdRule const lattice = read("lattice = \"lattice.xyz\"\ndeformed = \"deformed.xyz\"");
  EXPECT_EQ(lattice.counts, (std::array<int, 3>{2, 2, 3}));
  EXPECT_EQ(lattice.points[lattice.number(1, 1, 2)], (Vec3{6, 2, 4}));
  EXPECT_VEC3_NEAR(lattice.displacement[lattice.number(0, 1, 1)], (Vec3{0, 0, 0.25}), 1e-6);
  EXPECT_VEC3_NEAR(lattice.displacement[lattice.number(1, 1, 1)], (Vec3{0, 0, 0.75}), 1e-6);
  FfdRule const box =
      read("counts = [2, 2, 3]\nbox = { from = [5, 0, 0], to = [6, 2, 4] }\ndeformed = \"deformed.xyz\"");
  for (std::size_t n = 0; n < box.size(); ++n) EXPECT_VEC3_NEAR(box.displacement[n], lattice.displacement[n], 1e-6);
}

TEST(FfdRuleErrors, NameTheLineAndTheRemedy) {
  std::string const counts = "counts = [4, 2, 2]\n", point = "points = { at = [1, 1, 1], d = [1, 0, 0] }\n";
  EXPECT_TRUE(reported(ffd_problems(point), "case.toml:5: ", {"counts"}));
  EXPECT_TRUE(reported(ffd_problems(counts), "case.toml:7: ", {"displaces no control point", "points", "file"}));
  EXPECT_TRUE(reported(ffd_problems("counts = [4, 2]\n" + point), "case.toml:8: ", {"three whole numbers"}));
  EXPECT_TRUE(reported(ffd_problems(counts + "points = { at = [5, 1, 1], d = [1, 0, 0] }"),
                       "case.toml:9: ", {"at", "4 x 2 x 2 control points"}));
  EXPECT_TRUE(
      reported(ffd_problems(counts + "points = { at = [0, 1, 1], d = [1, 0, 0] }"), "case.toml:9: ", {"from 1"}));
  EXPECT_TRUE(
      reported(ffd_problems(counts + "points = { at = [[3, 2], 1, 1], d = [1, 0, 0] }"), "case.toml:9: ", {"at"}));
  EXPECT_TRUE(reported(ffd_problems(counts + "points = { at = [1, 1, 1] }"), "case.toml:9: ", {"needs d"}));
  EXPECT_TRUE(reported(ffd_problems(counts + "points = { at = [1, 1, 1], translation = [1, 0, 0] }"),
                       "case.toml:9: ", {"box or a lattice"}));
  EXPECT_TRUE(reported(ffd_problems(counts + point + "open_faces = \"i-mim\""), "case.toml:10: ", {"i-min"}));
  EXPECT_TRUE(reported(ffd_problems(counts + point + "continuity = 3"), "case.toml:7: ", {"continuity 3"}));
  EXPECT_TRUE(
      reported(ffd_problems(counts + point + "degree = [4, 1, 1]"), "case.toml:7: ", {"degree 4 along i", "1 to 3"}));
  EXPECT_TRUE(
      reported(ffd_problems(counts + point + "box = { from = [0, 0, 0], to = [1, 0, 1] }"), "case.toml:10: ", {"box"}));
  EXPECT_TRUE(reported(
      ffd_problems(counts + point + "box = { origin = [0, 0, 0], i = [1, 0, 0], j = [2, 0, 0], k = [0, 0, 1] }"),
      "case.toml:7: ", {"span no volume"}));
  EXPECT_TRUE(
      reported(ffd_problems(counts + point + "box = { origin = [0, 0, 0] }"), "case.toml:10: ", {"i = [x, y, z]"}));
  EXPECT_TRUE(reported(ffd_problems(counts + point + "box = { from = [0, 0, 0], to = [1, 1, 1] }\nmargin = 0.1"),
                       "case.toml:11: ", {"margin", "around the patches"}));
  EXPECT_TRUE(
      reported(ffd_problems("counts = [2000, 2000, 2000]\n" + point), "case.toml:7: ", {"control points", "1000000"}));
  EXPECT_TRUE(reported(ffd_problems(counts + "file = \"none.csv\""), "case.toml:9: ", {"none.csv"}));
  // All in one pass.
  auto const many =
      ffd_problems(counts + "points = [ { at = [9, 1, 1], d = [1, 0, 0] }, { at = [1, 1, 1] } ]\nopen_faces = \"x\"");
  EXPECT_EQ(many.size(), 3u);
}

TEST(FfdRuleErrors, OfTablesAndLatticesNameFileAndLine) {
  TemporaryFolder const folder;
  auto const problems = [&](std::string const& lines) {
    return error_lines(
        [&] { (void)parse_case_file(case_with_rule("rule = \"ffd\"\n" + lines), (folder / "case.toml").string()); });
  };
  write(folder / "points.csv",
        "i, j, k, dx, dy, dz\n1, 1, 1, 0, 0, 0\n1, 1, 3, 0, 0, 0\n1.5, 1, 1, 0, 0, 0\n1, 1, 1, 0, nan, 0\n");
  auto const lines = problems("counts = [2, 2, 2]\nfile = \"points.csv\"");
  std::string all;
  for (auto const& line : lines) all += line + "\n";
  for (char const* part :
       {"points.csv:3: k = \"3\"", "1 to 2", "points.csv:4: i = \"1.5\"", "points.csv:5: dy = \"nan\""})
    EXPECT_NE(all.find(part), std::string::npos) << part << " in\n" << all;
  write(folder / "twice.csv", "i, j, k, dx, dy, dz\n1, 1, 1, 0, 0, 0\n1, 1, 1, 0, 0, 1\n");
  EXPECT_NE(
      problems("counts = [2, 2, 2]\nfile = \"twice.csv\"").at(0).find("twice.csv:3: control point (1, 1, 1) has a"),
      std::string::npos);
  write(folder / "lattice.xyz", lattice_text({5, 0, 0}));
  EXPECT_NE(problems("counts = [2, 2, 2]\nbox = { from = [0, 0, 0], to = [1, 1, 1] }\ndeformed = \"lattice.xyz\"")
                .at(0)
                .find("2 x 2 x 3 control points, and the lattice has 2 x 2 x 2"),
            std::string::npos);
  write(
      folder / "two.xyz", "2\n2 2 2 2 2 2\n" + [] {
        std::string text;
        for (int n = 0; n < 48; ++n) text += std::to_string(n) + " ";
        return text;
      }());
  EXPECT_NE(problems("lattice = \"two.xyz\"\npoints = { at = [1, 1, 1], d = [1, 0, 0] }").at(0).find("2 blocks"),
            std::string::npos);
}

}  // namespace
}  // namespace gridmorph::test
