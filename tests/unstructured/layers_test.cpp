// Layers around walls against their definition, node by node; what the graph hides and what it does not reach.
#include "support/random.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/plan/layers.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace gridmorph::test {
namespace {

using Mask = std::vector<std::uint8_t>;
constexpr double endless = std::numeric_limits<double>::infinity();

/// Nodes at a distance from the nearest of some of them.
struct Around {
  Mesh mesh;
  NodeGraph graph = make_node_graph(mesh, elements_of_nodes(mesh));
  Mask seeds, wanted;
  std::vector<double> distance;

  Around(Mesh m, std::vector<Index32> const& sources)
      : mesh(std::move(m)), seeds(std::size_t(mesh.n_nodes()), 0), wanted(seeds.size(), 1) {
    for (Index32 const n : sources) seeds[n] = 1, wanted[n] = 0;
    for (Index n = 0; n < mesh.n_nodes(); ++n) {
      double least = endless;
      for (Index32 const s : sources)
        least = std::min(least, gridmorph::distance(mesh.coordinates[n], mesh.coordinates[s]));
      distance.push_back(least);
    }
  }
  [[nodiscard]] double edge(Index32 a, Index32 b) const {
    return gridmorph::distance(mesh.coordinates[a], mesh.coordinates[b]);
  }
};

/// Boxes of several sizes and kinds, their nodes shaken so that no two distances are equal, stretched and turned.
std::vector<Around> cases() {
  std::vector<Around> out;
  Random random(1);
  for (auto const& [cells, layers] : {std::pair{Index3{3, 3, 3}, 0}, {Index3{6, 4, 5}, 2}, {Index3{2, 9, 3}, 3}}) {
    Mesh mesh = to_prisms_and_tetrahedra(unit_box(cells), layers);
    RigidTransform const place = rotation_about({1, 2, 3}, random.vector(1), 1.0);
    std::vector<Index32> floor;
    for (Index32 n = 0; n < mesh.n_nodes(); ++n) {
      Vec3 const x = mesh.coordinates[n];
      if (x.z == 0) floor.push_back(n);
      mesh.coordinates.set(n, place(Vec3{x.x, x.y, 0.4 * x.z} + random.vector(0.05)));
    }
    out.emplace_back(mesh, floor);
    out.emplace_back(mesh, std::vector<Index32>{0, Index32(mesh.n_nodes() / 2)});
  }
  Mesh flat = flat_box(7, 9, 3);
  for (Index32 n = 0; n < flat.n_nodes(); ++n)
    flat.coordinates.set(n, flat.coordinates[n] + Vec3{random.between(-0.2, 0.2), random.between(-0.2, 0.2), 0});
  out.emplace_back(flat, std::vector<Index32>{40, 41});
  return out;
}

/// Row of each target as node -> weight.
std::map<Index32, std::map<Index32, double>> rows_of(InterpolationOperator const& rows) {
  std::map<Index32, std::map<Index32, double>> out;
  for (Index r = 0; r < rows.size(); ++r) {
    auto& row = out[rows.target[r]];
    EXPECT_TRUE(row.empty()) << "each target once";
    for (Index k = rows.first[r]; k < rows.first[r + 1]; ++k) row[rows.item[k]] += rows.weight[k];
  }
  return out;
}

TEST(Layers, RowsAreTheMeansOfNearerNeighbours) {
  for (Around const& a : cases()) {
    auto const weight = [&](Index32 n, Index32 m) { return 1 / a.edge(n, m); };
    auto const found = rows_of(make_layers(a.graph, a.mesh.coordinates, a.seeds, a.wanted, a.distance, weight).rows);
    EXPECT_EQ(found.size(), std::size_t(std::count(a.wanted.begin(), a.wanted.end(), 1)));
    for (auto const& [node, row] : found) {
      std::vector<std::pair<double, Index32>> expected;
      Index32 nearest = -1;
      for (Index32 const m : a.graph.neighbours[node]) {
        double const nearer = a.distance[node] - a.distance[m];
        double const s = std::clamp((nearer / a.edge(node, m) - 0.28) / 0.1, 0.0, 1.0);
        if (s > 0) expected.emplace_back(weight(node, m) * s * s * (3 - 2 * s), m);
        if (nearest < 0 || a.distance[m] < a.distance[nearest]) nearest = m;
      }
      if (expected.empty()) expected.emplace_back(1, nearest);
      std::sort(expected.rbegin(), expected.rend());
      ASSERT_EQ(row.size(), expected.size()) << node;
      double sum = 0, all = 0;
      for (auto const& [w, m] : expected) sum += w;
      for (auto const& [w, m] : expected) {
        ASSERT_TRUE(row.contains(m)) << node << " from " << m;
        EXPECT_NEAR(row.at(m), w / sum, 1e-6);
        all += row.at(m);
      }
      EXPECT_NEAR(all, 1, 1e-6);
    }
  }
}

TEST(Layers, SourcesLieInLayersBeforeAndOneOfThemInTheLast) {
  for (Around const& a : cases()) {
    auto const layers =
        make_layers(a.graph, a.mesh.coordinates, a.seeds, a.wanted, a.distance, [](Index32, Index32) { return 1.0; });
    std::vector<int> layer(a.seeds.size(), -1);
    for (std::size_t n = 0; n < a.seeds.size(); ++n)
      if (a.seeds[n]) layer[n] = 0;
    ASSERT_GT(layers.n_layers(), 2);
    EXPECT_EQ(layers.level.back(), layers.rows.size());
    for (int l = 0; l < layers.n_layers(); ++l) {
      double before = 0;
      EXPECT_LT(layers.level[l], layers.level[l + 1]);
      for (Index r = layers.level[l]; r < layers.level[l + 1]; ++r) {
        int highest = -1;
        for (Index k = layers.rows.first[r]; k < layers.rows.first[r + 1]; ++k) {
          int const source = layer[layers.rows.item[k]];
          EXPECT_GE(source, 0);
          highest = std::max(highest, source);
        }
        EXPECT_EQ(highest, l);
        double const d = a.distance[layers.rows.target[r]];
        EXPECT_GE(d, before);
        before = d;
      }
      for (Index r = layers.level[l]; r < layers.level[l + 1]; ++r) layer[layers.rows.target[r]] = l + 1;
    }
  }
}

/// Nodes of a line, each joined to the next.
NodeGraph line_of(int n) {
  NodeGraph graph;
  for (Index32 k = 0; k < n; ++k) {
    graph.representative.push_back(k);
    std::vector<Index32> row;
    if (k > 0) row.push_back(k - 1);
    if (k + 1 < n) row.push_back(k + 1);
    graph.neighbours.add(row);
  }
  return graph;
}

TEST(Layers, NodesThatLieNearerThanTheirWayWaitAndTheUnreachedHaveNoRow) {
  // Along the line 0 1 2 3 4: node 2 is as near as if the seed were behind a wall beside it; 4 is not wanted, so 5 is
  // not reached; 6 has no distance.
  NodeGraph const graph = line_of(7);
  Coordinates x(7);
  for (Index n = 0; n < 7; ++n) x.set(n, {double(n), 0, 0});
  Mask const seeds{1, 0, 0, 0, 0, 0, 0}, wanted{0, 1, 1, 1, 0, 1, 1};
  std::vector<double> const distance{0, 1, 0.2, 3, 4, 5, endless};
  auto const layers = make_layers(graph, x, seeds, wanted, distance, [](Index32, Index32) { return 2.0; });
  EXPECT_EQ(layers.rows.target, (std::vector<Index32>{1, 2, 3}));
  EXPECT_EQ(layers.rows.item, (std::vector<Index32>{0, 1, 2}));
  EXPECT_EQ(layers.rows.weight, (std::vector<float>{1, 1, 1}));
  EXPECT_EQ(layers.level, (std::vector<Index>{0, 1, 2, 3}));
}

TEST(Layers, SeedsMayLieAtAnyDistance) {
  NodeGraph const graph = line_of(4);
  Coordinates x(4);
  for (Index n = 0; n < 4; ++n) x.set(n, {double(n), 0, 0});
  auto const layers =
      make_layers(graph, x, {1, 0, 0, 0}, {0, 1, 1, 1}, {5, 6, 7, 8}, [](Index32, Index32) { return 1.0; });
  EXPECT_EQ(layers.rows.item, (std::vector<Index32>{0, 1, 2}));
}

}  // namespace
}  // namespace gridmorph::test
