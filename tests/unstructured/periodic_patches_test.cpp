// Files that list a periodic boundary twice, as a patch and as a connection: the patch does not hold what the connection lets go.
#include "support/unstructured_meshes.hpp"

#include <gridmorph/motion/boundary_conditions.hpp>

#include <gtest/gtest.h>

#include <algorithm>

namespace gridmorph::test {
namespace {

/// A channel, periodic from i_min to i_max, whose lid j_max moves along.
struct PeriodicChannel {
  Mesh mesh = flat_box(6, 4, 2);
  Motion motion;

  PeriodicChannel() {
    Connection c;
    c.name = "pair";
    c.zone = c.donor_zone = 0;
    c.periodic.emplace();
    c.periodic->translation = {6, 0, 0};
    for (double y = 0; y <= 4; ++y) {
      c.nodes.push_back(at(0, y));
      c.donor_nodes.push_back(at(6, y));
    }
    mesh.connections.push_back(c);
    motion.rules.push_back({{"j_max"}, RigidRule{{}, {0.3, 0, 0}}, 0, "test"});
  }
  [[nodiscard]] Index32 at(double x, double y) const {
    for (Index32 n = 0; n < mesh.n_nodes(); ++n)
      if (mesh.coordinates[n].x == x && mesh.coordinates[n].y == y) return n;
    return -1;
  }
  [[nodiscard]] BoundaryConditions conditions() const {
    auto const topology = make_topology(mesh);
    return boundary_conditions(mesh, topology, find_face_patches(mesh, topology),
                               make_node_graph(mesh, topology.elements_of_nodes), motion, {});
  }
  [[nodiscard]] bool holds(BoundaryConditions const& b, double x, double y) const {
    return std::binary_search(b.known.begin(), b.known.end(), at(x, y));
  }
};

TEST(PeriodicPatches, AreFreeWhereNoRuleNamesThem) {
  PeriodicChannel const c;
  auto const b = c.conditions();
  for (double const x : {0., 6.}) EXPECT_FALSE(c.holds(b, x, 2)) << x;
  EXPECT_TRUE(c.holds(b, 3, 0));
  EXPECT_TRUE(c.holds(b, 0, 4));
  EXPECT_EQ(b.images.size(), 3u);  // at the ends both nodes are held
  EXPECT_TRUE(std::any_of(b.notes.begin(), b.notes.end(), [](std::string const& note) {
    return note.find("'i_min', 'i_max'") != std::string::npos && note.find("free") != std::string::npos;
  }));
}

TEST(PeriodicPatches, ObeyARuleThatNamesThem) {
  PeriodicChannel c;
  c.motion.rules.push_back({{"i_*"}, FixedRule{}, 1, "test"});
  auto const b = c.conditions();
  for (double const x : {0., 6.}) EXPECT_TRUE(c.holds(b, x, 2)) << x;
}

TEST(PeriodicPatches, ThatAreOnlyPartlyPairedStayFixed) {
  PeriodicChannel c;
  auto& pair = c.mesh.connections.front();
  pair.nodes.pop_back();
  pair.donor_nodes.pop_back();
  auto const b = c.conditions();
  for (double const x : {0., 6.}) EXPECT_TRUE(c.holds(b, x, 2)) << x;
}

}  // namespace
}  // namespace gridmorph::test
