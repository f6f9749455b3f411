// The bounding box of a mesh, whether its coordinates are numbers, and which can belong to one mesh.
#include "support/mesh_builders.hpp"

#include <gridmorph/mesh/extent.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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

// A far field 1e5 chords away is one; a node that lies beyond what 1e-8 of the mesh's size leaves of the chord is not.
TEST(MeshCore, TellsFarFieldsFromNodesThatAreNone) {
  Mesh ring = box({40, 60, 2}, Shape::straight, 0);
  Zone const zone = ring.zones[0];
  for (double const unit : {1e-3, 1.0, 25.4})
    for (double const far : {10.0, 1e3, 1e5}) {
      // A ring of cells that grow from 1e-6 chords on out to the far field.
      for (int j = 0; j < zone.extent[1]; ++j)
        for (int i = 0; i < zone.extent[0]; ++i) {
          double const angle = 0.16 * i, r = 0.5 + 1e-6 * std::pow(1e6 * far, double(j) / (zone.extent[1] - 1));
          for (int k = 0; k < zone.extent[2]; ++k)
            ring.coordinates.set(zone.node({i, j, k}), unit * Vec3{r * std::cos(angle), r * std::sin(angle), 0.1 * k});
        }
      MeshCore const core = core_of(ring.coordinates);
      EXPECT_GT(core.radius, 0.1 * unit);
      EXPECT_LT(core.radius, 2 * unit);
      for (Index n = 0; n < ring.n_nodes(); ++n) EXPECT_FALSE(core.is_far(ring.coordinates[n])) << far;
      EXPECT_FALSE(core.is_rounded_away(2 * far * unit));
      EXPECT_TRUE(core.is_far({0, 1e9 * unit, 0}));
      EXPECT_TRUE(core.is_rounded_away(1e16 * unit));
    }
}

TEST(MeshCore, OfNodesAtOnePlaceHasNoneFarAway) {
  Coordinates c(3);
  for (Index n = 0; n < 3; ++n) c.set(n, {0.5, 0, 0});
  EXPECT_FALSE(core_of(c).is_far({1, 0, 0}));
  EXPECT_FALSE(core_of(Coordinates()).is_far({1, 0, 0}));
  c.set(1, {0.5, 2, 0});
  EXPECT_EQ(core_of(c).radius, 2);
}

}  // namespace
}  // namespace gridmorph::test
