#include "case_text.hpp"

#include <gridmorph/mapping/point_cloud.hpp>

namespace gridmorph::test {
namespace {

std::vector<std::string> problems_in(std::string const& text) {
  return error_lines([&] { (void)parse_point_cloud(text, "d.csv"); });
}

TEST(PointCloud, ReadsCommasSemicolonsTabsAndBlanksAlike) {
  for (std::string const text : {"1,2,3,4,5,6\n", "1, 2, 3, 4, 5, 6\n", "1;2;3;4;5;6\n", "1 2 3 4 5 6\n",
                                 "  1   2\t3 4  5 6  \n", "1\t2\t3\t4\t5\t6"}) {
    PointCloud const cloud = parse_point_cloud(text, "d.csv");
    ASSERT_EQ(cloud.size(), 1u) << text;
    EXPECT_EQ(cloud.position[0], (Vec3{1, 2, 3})) << text;
    EXPECT_EQ(cloud.displacement[0], (Vec3{4, 5, 6})) << text;
  }
}

TEST(PointCloud, SkipsCommentsBlankLinesByteOrderMarkAndCarriageReturns) {
  PointCloud const cloud = parse_point_cloud(
      "\xef\xbb\xbf# made by hand\r\n\r\n1,2,3,4,5,6\r\n   \n# more\n-1e-3,+2.5,3.,.5,5,6\r\n", "d.csv");
  ASSERT_EQ(cloud.size(), 2u);
  EXPECT_EQ(cloud.position[1], (Vec3{-1e-3, 2.5, 3}));
  EXPECT_EQ(cloud.displacement[1], (Vec3{0.5, 5, 6}));
  EXPECT_EQ(cloud.where(0), "d.csv:3");
  EXPECT_EQ(cloud.where(1), "d.csv:6");
}

TEST(PointCloud, FollowsTheColumnsThatAHeaderNames) {
  PointCloud const cloud = parse_point_cloud("id,DZ,dy,dx,\"X\",y,z,temperature\n7,6,5,4,1,2,3,300\n", "d.csv");
  EXPECT_EQ(cloud.position.at(0), (Vec3{1, 2, 3}));
  EXPECT_EQ(cloud.displacement.at(0), (Vec3{4, 5, 6}));
}

TEST(PointCloud, KnowsTheColumnNamesOfParaViewAndCgns) {
  auto const check = [](std::string const& header) {
    PointCloud const cloud = parse_point_cloud(header + "\n4,5,6,1,2,3\n", "d.csv");
    EXPECT_EQ(cloud.position.at(0), (Vec3{1, 2, 3})) << header;
    EXPECT_EQ(cloud.displacement.at(0), (Vec3{4, 5, 6})) << header;
  };
  check("\"Displacement:0\",\"Displacement:1\",\"Displacement:2\",\"Points:0\",\"Points:1\",\"Points:2\"");
  check("DisplacementX,DisplacementY,DisplacementZ,CoordinateX,CoordinateY,CoordinateZ");
}

TEST(PointCloud, KeepsEveryDigit) {
  PointCloud const cloud = parse_point_cloud("0.1 0.30000000000000004 1e-300 -0 2.2250738585072014e-308 1", "d.csv");
  EXPECT_EQ(cloud.position[0], (Vec3{0.1, 0.1 + 0.2, 1e-300}));
  EXPECT_EQ(cloud.displacement[0].y, 2.2250738585072014e-308);
}

TEST(PointCloud, ReportsABadNumberWithLineColumnAndText) {
  auto const lines = problems_in("x,y,z,dx,dy,dz\n1,2,3,4,5,6\n1,2,3,4,oops,6\n1;2\n");
  EXPECT_TRUE(reported(lines, "d.csv:3: ", {"dy", "\"oops\"", "not a number"}));
  EXPECT_TRUE(reported(lines, "d.csv:4: ", {"expected 6 columns", "found 1"}));
}

TEST(PointCloud, ReportsNumbersThatAreNotFinite) {
  EXPECT_TRUE(reported(problems_in("1,2,3,nan,5,6\n"), "d.csv:1: ", {"dx", "\"nan\"", "not finite"}));
  EXPECT_TRUE(reported(problems_in("1,2,3,4,5,6\n1,-inf,3,4,5,6\n"), "d.csv:2: ", {"y = \"-inf\"", "not finite"}));
  EXPECT_TRUE(reported(problems_in("1,1e999,3,4,5,6\n"), "d.csv:1: ", {"\"1e999\"", "not finite"}));
}

TEST(PointCloud, TakesNumbersTooSmallToRepresentAsZero) {
  EXPECT_EQ(parse_point_cloud("1,1e-999,3,4,5,6\n", "d.csv").position[0].y, 0.0);
}

TEST(PointCloud, HintsAtDecimalCommas) {
  EXPECT_TRUE(reported(problems_in("1,5;2;3;4;5;6\n"), "d.csv:1: ", {"\"1,5\"", "decimal point"}));
}

TEST(PointCloud, ReportsTooFewAndTooManyColumns) {
  EXPECT_TRUE(reported(problems_in("1,2,3\n"), "d.csv:1: ", {"expected 6 columns", "found 3"}));
  EXPECT_TRUE(reported(problems_in("1,2,3,4,5,6,7\n"), "d.csv:1: ", {"found 7", "header"}));
}

TEST(PointCloud, ReportsHeadersThatLackColumns) {
  EXPECT_TRUE(reported(problems_in("x,y,z,ux,uy,uz\n1,2,3,4,5,6\n"), "d.csv:1: ", {"dx, dy, dz", "x,y,z,ux,uy,uz"}));
  EXPECT_TRUE(reported(problems_in("x,x,y,z,dx,dy,dz\n"), "d.csv:1: ", {"'x' twice"}));
}

TEST(PointCloud, ReportsFilesWithoutPoints) {
  for (std::string const text : {"", "\n\n", "# nothing\n", "x,y,z,dx,dy,dz\n"})
    EXPECT_TRUE(reported(problems_in(text), "d.csv: ", {"no points"})) << text;
}

TEST(PointCloud, ListsNoMoreThanTenProblems) {
  std::string text;
  for (int n = 0; n < 100; ++n) text += "1,2,3,bad,5,6\n";
  EXPECT_EQ(problems_in(text).size(), 11u);
}

TEST(PointCloud, ReportsMissingFilesAndFolders) {
  TemporaryFolder const folder;
  EXPECT_TRUE(reported(error_lines([&] { (void)read_point_cloud(folder.path("none.csv")); }), "displacement file",
                       {"none.csv", "does not exist"}));
  EXPECT_TRUE(
      reported(error_lines([&] { (void)read_point_cloud(folder.path("")); }), "displacement file", {"directory"}));
}

}  // namespace
}  // namespace gridmorph::test
