// The keys of rule = "target" and the text files it reads.
#include <gtest/gtest.h>
#include <gridmorph/case/case_file.hpp>
#include <gridmorph/case/target_file.hpp>
#include <gridmorph/core/error.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

#include "support/expect_error.hpp"

namespace gridmorph::test {
namespace {

class TargetKeys : public ::testing::Test {
 protected:
  TargetKeys() {
    std::filesystem::create_directories(folder_);
    write("t.stl",
          "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n");
    write("s.csv", "0,0,0\n1,1,0\n2,0,0\n1,-1,0\n0.5,-0.5,0\n\n0,0,5\n1,1,5\n2,0,5\n1,-1,5\n0.5,-0.5,5\n");
  }
  ~TargetKeys() override { std::filesystem::remove_all(folder_); }
  void write(std::string const& name, std::string const& text) const { std::ofstream(folder_ / name) << text; }
  [[nodiscard]] CaseFile parse(std::string const& keys, std::string const& mesh = "") const {
    return parse_case_file(
        "[mesh]\ninput = \"m.cgns\"\n" + mesh + "\n[[motion]]\npatches = \"w\"\nrule = \"target\"\n" + keys,
        folder_ / "case.toml");
  }
  [[nodiscard]] std::string problems(std::string const& keys, std::string const& mesh = "") const {
    return message_of<ConfigError>([&] { static_cast<void>(parse(keys, mesh)); });
  }
  static TargetRule const& rule(CaseFile const& c) { return std::get<TargetRule>(c.motion.rules.at(0).rule); }

  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("gridmorph_target_" + std::to_string(::getpid()) + "_" +
                                                ::testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(TargetKeys, AnStlSurfaceWithItsDefaults) {
  CaseFile const c = parse("file = \"t.stl\"\nlength_scale = 0.5\ncrease_angle_deg = 25");
  EXPECT_EQ(rule(c).target->triangles.size(), 1u);
  EXPECT_EQ(rule(c).target->points[1].x, 0.5);
  EXPECT_EQ(rule(c).crease_angle_deg, 25);
  EXPECT_EQ(rule(c).mapping, TargetRule::Mapping::automatic);
}

TEST_F(TargetKeys, SectionsAlongADirectionOrAwayFromTheAxis) {
  TargetRule const wing = rule(parse("file = \"s.csv\"\nspan = \"z\"\nspan_match = \"position\"\nflow = [0, 1, 0]"));
  EXPECT_EQ(wing.target->sections.size(), 2u);
  EXPECT_TRUE(*wing.span == (Vec3{0, 0, 1}));
  EXPECT_TRUE(wing.flow == (Vec3{0, 1, 0}));
  EXPECT_EQ(wing.span_match, TargetRule::SpanMatch::position);
  TargetRule const blade = rule(parse("file = \"s.csv\"", "axis = \"y\""));
  EXPECT_FALSE(blade.span);
  EXPECT_TRUE(blade.flow == (Vec3{0, 1, 0}));
}

TEST_F(TargetKeys, NodesComeFromTextToo) {
  EXPECT_EQ(rule(parse("file = \"s.csv\"\nmapping = \"nodes\"")).target->nodes.size(), 10u);
}

TEST_F(TargetKeys, ProblemsCarryTheirLine) {
  expect_all_in(problems("factor = 2"), {"case.toml:4:", "'file' is missing", "case.toml:7:", "'factor'"});
  expect_all_in(problems("file = \"none.stl\""), {"case.toml:7:", "none.stl", "no such file"});
  expect_all_in(problems("file = \"t.stl\"\nspan = \"z\""),
                {"case.toml:8:", "span", "belongs to targets given by sections"});
  expect_all_in(problems("file = \"s.csv\""), {"case.toml:4:", "span", "no axis"});
  expect_all_in(problems("file = \"s.csv\"\nspan = \"radius\""), {"case.toml:8:", "machine axis"});
  expect_all_in(problems("file = \"s.csv\"\nspan = [0, 0, 0]"), {"case.toml:8:", "no length"});
  expect_all_in(problems("file = \"t.stl\"\nmapping = \"projecton\""), {"case.toml:8:", "'projection'"});
  expect_all_in(problems("file = \"t.stl\"\ncrease_angle_deg = 180\nlength_scale = 0"),
                {"case.toml:8:", "between 0 and 180", "case.toml:9:", "positive"});
  expect_all_in(problems("file = \"t.stl\"\ntarget_patches = \"w\""), {"case.toml:7:", "only CGNS"});
  expect_all_in(problems("file = \"s.csv\"\nspan = \"z\"\nmapping = \"projection\""),
                {"case.toml:9:", "needs a surface"});
  write("bad.stl", "not a surface");
  expect_all_in(problems("file = \"bad.stl\""), {"case.toml:7:", "bad.stl", "is not an STL file"});
}

TEST(TargetText, SectionsAreDividedByBlankLinesCommentsOrAColumn) {
  std::string const five = "1 2 3\n2 2 3\n3 2 3\n3 1 3\n2 1 3\n";
  auto const by_comment = parse_target_sections("# hub\n" + five + "# tip\n" + five, "f");
  ASSERT_EQ(by_comment.size(), 2u);
  EXPECT_EQ(by_comment[0].name, "hub");
  EXPECT_EQ(by_comment[1].name, "tip");
  auto const by_blank = parse_target_sections("x;y;z\n" + five + "\n\n" + five, "f");
  ASSERT_EQ(by_blank.size(), 2u);
  EXPECT_EQ(by_blank[1].name, "line 9");
  std::string column = "section,x,y,z\n";
  for (char const* s : {"a", "b"})
    for (int k = 0; k < 5; ++k)
      column += std::string(s) + "," + std::to_string(k) + ",1e-3,+2\n" + (k == 2 ? "\n" : "");
  auto const by_column = parse_target_sections(column, "f");
  ASSERT_EQ(by_column.size(), 2u);
  EXPECT_EQ(by_column[1].name, "b");
  EXPECT_TRUE(by_column[1].points[4] == (Vec3{4, 1e-3, 2}));
}

TEST(TargetText, DamagedLinesAreNamed) {
  expect_all_in(message_of<ConfigError>([] { parse_target_sections("1 2 3\n1 2\n1 2 x\n1 2 inf\n", "f"); }),
                {"f:2: expected 3 columns, found 2", "f:3: z = \"x\"", "f:4: z = \"inf\"", "f:1: section", "5"});
  expect_all_in(message_of<ConfigError>([] { parse_target_sections("# only words\n", "f"); }), {"no sections"});
  expect_all_in(message_of<ConfigError>([] { parse_target_nodes("", "f"); }), {"no points"});
  std::string many;
  for (int n = 0; n < 100; ++n) many += "1 2 3 4 5\n";
  std::string const message = message_of<ConfigError>([&] { parse_target_nodes(many, "f"); });
  EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 9);
}

}  // namespace
}  // namespace gridmorph::test
