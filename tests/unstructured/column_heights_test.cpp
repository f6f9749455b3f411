// Where columns end, on a channel of unit squares, 8 by 6, above a wall at y = 0.
#include "support/unstructured_meshes.hpp"

#include <gridmorph/plan/elements/column_heights.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace gridmorph::test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Columns from the line y = 0 of nodes up to y = height(x), and the sources beside and ahead.
struct Channel {
  Mesh mesh = flat_box(8, 6, 6);
  NodeGraph graph = make_node_graph(mesh, elements_of_nodes(mesh));
  Columns columns;

  explicit Channel(double (*height)(double x)) {
    columns.height.assign(mesh.n_nodes(), 0);
    columns.full_rise = columns.height;
    for (Index32 n = 0; n < mesh.n_nodes(); ++n) {
      Vec3 const x = mesh.coordinates[n];
      if (x.y == 0) columns.height[n] = columns.full_rise[n] = height(x.x);
      if (x.y == 0 || x.y > height(x.x)) continue;
      columns.node.push_back(n);
      columns.root.push_back(at(x.x, 0));
      columns.below.push_back(at(x.x, x.y - 1));
      columns.above_wall.push_back(x.y);
      columns.rise.push_back(x.y);
    }
  }
  [[nodiscard]] Index32 at(double x, double y) const {
    for (Index32 n = 0; n < mesh.n_nodes(); ++n)
      if (mesh.coordinates[n].x == x && mesh.coordinates[n].y == y) return n;
    return -1;
  }
};

TEST(ColumnHeights, RoomIsLeftForTheMotion) {
  EXPECT_DOUBLE_EQ(room_in_gap(3, 0), 1);
  EXPECT_DOUBLE_EQ(room_in_gap(3, 1.1), 0.8);
  EXPECT_DOUBLE_EQ(room_in_gap(3, 50), 0.3);
}

TEST(ColumnHeights, BoundariesAheadLeaveAGapAndBoundariesBesideDoNot) {
  Channel const c([](double) { return 3.0; });
  std::vector<Index32> lid, side;
  for (Index32 n = 0; n < c.mesh.n_nodes(); ++n) {
    Vec3 const x = c.mesh.coordinates[n];
    if (x.y == 6) lid.push_back(n);
    if (x.x == 0) side.push_back(n);
  }
  auto const ahead = gaps_ahead(c.mesh.coordinates, c.columns, nearest_source(c.mesh.coordinates, c.graph, lid));
  auto const beside = gaps_ahead(c.mesh.coordinates, c.columns, nearest_source(c.mesh.coordinates, c.graph, side));
  for (double x = 0; x <= 8; ++x) {
    EXPECT_DOUBLE_EQ(ahead[c.at(x, 0)], 6) << x;
    EXPECT_EQ(beside[c.at(x, 0)], infinity) << x;
  }
}

TEST(ColumnHeights, AreLevelAndWithinTheirBounds) {
  Channel const c([](double x) { return x < 4 ? 1.0 : 5.0; });
  std::vector<double> most(c.columns.height.size(), infinity);
  most[c.at(7, 0)] = 2;
  ColumnEnds const even = smooth_ends(c.graph, c.columns, most);
  std::vector<double> const& height = even.height;
  for (double x = 0; x <= 8; ++x) {
    double const h = height[c.at(x, 0)];
    EXPECT_GE(h, 1) << x;
    EXPECT_LE(h, 2) << x;  // the least of three neighbours reaches from 7 and from 3 over all of the higher part
    if (x > 0) {
      EXPECT_LT(std::abs(h - height[c.at(x - 1, 0)]), 0.25) << x;
    }
  }
  Columns const ends = cut(c.columns, even);
  EXPECT_LT(ends.size(), c.columns.size());
  for (std::size_t k = 0; k < ends.node.size(); ++k) EXPECT_LE(ends.above_wall[k], height[ends.root[k]] * (1 + 1e-8));
}

// Of the columns at x < 2 the lengths, the rises or both are three times those of the others.
TEST(ColumnHeights, ColumnsOfLinesThatLeanAreEvenInLengthOrInRise) {
  for (auto const& [longer, higher] : {std::pair(true, false), std::pair(false, true), std::pair(true, true)}) {
    Channel c([](double x) { return x < 2 ? 6.0 : 2.0; });
    for (std::size_t k = 0; k < c.columns.node.size(); ++k) {
      if (c.mesh.coordinates[c.columns.root[k]].x >= 2) continue;
      if (!longer) c.columns.above_wall[k] /= 3;
      if (!higher) c.columns.rise[k] /= 3;
    }
    for (double x = 0; x < 2; ++x) {
      if (!longer) c.columns.height[c.at(x, 0)] /= 3;
      if (!higher) c.columns.full_rise[c.at(x, 0)] /= 3;
    }
    ColumnEnds const even = smooth_ends(c.graph, c.columns, std::vector<double>(c.columns.height.size(), infinity));
    bool const are_cut = longer && higher;
    EXPECT_EQ(cut(c.columns, even).size() < c.columns.size(), are_cut);
    for (double x = 0; x < 2; ++x) {
      auto const n = std::size_t(c.at(x, 0));
      EXPECT_NEAR(even.height[n] / c.columns.height[n], are_cut ? 1.0 / 3 : 1, 0.1) << x;
    }
  }
}

// One of them leans: it rises by a hundredth of its length, which must not make it longer than it may be.
TEST(ColumnHeights, AreNoLongerThanTheyMayBeHoweverTheyLean) {
  Channel c([](double) { return 5.0; });
  Index32 const leans = c.at(4, 0);
  for (std::size_t k = 0; k < c.columns.node.size(); ++k)
    if (c.columns.root[k] == leans) c.columns.rise[k] *= 0.01;
  c.columns.full_rise[leans] *= 0.01;
  std::vector<double> const most(c.columns.height.size(), infinity);
  std::vector<double> longest = most;
  for (double x = 0; x <= 8; ++x) longest[c.at(x, 0)] = 2;
  ColumnEnds const held = smooth_ends(c.graph, c.columns, most, longest);
  for (double x = 0; x <= 8; ++x) EXPECT_NEAR(held.height[c.at(x, 0)], 2, 1e-12) << x;
  Columns const ends = cut(c.columns, held);
  for (std::size_t k = 0; k < ends.node.size(); ++k) EXPECT_LE(ends.above_wall[k], 2 + 1e-9);
}

TEST(ColumnHeights, EvenColumnsStayAsTheyAre) {
  Channel const c([](double) { return 4.0; });
  ColumnEnds const even = smooth_ends(c.graph, c.columns, std::vector<double>(c.columns.height.size(), infinity));
  EXPECT_EQ(even.height, c.columns.height);
  EXPECT_EQ(cut(c.columns, even).node, c.columns.node);
}

}  // namespace
}  // namespace gridmorph::test
