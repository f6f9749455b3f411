// Nearest sources against the plain sweeps that they are defined by, one node after another, all looking at what was
// known before the sweep.
#include "support/random.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/plan/elements/wall_distance.hpp>
#include <gridmorph/plan/place_order.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace gridmorph::test {
namespace {

double rounded_by_mantissa(double a) {
  int exponent = 0;
  double const mantissa = std::frexp(a, &exponent);
  return std::ldexp(std::floor(mantissa * 0x1p16 + 0.3819), exponent - 16);
}

/// All nodes in every sweep.
class PlainSweeps {
 public:
  PlainSweeps(Coordinates const& x, NodeGraph const& graph, std::vector<Index32> const& sources)
      : x_(x), graph_(graph), is_before_(x) {
    state.source.assign(graph.size(), -1);
    state.distance.assign(graph.size(), std::numeric_limits<double>::infinity());
    for (Index32 const s : sources) {
      state.source[s] = s;
      state.distance[s] = 0;
    }
    for (double nearest = 0; std::isfinite(nearest);) {
      double const reach = nearest * std::sqrt(1.4937);
      while (sweep(reach)) {
      }
      nearest = std::numeric_limits<double>::infinity();
      for (Index32 n = 0; n < Index32(graph.size()); ++n)
        if (state.source[n] < 0) nearest = std::min(nearest, looked_around(state, n).second);
    }
    for (Index32 n = 0; n < Index32(graph.size()); ++n) descend(n);
  }
  NearestSource state;

 private:
  using Own = std::pair<Index32, double>;

  [[nodiscard]] Own better(Index32 n, Index32 s, Own const& own) const {
    double const d = distance(x_[n], x_[s]);
    if (own.first >= 0) {
      double const step = is_before_.step();
      double const a = rounded_by_mantissa(d / step), b = rounded_by_mantissa(own.second / step);
      if (!(a < b || (a == b && is_before_(s, own.first)))) return own;
    }
    return {s, d};
  }

  [[nodiscard]] Own looked_around(NearestSource const& before, Index32 n) const {
    Own own{before.source[n], before.distance[n]};
    for (Index32 const m : graph_.neighbours[n])
      if (Index32 const s = before.source[m]; s >= 0 && s != own.first) own = better(n, s, own);
    return own;
  }

  bool sweep(double reach) {
    NearestSource const before = state;
    for (Index32 n = 0; n < Index32(graph_.size()); ++n) {
      if (before.distance[n] == 0) continue;
      Own const own = looked_around(before, n);
      if (before.source[n] < 0 && own.second > reach) continue;
      state.source[n] = own.first;
      state.distance[n] = own.second;
    }
    return state.source != before.source;
  }

  void descend(Index32 n) {
    Own own{state.source[n], state.distance[n]};
    if (own.first < 0 || own.second == 0) return;
    for (Index32 before = -1; before != own.first;) {
      before = own.first;
      for (Index32 const m : graph_.neighbours[before])
        if (state.distance[m] == 0) own = better(n, m, own);
    }
    state.source[n] = own.first;
    state.distance[n] = own.second;
  }

  Coordinates const& x_;
  NodeGraph const& graph_;
  PlaceOrder is_before_;
};

void expect_same(Mesh const& mesh, std::vector<Index32> const& sources) {
  NodeGraph const graph = make_node_graph(mesh, elements_of_nodes(mesh));
  NearestSource const found = nearest_source(mesh.coordinates, graph, sources);
  PlainSweeps const plain(mesh.coordinates, graph, sources);
  EXPECT_EQ(found.source, plain.state.source);
  EXPECT_EQ(found.distance, plain.state.distance);
}

/// Large enough for several threads, nodes off their lattice by up to `off`.
Mesh box(double off) {
  Mesh mesh = to_prisms_and_tetrahedra(unit_box({18, 18, 18}), 4);
  Random random(7);
  for (Index n = 0; n < mesh.n_nodes(); ++n) mesh.coordinates.set(n, mesh.coordinates[n] + random.vector(off));
  return mesh;
}

std::vector<Index32> every(Mesh const& mesh, Index32 step) {
  std::vector<Index32> out;
  for (Index32 n = step / 2; n < Index32(mesh.n_nodes()); n += step) out.push_back(n);
  return out;
}

TEST(WallDistance, SourcesAreThoseOfPlainSweeps) {
  Mesh const mesh = box(0.3);
  for (Index32 const step : {37, 911}) expect_same(mesh, every(mesh, step));
}

TEST(WallDistance, TiesOfALatticeAreThoseOfPlainSweeps) {
  Mesh const mesh = box(0);
  for (Index32 const step : {37, 911}) expect_same(mesh, every(mesh, step));
}

TEST(WallDistance, SourcesAreAboutTheNearestOnesWhereNothingIsBetween) {
  Mesh const mesh = box(0.1);
  NodeGraph const graph = make_node_graph(mesh, elements_of_nodes(mesh));
  std::vector<Index32> bottom;
  for (Index32 n = 0; n < Index32(mesh.n_nodes()); ++n)
    if (mesh.coordinates[n].z < 0.5) bottom.push_back(n);
  NearestSource const found = nearest_source(mesh.coordinates, graph, bottom);
  for (Index32 n = 0; n < Index32(mesh.n_nodes()); ++n) {
    double nearest = std::numeric_limits<double>::infinity();
    for (Index32 const s : bottom) nearest = std::min(nearest, distance(mesh.coordinates[n], mesh.coordinates[s]));
    EXPECT_LE(found.distance[n], nearest * 1.005) << n;
  }
}

TEST(WallDistance, WhatNoEdgeJoinsToASourceHasNone) {
  Mesh const mesh = flat_box(4, 4, 4);
  NodeGraph graph = make_node_graph(mesh, elements_of_nodes(mesh));
  NearestSource const found = nearest_source(mesh.coordinates, graph, {});
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    EXPECT_EQ(found.source[n], -1);
    EXPECT_EQ(found.distance[n], std::numeric_limits<double>::infinity());
  }
}

TEST(PlaceOrder, RoundsByTheLeadingSixteenBits) {
  Random random(3);
  for (int k = 0; k < 100'000; ++k) {
    double const a = std::ldexp(random.between(0.5, 1), random.below(600) - 300);
    ASSERT_EQ(PlaceOrder::rounded(a), rounded_by_mantissa(a)) << a;
  }
  for (double const a : {1.0, 0.5, std::nextafter(1.0, 0.0), 1 - 0x1p-17, std::numeric_limits<double>::min(), 4e-320})
    EXPECT_EQ(PlaceOrder::rounded(a), rounded_by_mantissa(a)) << a;
  EXPECT_EQ(PlaceOrder::rounded(0), 0);
}

}  // namespace
}  // namespace gridmorph::test
