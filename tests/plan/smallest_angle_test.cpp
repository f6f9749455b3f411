// The smallest angle of a piece against the angles of its cells' faces one by one, and against formulas.
#include "support/mesh_builders.hpp"

#include <gridmorph/plan/blocks/plan_basis.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace gridmorph::test {
namespace {

/// Every cell of the box, every corner, every pair of its three edges.
double reference(Mesh const& mesh, NodeBox const& box) {
  Zone const& zone = mesh.zones[box.zone];
  double largest = -1;
  auto const& [lo, hi] = box.nodes;
  for (int k = lo[2]; k + 1 < hi[2]; ++k)
    for (int j = lo[1]; j + 1 < hi[1]; ++j)
      for (int i = lo[0]; i + 1 < hi[0]; ++i)
        for (int corner = 0; corner < 8; ++corner) {
          Index3 const at{i + corner % 2, j + corner / 2 % 2, k + corner / 4};
          Vec3 edge[3];
          for (int a = 0; a < 3; ++a) {
            Index3 other = at;
            other[a] += (corner >> a) % 2 == 0 ? 1 : -1;
            edge[a] = mesh.coordinates[zone.node(other)] - mesh.coordinates[zone.node(at)];
          }
          for (int a = 0; a < 3; ++a)
            for (int b = a + 1; b < 3; ++b)
              if (double const length = norm(edge[a]) * norm(edge[b]); length > 0)
                largest = std::max(largest, dot(edge[a], edge[b]) / length);
        }
  return largest;
}

std::vector<NodeBox> whole_zones(Mesh const& mesh) {
  std::vector<NodeBox> boxes;
  for (int z = 0; z < int(mesh.zones.size()); ++z) boxes.push_back({z, whole(mesh.zones[z])});
  return boxes;
}

void expect_reference(Mesh const& mesh, std::vector<NodeBox> const& boxes) {
  std::vector<double> const found = largest_cosines({}, mesh, boxes);
  ASSERT_EQ(found.size(), boxes.size());
  for (std::size_t b = 0; b < boxes.size(); ++b)
    EXPECT_NEAR(found[b], reference(mesh, boxes[b]), 4e-16) << mesh.source << ", box " << b;
}

TEST(SmallestAngle, IsThatOfTheCellCornersOfEveryMesh) {
  for (Mesh const& mesh : {box({5, 4, 3}, Shape::curved, 1), bricks_with_t_junctions(2), star(5, 3), c_grid(4),
                           annulus_sector({}, 5), box({2, 2, 2}, Shape::curved, 6)})
    expect_reference(mesh, whole_zones(mesh));
}

TEST(SmallestAngle, EdgesWithoutLengthHaveNone) { expect_reference(o_grid(0, 7), whole_zones(o_grid(0, 7))); }

TEST(SmallestAngle, NodesOutsideTheBoxDoNotCount) {
  Mesh mesh = box({7, 6, 5}, Shape::curved, 8);
  double const nan = std::numeric_limits<double>::quiet_NaN();
  NodeBox const inner{0, {{2, 1, 1}, {5, 5, 4}}};
  double const expected = reference(mesh, inner);
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    if (!inner.nodes.contains(mesh.zones[0].index(n))) mesh.coordinates.set(n, {nan, nan, nan});
  EXPECT_NEAR(largest_cosines({}, mesh, std::vector{inner}).front(), expected, 4e-16);
}

TEST(SmallestAngle, IsAChosenOneInAShearedBoxAndARightOneInAStraightBox) {
  Mesh const straight = box({4, 4, 4}, Shape::straight, 0);
  EXPECT_NEAR(largest_cosines({}, straight, whole_zones(straight)).front(), 0, 1e-15);
  double const angle_rad = 0.3;
  Mesh sheared = box({4, 4, 4}, Shape::straight, 0);
  for (Index n = 0; n < sheared.n_nodes(); ++n) {
    Vec3 const p = sheared.coordinates[n];
    sheared.coordinates.set(n, {p.x + p.z / std::tan(angle_rad), p.y, p.z});
  }
  EXPECT_NEAR(std::acos(largest_cosines({}, sheared, whole_zones(sheared)).front()), angle_rad, 1e-13);
}

TEST(SmallestAngle, NoBoxesAreNoWork) {
  EXPECT_TRUE(largest_cosines({}, box({3, 3, 3}, Shape::straight, 0), {}).empty());
}

}  // namespace
}  // namespace gridmorph::test
