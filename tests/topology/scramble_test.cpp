// The test support itself: scrambled meshes are valid meshes of the same nodes.
#include "support/scramble.hpp"
#include "support/mesh_builders.hpp"

#include <gridmorph/boundary/links.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace gridmorph::test {
namespace {

std::vector<Mesh> meshes() {
  return {box({4, 5, 6}, Shape::curved, 1),
          bricks_with_t_junctions(2),
          l_shape(3),
          around_a_box(4),
          annulus_sector({}, 5),
          o_grid(1, 6),
          o_grid(0, 7),
          c_grid(8),
          star(3, 9),
          star(5, 10),
          translational(1, 11),
          translational(2, 12)};
}

TEST(Scramble, BuiltMeshesHaveNoFlaws) {
  for (Mesh const& mesh : meshes()) EXPECT_EQ(flaws(mesh, 1e-6), std::vector<std::string>()) << mesh.source;
}

TEST(Scramble, KeepsInterfacesShutAndFacesCovered) {
  for (Mesh const& mesh : meshes())
    for (unsigned seed = 1; seed < 6; ++seed) {
      Mesh const other = scramble(mesh, {seed, int(2 * seed)}).mesh;
      EXPECT_EQ(flaws(other, 1e-6), std::vector<std::string>()) << other.source;
      EXPECT_NO_THROW(connect(other, {})) << other.source;
    }
}

TEST(Scramble, HoldsEveryNodeWhereItWas) {
  for (Mesh const& mesh : meshes()) {
    ScrambledMesh const s = scramble(mesh, {4, 5});
    ASSERT_EQ(Index(s.old_node.size()), s.mesh.n_nodes());
    EXPECT_EQ(std::set<Index>(s.old_node.begin(), s.old_node.end()).size(), std::size_t(mesh.n_nodes()));
    for (Index n = 0; n < s.mesh.n_nodes(); ++n) EXPECT_EQ(s.mesh.coordinates[n], mesh.coordinates[s.old_node[n]]);
    EXPECT_GT(s.mesh.zones.size(), mesh.zones.size());
  }
}

TEST(Scramble, FlawsAreFound) {
  Mesh open = l_shape(1);
  open.coordinates.x(open.zones[0].node({open.zones[0].extent[0] - 1, 1, 1})) += 0.01;
  EXPECT_EQ(flaws(open, 1e-6).size(), 1u);
  Mesh bare = l_shape(1);
  bare.patches.pop_back();
  EXPECT_EQ(flaws(bare, 1e-6).size(), 1u);
}

}  // namespace
}  // namespace gridmorph::test
