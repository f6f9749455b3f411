// The bounding box of a mesh, and whether its coordinates are numbers.
#include "support/mesh_builders.hpp"

#include <gridmorph/mesh/extent.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace gridmorph::test {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

TEST(MeshExtent, IsThatOfAPlainLoopForAnyNumberOfNodes) {
  // Below, at and above the lanes and chunks of the parallel pass.
  for (Index3 const& n : {Index3{2, 2, 2}, Index3{3, 3, 3}, Index3{32, 32, 16}, Index3{33, 32, 31}}) {
    Mesh const mesh = box(n, Shape::curved, 3);
    Vec3 low{inf, inf, inf}, high{-inf, -inf, -inf};
    for (Index m = 0; m < mesh.n_nodes(); ++m) {
      Vec3 const p = mesh.coordinates[m];
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    MeshExtent const found = extent_of(mesh.coordinates);
    EXPECT_EQ(found.low, low);
    EXPECT_EQ(found.high, high);
    EXPECT_TRUE(found.finite);
    EXPECT_EQ(mesh.size(), distance(low, high));
  }
}

TEST(MeshExtent, OneValueThatIsNoNumberIsFoundWhereverItIs) {
  for (double const bad : {inf, -inf, std::numeric_limits<double>::quiet_NaN()})
    for (Index const at : {Index(0), Index(5), Index(16383), Index(16384), Index(32 * 32 * 17 - 1)})
      for (int component = 0; component < 3; ++component) {
        Mesh const mesh = box({32, 32, 17}, Shape::straight, 0);
        (component == 0 ? mesh.coordinates.x : component == 1 ? mesh.coordinates.y : mesh.coordinates.z)(at) = bad;
        EXPECT_FALSE(extent_of(mesh.coordinates).finite) << bad << " at " << at << ", component " << component;
      }
}

TEST(MeshExtent, AMeshWithoutNodesHasNoSize) {
  EXPECT_EQ(extent_of(Coordinates()).size(), 0);
  EXPECT_TRUE(extent_of(Coordinates()).finite);
}

}  // namespace
}  // namespace gridmorph::test
