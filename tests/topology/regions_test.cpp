// Regions inside the domain: which cells they hold, and what is refused.
#include <gridmorph/boundary/regions.hpp>
#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/error.hpp>

#include "support/expect_error.hpp"
#include "support/mesh_builders.hpp"
#include "support/random.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace gridmorph::test {
namespace {

/// How many of the ranges hold each cell.
std::vector<int> held_by(Index3 const& cells, std::vector<IndexRange> const& boxes) {
  std::vector<int> out(cells[0] * cells[1] * cells[2], 0);
  for (IndexRange const& box : boxes)
    for (int k = box.begin[2]; k + 1 < box.end[2]; ++k)
      for (int j = box.begin[1]; j + 1 < box.end[1]; ++j)
        for (int i = box.begin[0]; i + 1 < box.end[0]; ++i) ++out[i + cells[0] * (j + cells[1] * k)];
  return out;
}

TEST(Regions, EveryCellInsideIsInExactlyOneBoxAndNoBoxCanShrink) {
  Index3 const cells{9, 8, 7};
  Random random(4);
  for (int share = 1; share <= 64; share *= 4) {
    std::vector<char> inside(cells[0] * cells[1] * cells[2], 0);
    for (int n = 0; n < share; ++n) inside[random.below(int(inside.size()))] = 1;
    std::vector<IndexRange> const boxes = boxes_of_cells(cells, inside);
    std::vector<int> const held = held_by(cells, boxes);
    for (std::size_t c = 0; c < inside.size(); ++c) {
      EXPECT_LE(held[c], 1);
      EXPECT_GE(held[c], int(inside[c]));
    }
    for (IndexRange const& box : boxes)
      for (int a = 0; a < 3; ++a)
        for (int layer = box.begin[a]; layer + 1 < box.end[a]; ++layer) {
          IndexRange one = box;
          one.begin[a] = layer;
          one.end[a] = layer + 2;
          std::vector<int> const of_layer = held_by(cells, {one});
          bool any = false;
          for (std::size_t c = 0; c < inside.size(); ++c) any = any || (of_layer[c] == 1 && inside[c] != 0);
          EXPECT_TRUE(any) << "layer " << layer << " along " << a;
        }
  }
}

TEST(Regions, ABoxOfCellsIsAPatchThatSelectorsFind) {
  Mesh mesh = box({9, 5, 5}, Shape::straight, 1);  // cells of 0.25 x 0.25 x 0.3
  std::size_t const patches = mesh.patches.size();
  InnerRegion wake;
  wake.name = "wake";
  wake.holds = [](Vec3 const& p) { return p.x > 0.5 && p.x < 1.5 && p.y < 0.5; };
  add_regions(mesh, std::vector{wake});
  ASSERT_EQ(mesh.patches.size(), patches + 1);
  EXPECT_EQ(mesh.patches.back().range, (IndexRange{{2, 0, 0}, {7, 3, 5}}));
  EXPECT_TRUE(is_box(mesh.patches.back()));
  EXPECT_EQ(select_patches(mesh, {"wake"}), std::vector<int>{int(patches)});
  EXPECT_EQ(select_patches(mesh, {"type:region"}), std::vector<int>{int(patches)});
  EXPECT_NE(mesh.notes.back().find("32 cells"), std::string::npos) << mesh.notes.back();
}

TEST(Regions, WhatCannotBeARegionIsSaidAllAtOnce) {
  Mesh mesh = box({9, 5, 5}, Shape::straight, 1);
  auto const named = [](std::string name) {
    InnerRegion r;
    r.name = std::move(name);
    r.zones = {"*"};
    return r;
  };
  InnerRegion nowhere = named("nowhere"), lost = named("lost"), outside = named("outside"), line = named("line"),
              face = named("face"), taken = named(mesh.patches.front().families.front());
  nowhere.holds = [](Vec3 const&) { return false; };
  lost.zones = {"no such zone"};
  outside.nodes = IndexRange{{0, 0, 0}, {10, 5, 5}};
  line.nodes = IndexRange{{1, 1, 0}, {2, 2, 5}};
  face.nodes = IndexRange{{0, 0, 0}, {1, 5, 5}};
  std::size_t const patches = mesh.patches.size();
  expect_all_in(message_of<MotionError>([&] {
                  add_regions(mesh, std::vector{nowhere, lost, outside, line, face, taken});
                }),
                {"'nowhere' holds none of the 128 cells", "there is no zone 'no such zone'",
                 "[1:10, 1:5, 1:5] are not all in zone", "are a line or a point", "are on the boundary of zone",
                 "the name is that of a patch"});
  EXPECT_GE(mesh.patches.size(), patches);
}

}  // namespace
}  // namespace gridmorph::test
