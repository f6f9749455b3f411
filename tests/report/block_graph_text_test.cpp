// Drawings of plans.
#include <gridmorph/report/block_graph_text.hpp>

#include <gtest/gtest.h>

#include <array>
#include <regex>
#include <string>
#include <vector>

namespace gridmorph {
namespace {

/// A near field of two blocks, a row of many chains, and one block that a rule moves; names that have to be escaped.
BlockGraph graph() {
  BlockGraph g;
  g.stages = {"near field", "iteration 1"};
  g.chains.push_back({0, 1, {0}, {"blade <\"1\">", ""}, "constant & rigid"});
  g.chains.push_back({0, 2, {1}, {"blade", ""}, ""});
  for (int c = 0; c < 9; ++c)
    g.chains.push_back({1, c + 1, {2 + 2 * c, 3 + 2 * c}, {"wall", "an outlet of a very long name"}, ""});
  for (int b = 0; b < 21; ++b)
    g.blocks.push_back({"zone \"a\" & b [1:9, 1:9, 1:9]", b % 3, 512, b < 20 ? 0 : -1, {"blade", "hub"}});
  g.interfaces = {{0, 2, false, 64}, {2, 3, false, 64}, {3, 3, true, 64}, {1, 19, true, 8}, {19, 20, false, 8}};
  return g;
}

/// Every "<name" that is opened is closed, in order.
bool balanced(std::string const& xml) {
  std::vector<std::string> open;
  std::regex const tag("<(/?)([a-z]+)([^<>]*?)(/?)>");
  std::string rest = xml;
  for (auto it = std::sregex_iterator(xml.begin(), xml.end(), tag); it != std::sregex_iterator(); ++it) {
    if ((*it)[1] == "/") {
      if (open.empty() || open.back() != (*it)[2]) return false;
      open.pop_back();
    } else if ((*it)[4] != "/") {
      open.push_back((*it)[2]);
    }
  }
  return open.empty();
}

TEST(BlockGraphDrawing, IsWellFormedWhateverTheNames) {
  std::string const svg = svg_text(graph());
  EXPECT_TRUE(balanced(svg));
  EXPECT_EQ(std::regex_replace(svg, std::regex("&(amp|lt|gt);"), "").find('&'), std::string::npos);
  EXPECT_NE(svg.find("constant &amp; rigid"), std::string::npos);
  EXPECT_EQ(svg.find("blade <"), std::string::npos);
}

TEST(BlockGraphDrawing, NoTwoBlocksOverlapAndAllLieOnThePaper) {
  std::string const svg = svg_text(graph());
  std::smatch paper;
  ASSERT_TRUE(std::regex_search(svg, paper, std::regex("viewBox=\"0 0 ([0-9.]+) ([0-9.]+)\"")));
  std::vector<std::array<double, 4>> boxes;
  std::regex const node("<rect x=\"([0-9.]+)\" y=\"([0-9.]+)\" width=\"([0-9.]+)\" height=\"([0-9.]+)\" rx=\"4\"");
  for (auto it = std::sregex_iterator(svg.begin(), svg.end(), node); it != std::sregex_iterator(); ++it)
    boxes.push_back({std::stod((*it)[1]), std::stod((*it)[2]), std::stod((*it)[3]), std::stod((*it)[4])});
  ASSERT_EQ(boxes.size(), graph().blocks.size());
  for (std::size_t a = 0; a < boxes.size(); ++a) {
    EXPECT_LE(boxes[a][0] + boxes[a][2], std::stod(paper[1]));
    EXPECT_LE(boxes[a][1] + boxes[a][3], std::stod(paper[2]));
    for (std::size_t b = 0; b < a; ++b)
      EXPECT_TRUE(boxes[a][0] >= boxes[b][0] + boxes[b][2] || boxes[b][0] >= boxes[a][0] + boxes[a][2] ||
                  boxes[a][1] >= boxes[b][1] + boxes[b][3] || boxes[b][1] >= boxes[a][1] + boxes[a][3])
          << a << " and " << b;
  }
}

TEST(BlockGraphDrawing, StagesFollowOneAnotherDownThePage) {
  std::string const svg = svg_text(graph());
  auto const y_of = [&](std::string const& stage) {
    std::smatch found;
    EXPECT_TRUE(std::regex_search(svg, found, std::regex("y=\"([0-9.]+)\" font-size=\"14\"[^>]*>" + stage)));
    return std::stod(found[1]);
  };
  EXPECT_LT(y_of("near field"), y_of("iteration 1"));
  EXPECT_LT(y_of("iteration 1"), y_of("moved by rules"));
}

TEST(BlockGraphDrawing, OfGraphvizNamesEveryBlockAndInterfaceOnce) {
  std::string const dot = dot_text(graph());
  auto const count = [&](std::string const& pattern) {
    std::regex const expression(pattern);
    return std::distance(std::sregex_iterator(dot.begin(), dot.end(), expression), std::sregex_iterator());
  };
  EXPECT_EQ(count("\n  b[0-9]+ \\[label"), 21);
  EXPECT_EQ(count("\n  b[0-9]+ -- b[0-9]+ \\["), 5);
  EXPECT_EQ(count("style = dashed"), 2);
  EXPECT_EQ(count("subgraph cluster_"), 11);
  EXPECT_EQ(count("dir = forward"), 9);
  EXPECT_NE(dot.find("zone \\\"a\\\" & b"), std::string::npos);
  EXPECT_EQ(std::count(dot.begin(), dot.end(), '{'), std::count(dot.begin(), dot.end(), '}'));
}

}  // namespace
}  // namespace gridmorph
