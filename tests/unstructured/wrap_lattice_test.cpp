// The planes of a wrap's lattice, where they can be written down.
#include "bodies.hpp"

#include <gridmorph/plan/elements/wrap.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace gridmorph::test {
namespace {

constexpr LatticeBox domain{{0, 0, 0}, {9, 9, 9}};

Wrap lattice_of(Bodies const& bodies, WrapOptions const& options, int dimension = 3) {
  Mesh const mesh = bodies.in_domain({0, 0, 0}, {9, 9, 9}, dimension);
  auto const reach = detail::reaches_of(mesh.coordinates, {}, bodies.walls, options.offset);
  return detail::make_lattice(mesh, mesh.coordinates, bodies.walls, reach, domain, options);
}

void expect_planes(std::vector<double> const& found, std::vector<double> const& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t p = 0; p < found.size(); ++p) EXPECT_NEAR(found[p], expected[p], 1e-13) << p;
}

TEST(WrapLattice, OfABoxDividesItsLongestExtentAndTheOthersAlike) {
  Bodies bodies;
  bodies.box({3, 3, 3}, {6, 5, 4});
  for (double const margin : {0.0, 2.0}) {
    Wrap const wrap = lattice_of(bodies, {.offset = 0.5, .resolution = 4, .margin = margin});
    expect_planes(wrap.planes[0], {-margin, 2.5, 3.5, 4.5, 5.5, 6.5, 9 + margin});
    expect_planes(wrap.planes[1], {-margin, 2.5, 3.5, 4.5, 5.5, 9 + margin});
    expect_planes(wrap.planes[2], {-margin, 2.5, 3.5, 4.5, 9 + margin});
    EXPECT_NEAR(wrap.spacing, 1, 1e-13);
    EXPECT_NEAR(wrap.layer, 1, 1e-13);
    EXPECT_EQ(Index(wrap.inside.size()), wrap.n_cells());
    EXPECT_EQ(std::count(wrap.inside.begin(), wrap.inside.end(), 0), wrap.n_cells());
  }
}

TEST(WrapLattice, IsNotFinerThanHalfTheOffset) {
  Bodies bodies;
  bodies.box({4, 4, 4}, {5, 5, 5});
  Wrap const wrap = lattice_of(bodies, {.offset = 2, .resolution = 100});
  for (auto const& planes : wrap.planes) expect_planes(planes, {0, 2, 3, 4, 5, 6, 7, 9});
}

TEST(WrapLattice, LeavesTheWayBetweenBodiesToOneCell) {
  Bodies bodies;
  bodies.box({1, 4, 4}, {2, 5, 5});
  bodies.box({6, 4, 4}, {7, 5, 5});
  Wrap const wrap = lattice_of(bodies, {.offset = 0.5, .resolution = 2});
  expect_planes(wrap.planes[0], {0, 0.5, 1.5, 2.5, 5.5, 6.5, 7.5, 9});
  expect_planes(wrap.planes[1], {0, 3.5, 4.5, 5.5, 9});
  EXPECT_NEAR(wrap.spacing, 1, 1e-13) << "the way between does not count";
  // Less than a cell apart they are one.
  Bodies near;
  near.box({1, 4, 4}, {2, 5, 5});
  near.box({3.25, 4, 4}, {4.5, 5, 5});
  expect_planes(lattice_of(near, {.offset = 0.5, .resolution = 2}).planes[0], {-0.0625, 0.5, 1.625, 2.75, 3.875, 5, 9});
}

TEST(WrapLattice, GoesALittleBeyondALimitOfTheMeshThatTheBodyReaches) {
  Bodies bodies;
  bodies.box({0, 3, 3}, {3, 6, 6});
  Wrap const wrap = lattice_of(bodies, {.offset = 1, .resolution = 5});
  // 5 long with the offset: cells of 1, a quarter of one beyond the limit, half a cell to the outer box.
  double const low = -0.25, cell = (4 - low) / 4;
  expect_planes(wrap.planes[0], {low - 0.5, low, low + cell, low + 2 * cell, low + 3 * cell, 4, 9});
}

TEST(WrapLattice, OfAPlaneMeshIsOneCellDeep) {
  Bodies bodies;
  bodies.polygon({{3, 3, 0}, {6, 3, 0}, {6, 4, 0}, {3, 4, 0}});
  Wrap const wrap = lattice_of(bodies, {.offset = 0.5, .resolution = 4}, 2);
  expect_planes(wrap.planes[0], {0, 2.5, 3.5, 4.5, 5.5, 6.5, 9});
  expect_planes(wrap.planes[1], {0, 2.5, 3.5, 4.5, 9});
  expect_planes(wrap.planes[2], {-0.5, 0.5});
}

TEST(WrapLattice, HasNoMoreCellsThanAllowed) {
  Bodies bodies;
  bodies.box({2, 3, 3}, {7, 5, 6});
  Index before = 0;
  for (Index const most : {40, 300, 2000, 100'000}) {
    Wrap const wrap = lattice_of(bodies, {.offset = 0.1, .resolution = 40, .max_cells = most});
    EXPECT_LE(wrap.n_cells(), most);
    EXPECT_GT(wrap.n_cells(), before);
    before = wrap.n_cells();
    for (auto const& planes : wrap.planes) EXPECT_TRUE(std::is_sorted(planes.begin(), planes.end()));
  }
}

}  // namespace
}  // namespace gridmorph::test
