// Structural models as text: nodes, elements, and files that are damaged.
#include "model_support.hpp"

namespace gridmorph::test {
namespace {

PointCloud nodes_of(std::string const& text) { return parse_point_cloud(text, "n.csv"); }
PointCloud four_nodes() {
  return nodes_of("id,x,y,z,dx,dy,dz\n10,0,0,0,0,0,1\n20,1,0,0,0,0,2\n30,1,1,0,0,0,3\n40,0,1,0,0,0,4\n");
}
std::vector<std::string> model_problems_in(std::string const& elements) {
  return error_lines([&] { (void)parse_elements(elements, "e.csv", four_nodes()); });
}

TEST(StructuralModel, ReadsTrianglesAndQuadrilateralsByNodeId) {
  auto const facets =
      parse_elements("id,n1,n2,n3,n4\n1,10,20,30,40\n2,10,20,30\n3,10,30,40,\n4,20,30,40,40\n", "e.csv", four_nodes());
  ASSERT_EQ(facets.size(), 4u);
  EXPECT_EQ(facets[0].node, (std::array<std::int32_t, 4>{0, 1, 2, 3}));
  EXPECT_EQ(facets[1].node, (std::array<std::int32_t, 4>{0, 1, 2, -1}));
  EXPECT_EQ(facets[2].node, (std::array<std::int32_t, 4>{0, 2, 3, -1}));
  EXPECT_EQ(facets[3].node, (std::array<std::int32_t, 4>{1, 2, 3, -1}));
  EXPECT_EQ(facets[3].place, 5);
}

TEST(StructuralModel, CountsNodesWithoutIds) {
  auto const nodes = nodes_of("0,0,0,0,0,0\n1,0,0,0,0,0\n0,1,0,0,0,0\n");
  auto const facets = parse_elements("# shell\n7 1 2 3\n", "e.csv", nodes);
  EXPECT_EQ(facets.at(0).node, (std::array<std::int32_t, 4>{0, 1, 2, -1}));
  EXPECT_TRUE(reported(error_lines([&] { (void)parse_elements("7 1 2 4\n", "e.csv", nodes); }),
                       "e.csv:1: ", {"names node 4", "not in n.csv"}));
}

TEST(StructuralModel, ReportsNodesThatAreNotThereWithLineAndElement) {
  auto const lines = model_problems_in("1,10,20,30\n2,10,20,99\n3,11,20,30\n");
  EXPECT_TRUE(reported(lines, "e.csv:2: ", {"element 2", "node 99", "not in n.csv"}));
  EXPECT_TRUE(reported(lines, "e.csv:3: ", {"element 3", "node 11"}));
}

TEST(StructuralModel, ReportsLinesCutShort) {
  EXPECT_TRUE(reported(model_problems_in("1,10,20,30\n2,10,2"), "e.csv:2: ", {"found 3 columns", "cut short"}));
  EXPECT_TRUE(reported(model_problems_in("1,10,20,30\n2,10,20,3"), "e.csv:2: ", {"node 3"}));
}

TEST(StructuralModel, ReportsNumbersThatAreNotWholeAndNodesNamedTwice) {
  EXPECT_TRUE(reported(model_problems_in("1,10,20.5,30\n"), "e.csv:1: ", {"\"20.5\"", "whole number"}));
  EXPECT_TRUE(reported(model_problems_in("1,10,nan,30\n"), "e.csv:1: ", {"\"nan\"", "whole number"}));
  EXPECT_TRUE(reported(model_problems_in("1,10,20,10\n"), "e.csv:1: ", {"names node 10 twice"}));
}

TEST(StructuralModel, ReportsIdsUsedTwice) {
  EXPECT_TRUE(reported(model_problems_in("1,10,20,30\n1,10,30,40\n"), "e.csv:2: ", {"id 1", "line 1"}));
  auto const twice = nodes_of("id,x,y,z,dx,dy,dz\n1,0,0,0,0,0,0\n1,1,0,0,0,0,0\n");
  EXPECT_TRUE(reported(error_lines([&] { (void)parse_elements("1,1,1,1\n", "e.csv", twice); }),
                       "n.csv:3: ", {"id 1", "n.csv:2"}));
}

TEST(StructuralModel, ReportsFilesWithoutElementsAndForeignHeaders) {
  EXPECT_TRUE(reported(model_problems_in("# nothing\n"), "e.csv: ", {"no elements"}));
  EXPECT_TRUE(reported(model_problems_in("element;a;b;c\n1;10;20;30\n"), "e.csv:1: ", {"header", "id,n1,n2,n3,n4"}));
}

TEST(StructuralModel, ListsNoMoreThanTenProblems) {
  std::string text;
  for (int n = 0; n < 100; ++n) text += std::to_string(n) + ",10,20,99\n";
  EXPECT_EQ(model_problems_in(text).size(), 11u);
}

TEST(StructuralModel, ReadsComplexShapes) {
  auto const nodes = nodes_of("x,y,z,dx_re,dy_re,dz_re,dx_im,dy_im,dz_im\n0,0,0,1,2,3,4,5,6\n");
  EXPECT_EQ(nodes.displacement.at(0), (Vec3{1, 2, 3}));
  EXPECT_EQ(nodes.imaginary.at(0), (Vec3{4, 5, 6}));
  EXPECT_TRUE(reported(error_lines([&] { (void)nodes_of("x,y,z,dx,dy,dz,dx_im,dy_im\n"); }), "n.csv:1: ", {"dz_im"}));
}

TEST(StructuralModel, IdsAreWholeNumbers) {
  EXPECT_TRUE(reported(error_lines([&] { (void)nodes_of("id,x,y,z,dx,dy,dz\n1.5,0,0,0,0,0,0\n"); }),
                       "n.csv:2: ", {"id = \"1.5\"", "whole number"}));
}

TEST(StructuralModel, NodesOnOneAnotherAreMergedInTheElements) {
  // Two quadrilaterals of two parts that meet in two nodes each of which is given twice; the side between is not free.
  auto const nodes = nodes_of(
      "0,0,0,0,0,0\n1,0,0,0.1,0,0\n1,1,0,0.1,0,0\n0,1,0,0,0,0\n"
      "1,0,0,0.1,0,0\n2,0,0,0.2,0,0\n2,1,0,0.2,0,0\n1,1,0,0.1,0,0\n");
  StructuralModel model{nodes, parse_elements("1,1,2,3,4\n2,5,6,7,8\n", "e.csv", nodes), "e.csv", {}};
  PointField const field(model, {});
  EXPECT_EQ(field.size(), 6u);
  EXPECT_VEC3_NEAR(mapped(field, {{1, 0.5, 0.1}})[0], (Vec3{0.1, 0, 0}), 1e-14);
  EXPECT_EQ(field.mapping().extrapolated, 0);
}

TEST(StructuralModel, CaseFilesNameModelAndElements) {
  TemporaryFolder const folder;
  folder.write("n.csv", "id,x,y,z,dx,dy,dz\n1,0,0,0,0,0,1\n2,1,0,0,0,0,1\n3,0,1,0,0,0,1\n");
  folder.write("e.csv", "1,1,2,3\n");
  auto const parsed = [&](std::string const& keys) {
    return parse_case_file(case_with_rule("rule = \"field\"\nfile = \"n.csv\"\n" + keys), folder.path("case.toml"));
  };
  auto const good = parsed("elements = \"e.csv\"\nextrapolation = \"nearest\"\noffset = \"translate\"\n");
  EXPECT_EQ(good.fields.at(0).field->n_elements(), 1u);
  EXPECT_EQ(displacement_of(good.motion.rules.at(0).rule, {0.2, 0.3, 0.4}), (Vec3{0, 0, 1}));
  folder.write("e.csv", "1,1,2,4\n");
  auto const where = folder.file("case.toml") + ":8: ";
  EXPECT_TRUE(reported(error_lines([&] { parsed("elements = \"e.csv\"\n"); }), where, {"e.csv:1", "node 4"}));
  EXPECT_TRUE(
      reported(error_lines([&] { parsed("elements = \"none.csv\"\n"); }), where, {"none.csv", "does not exist"}));
  EXPECT_TRUE(reported(error_lines([&] { parsed("solution = \"Mode1\"\n"); }), where, {"no CGNS file", "Mode1"}));
  EXPECT_TRUE(reported(error_lines([&] { parsed("extrapolation = \"cubic\"\n"); }),
                       folder.file("case.toml") + ":9: ", {"\"cubic\" is not known"}));
  EXPECT_TRUE(reported(error_lines([&] { parsed("max_extrapolation = -1\n"); }),
                       folder.file("case.toml") + ":9: ", {"must not be negative"}));
}

}  // namespace
}  // namespace gridmorph::test
