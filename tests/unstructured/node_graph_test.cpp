// Lists around nodes and across sides against plain maps, on meshes whose numbers are shuffled: their entries go
// through several buckets and, with several threads, several chunks.
#include "support/random.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/core/index_buckets.hpp>
#include <gridmorph/mesh/node_graph.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

namespace gridmorph::test {
namespace {

std::vector<Index32> shuffled_numbers(Index n, Random& random) {
  std::vector<Index32> number(static_cast<std::size_t>(n));
  std::iota(number.begin(), number.end(), 0);
  random.shuffle(number);
  return number;
}

/// Prisms and tetrahedra of a box, nodes and elements in random order.
Mesh shuffled_box(Index3 cells, int prism_layers) {
  Mesh const from = to_prisms_and_tetrahedra(unit_box(cells), prism_layers);
  Random random(5);
  auto const node = shuffled_numbers(from.n_nodes(), random);
  Mesh out;
  out.add_zone("zone", from.n_nodes());
  out.coordinates = Coordinates(from.n_nodes());
  for (Index n = 0; n < from.n_nodes(); ++n) out.coordinates.set(node[n], from.coordinates[n]);
  for (Index32 const e : shuffled_numbers(from.n_elements(), random)) {
    std::vector<Index32> corners;
    for (Index32 const c : from.elements.corners(e)) corners.push_back(node[c]);
    out.add_element(from.elements.type[e], corners);
  }
  return out;
}

TEST(IndexBuckets, KeepTheOrderOfTheItemsUnderEachKey) {
  for (Index const n_keys : {1, 7, 1024, 1025, 50000}) {
    Index const n_items = 30000;
    Random random(3);
    std::vector<std::vector<Index32>> keys;
    std::map<Index32, std::vector<Index32>> expected;
    for (Index32 i = 0; i < n_items; ++i) {
      auto& own = keys.emplace_back();
      for (int k = random.below(4); k > 0; --k) own.push_back(Index32(random.below(int(n_keys))));
      for (Index32 const key : own) expected[key].push_back(i);
    }
    detail::IndexBuckets<Index32> const buckets({}, "test", n_items, n_keys, [&](Index i, auto const& put) {
      for (Index32 const key : keys[i]) put(key, Index32(i));
    });
    std::vector<std::vector<Index32>> found(static_cast<std::size_t>(n_keys));
    std::vector<Index> before(static_cast<std::size_t>(n_keys), -1);
    buckets.for_each_key([&](Index32 key, Index at, std::span<Index32 const> items) {
      found[key].assign(items.begin(), items.end());
      before[key] = at;
    });
    Index sum = 0;
    for (Index32 key = 0; key < n_keys; ++key) {
      EXPECT_EQ(found[key], expected[key]) << key << " of " << n_keys;
      EXPECT_EQ(before[key], sum);
      sum += Index(found[key].size());
    }
    EXPECT_EQ(buckets.size(), sum);
  }
}

TEST(IndexBuckets, NothingInNothingOut) {
  detail::IndexBuckets<Index32> const none({}, "test", 0, 0, [](Index, auto const&) {});
  none.for_each_key([](Index32, Index, std::span<Index32>) { FAIL(); });
  EXPECT_EQ(none.size(), 0);
}

TEST(NodeGraph, NeighboursAreTheOtherEndsOfAllEdges) {
  auto const mesh = shuffled_box({12, 13, 14}, 3);
  ASSERT_GT(mesh.n_nodes(), 2048);
  std::map<Index32, std::set<Index32>> expected;
  for (Index e = 0; e < mesh.n_elements(); ++e) {
    auto const type = mesh.elements.type[e];
    auto const c = mesh.elements.corners(e);
    for (int k = 0; k < n_edges(type); ++k) {
      Index32 const a = c[edge_corner(type, k, 0)], b = c[edge_corner(type, k, 1)];
      expected[a].insert(b);
      expected[b].insert(a);
    }
  }
  auto const graph = make_node_graph(mesh, elements_of_nodes(mesh));
  ASSERT_EQ(graph.neighbours.size(), mesh.n_nodes());
  for (Index32 n = 0; n < mesh.n_nodes(); ++n) {
    auto const found = graph.neighbours[n];
    EXPECT_TRUE(std::equal(found.begin(), found.end(), expected[n].begin(), expected[n].end())) << n;
  }
}

TEST(UnstructuredTopology, SidesMeetWhereTheyHaveTheSameNodes) {
  auto const mesh = shuffled_box({11, 12, 17}, 4);
  ASSERT_GT(mesh.n_nodes(), 2048);
  std::map<std::vector<Index32>, std::vector<Index32>> elements_of_side;
  auto const nodes_of = [&](Index e, int side) {
    std::array<Index32, max_face_corners> room{};
    auto const nodes = side_nodes(mesh, e, side, room);
    std::vector<Index32> sorted(nodes.begin(), nodes.end());
    std::sort(sorted.begin(), sorted.end());
    return sorted;
  };
  for (Index e = 0; e < mesh.n_elements(); ++e)
    for (int s = 0; s < n_sides(mesh, e); ++s) elements_of_side[nodes_of(e, s)].push_back(Index32(e));
  auto const sides = element_sides(mesh);
  for (Index e = 0; e < mesh.n_elements(); ++e)
    for (int s = 0; s < n_sides(mesh, e); ++s) {
      auto const& both = elements_of_side.at(nodes_of(e, s));
      ASSERT_LE(both.size(), 2u);
      Index32 const expected = both.size() == 1 ? ElementSides::boundary : both[0] == e ? both[1] : both[0];
      EXPECT_EQ(sides.of(e)[s], expected) << "element " << e << " side " << s;
    }
  auto const around = elements_of_nodes(mesh);
  std::map<Index32, std::vector<Index32>> expected;
  for (Index e = 0; e < mesh.n_elements(); ++e)
    for (Index32 const c : mesh.elements.corners(e)) expected[c].push_back(Index32(e));
  for (Index32 n = 0; n < mesh.n_nodes(); ++n) {
    auto const found = around[n];
    EXPECT_TRUE(std::equal(found.begin(), found.end(), expected[n].begin(), expected[n].end())) << n;
  }
}

}  // namespace
}  // namespace gridmorph::test
