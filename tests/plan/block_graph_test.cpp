// Blocks, interfaces and chains of a plan as a graph.
#include "support/mesh_builders.hpp"
#include "support/motions.hpp"
#include "support/scramble.hpp"

#include <gridmorph/plan/block_graph.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

namespace gridmorph::test {
namespace {

BlockGraph graph_of(Mesh const& mesh, PlanOptions const& options = {}) {
  return block_graph(prepare(mesh, motion({rule({"*"}, FixedRule{})}), options));
}

PlanOptions one_layer(std::string const& wall) {
  PlanOptions options;
  options.boundary_layers = {{{wall}, BoundaryLayer::Extent::layers, 1, 0, BoundaryLayer::Mode::translate}};
  return options;
}

TEST(BlockGraph, EveryBlockIsInOneChainAndHasItsCells) {
  for (Mesh const& mesh : {bricks_with_t_junctions(1), around_a_box(1), star(5, 1), c_grid(1), l_shape(1)}) {
    BlockGraph const graph = graph_of(mesh);
    Index cells = 0;
    std::vector<int> chains(graph.blocks.size(), 0);
    for (auto const& block : graph.blocks) cells += block.cells;
    for (auto const& chain : graph.chains)
      for (int const b : chain.blocks) ++chains[b];
    EXPECT_EQ(cells, mesh.n_cells()) << mesh.source;
    EXPECT_EQ(chains, std::vector<int>(graph.blocks.size(), 1)) << mesh.source;
    for (std::size_t c = 0; c < graph.chains.size(); ++c)
      for (int const b : graph.chains[c].blocks) EXPECT_EQ(graph.blocks[b].chain, int(c));
  }
}

TEST(BlockGraph, NeighboursAlongChainsHaveAnInterface) {
  for (Mesh const& mesh : {around_a_box(1), star(5, 1), l_shape(1)}) {
    BlockGraph const graph = graph_of(mesh);
    for (auto const& chain : graph.chains)
      for (std::size_t n = 1; n < chain.blocks.size(); ++n) {
        auto const [a, b] = std::minmax({chain.blocks[n - 1], chain.blocks[n]});
        EXPECT_TRUE(std::any_of(graph.interfaces.begin(), graph.interfaces.end(), [a = a, b = b](auto const& face) {
          return face.a == a && face.b == b;
        })) << mesh.source;
      }
  }
}

/// Five blocks around an edge, each joined to the next by all faces of one side.
TEST(BlockGraph, AStarIsARing) {
  Mesh const mesh = star(5, 1);
  BlockGraph const graph = graph_of(mesh);
  ASSERT_EQ(graph.blocks.size(), 5U);
  ASSERT_EQ(graph.interfaces.size(), 5U);
  std::vector<int> degree(5, 0);
  Index faces = 0;
  for (auto const& face : graph.interfaces) {
    EXPECT_FALSE(face.periodic);
    ++degree[face.a];
    ++degree[face.b];
    faces += face.faces;
  }
  EXPECT_EQ(degree, std::vector<int>(5, 2));
  Index expected = 0;
  for (Interface1to1 const& face : mesh.interfaces) {
    Index n = 1;
    for (int a = 0; a < 3; ++a) n *= std::max(face.range.extent(a) - 1, 1);
    expected += n;
  }
  EXPECT_EQ(faces, expected);
}

TEST(BlockGraph, PeriodicSidesJoinABlockToItself) {
  BlockGraph const graph = graph_of(translational(1, 1));
  ASSERT_EQ(graph.blocks.size(), 1U);
  ASSERT_EQ(graph.interfaces.size(), 1U);
  EXPECT_TRUE(graph.interfaces[0].periodic);
  EXPECT_EQ(graph.interfaces[0].a, graph.interfaces[0].b);
}

/// What a person would see in the drawing: sizes of blocks, what joins them, and the stage and place of each in its
/// chain, whatever the file.
using Seen = std::vector<std::tuple<Index, Index, bool, Index>>;
Seen seen(BlockGraph const& graph) {
  Seen out;
  for (auto const& face : graph.interfaces) {
    auto const key = [&](int b) {
      auto const& block = graph.blocks[b];
      return 1000 * block.cells + graph.chains[block.chain].stage;
    };
    auto const [a, b] = std::minmax({key(face.a), key(face.b)});
    out.emplace_back(a, b, face.periodic, face.faces);
  }
  std::sort(out.begin(), out.end());
  return out;
}

TEST(BlockGraph, DoesNotDependOnHowTheFileIsCutAndNumbered) {
  for (Mesh const& mesh : {around_a_box(1), c_grid(1), annulus_sector({}, 1), l_shape(1)}) {
    PlanOptions const options = mesh.source == around_a_box(1).source ? one_layer("step") : PlanOptions{};
    Seen const expected = seen(graph_of(mesh, options));
    for (unsigned seed = 1; seed <= 4; ++seed)
      EXPECT_EQ(seen(graph_of(scramble(mesh, {seed, 3}).mesh, options)), expected) << mesh.source << ", seed " << seed;
  }
}

TEST(BlockGraph, StagesAndEndsHaveTheirNames) {
  BlockGraph const graph = graph_of(around_a_box(1), one_layer("step"));
  ASSERT_GE(graph.stages.size(), 2U);
  EXPECT_EQ(graph.stages[0], "near field");
  EXPECT_EQ(graph.stages[1], "iteration 1");
  EXPECT_EQ(graph.chains[0].ends[0], "step");
  EXPECT_EQ(graph.chains[0].number, 1);
  EXPECT_FALSE(graph.chains[0].reason.empty());
}

}  // namespace
}  // namespace gridmorph::test
