// Lists around nodes and across sides against plain maps, on meshes whose numbers are shuffled: their entries go through
// several buckets and, with several threads, several chunks.
#include "support/random.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/mesh/detail/number_buckets.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>
#include <gridmorph/unstructured/node_graph.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

namespace gridmorph::test {
namespace {

std::vector<Number> shuffled_numbers(Index n, Random& random) {
  std::vector<Number> number(static_cast<std::size_t>(n));
  std::iota(number.begin(), number.end(), 0);
  random.shuffle(number);
  return number;
}

/// Prisms and tetrahedra of a box, nodes and elements in random order.
UnstructuredMesh shuffled_box(Index3 cells, int prism_layers) {
  UnstructuredMesh const from = to_prisms_and_tetrahedra(unit_box(cells), prism_layers);
  Random random(5);
  auto const node = shuffled_numbers(from.n_nodes(), random);
  UnstructuredMesh out;
  out.add_zone("zone", from.n_nodes());
  out.coordinates = Coordinates(from.n_nodes());
  for (Index n = 0; n < from.n_nodes(); ++n) out.coordinates.set(node[std::size_t(n)], from.coordinates[n]);
  for (Number const e : shuffled_numbers(from.n_elements(), random)) {
    std::vector<Number> corners;
    for (Number const c : from.elements.corners(e)) corners.push_back(node[std::size_t(c)]);
    out.add_element(from.elements.type[std::size_t(e)], corners);
  }
  return out;
}

TEST(NumberBuckets, KeepTheOrderOfTheItemsUnderEachKey) {
  for (Index const n_keys : {1, 7, 1024, 1025, 50000}) {
    Index const n_items = 30000;
    Random random(3);
    std::vector<std::vector<Number>> keys;
    std::map<Number, std::vector<Number>> expected;
    for (Number i = 0; i < n_items; ++i) {
      auto& own = keys.emplace_back();
      for (int k = random.below(4); k > 0; --k) own.push_back(Number(random.below(int(n_keys))));
      for (Number const key : own) expected[key].push_back(i);
    }
    detail::NumberBuckets<Number> const buckets("test", n_items, n_keys, [&](Index i, auto const& put) {
      for (Number const key : keys[std::size_t(i)]) put(key, Number(i));
    });
    std::vector<std::vector<Number>> found(static_cast<std::size_t>(n_keys));
    std::vector<Index> before(static_cast<std::size_t>(n_keys), -1);
    buckets.for_each_key([&](Number key, Index at, std::span<Number const> items) {
      found[std::size_t(key)].assign(items.begin(), items.end());
      before[std::size_t(key)] = at;
    });
    Index sum = 0;
    for (Number key = 0; key < n_keys; ++key) {
      EXPECT_EQ(found[std::size_t(key)], expected[key]) << key << " of " << n_keys;
      EXPECT_EQ(before[std::size_t(key)], sum);
      sum += Index(found[std::size_t(key)].size());
    }
    EXPECT_EQ(buckets.size(), sum);
  }
}

TEST(NumberBuckets, NothingInNothingOut) {
  detail::NumberBuckets<Number> const none("test", 0, 0, [](Index, auto const&) {});
  none.for_each_key([](Number, Index, std::span<Number>) { FAIL(); });
  EXPECT_EQ(none.size(), 0);
}

TEST(NodeGraph, NeighboursAreTheOtherEndsOfAllEdges) {
  auto const mesh = shuffled_box({12, 13, 14}, 3);
  ASSERT_GT(mesh.n_nodes(), 2048);
  std::map<Number, std::set<Number>> expected;
  for (Index e = 0; e < mesh.n_elements(); ++e) {
    auto const type = mesh.elements.type[std::size_t(e)];
    auto const c = mesh.elements.corners(e);
    for (int k = 0; k < n_edges(type); ++k) {
      Number const a = c[std::size_t(edge_corner(type, k, 0))], b = c[std::size_t(edge_corner(type, k, 1))];
      expected[a].insert(b);
      expected[b].insert(a);
    }
  }
  auto const graph = make_node_graph(mesh, elements_of_nodes(mesh));
  ASSERT_EQ(graph.neighbours.size(), mesh.n_nodes());
  for (Number n = 0; n < mesh.n_nodes(); ++n) {
    auto const found = graph.neighbours[n];
    EXPECT_TRUE(std::equal(found.begin(), found.end(), expected[n].begin(), expected[n].end())) << n;
  }
}

TEST(UnstructuredTopology, SidesMeetWhereTheyHaveTheSameNodes) {
  auto const mesh = shuffled_box({11, 12, 17}, 4);
  ASSERT_GT(mesh.n_nodes(), 2048);
  std::map<std::vector<Number>, std::vector<Number>> elements_of_side;
  auto const nodes_of = [&](Index e, int side) {
    std::array<Number, max_face_corners> room{};
    auto const nodes = side_nodes(mesh, e, side, room);
    std::vector<Number> sorted(nodes.begin(), nodes.end());
    std::sort(sorted.begin(), sorted.end());
    return sorted;
  };
  for (Index e = 0; e < mesh.n_elements(); ++e)
    for (int s = 0; s < n_sides(mesh, e); ++s) elements_of_side[nodes_of(e, s)].push_back(Number(e));
  auto const sides = element_sides(mesh);
  for (Index e = 0; e < mesh.n_elements(); ++e)
    for (int s = 0; s < n_sides(mesh, e); ++s) {
      auto const& both = elements_of_side.at(nodes_of(e, s));
      ASSERT_LE(both.size(), 2u);
      Number const expected = both.size() == 1 ? ElementSides::boundary : both[0] == e ? both[1] : both[0];
      EXPECT_EQ(sides.of(e)[std::size_t(s)], expected) << "element " << e << " side " << s;
    }
  auto const around = elements_of_nodes(mesh);
  std::map<Number, std::vector<Number>> expected;
  for (Index e = 0; e < mesh.n_elements(); ++e)
    for (Number const c : mesh.elements.corners(e)) expected[c].push_back(Number(e));
  for (Number n = 0; n < mesh.n_nodes(); ++n) {
    auto const found = around[n];
    EXPECT_TRUE(std::equal(found.begin(), found.end(), expected[n].begin(), expected[n].end())) << n;
  }
}

}  // namespace
}  // namespace gridmorph::test
