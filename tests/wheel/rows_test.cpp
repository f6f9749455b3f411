// Turns, blade rows and coincident nodes of a wheel, on the demo passage and on made-up axes.
#include "support/expect_error.hpp"

#include <generators/passage.hpp>
#include <gridmorph/boundary/coverage.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/wheel/rows.hpp>
#include <gridmorph/wheel/shared_nodes.hpp>
#include <gridmorph/wheel/turn.hpp>
#include <gridmorph/wheel/wheel_mesh.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace gridmorph::test {
namespace {

TEST(Turns, QuarterTurnsPermuteComponentsExactly) {
  Axis const z{{0, 0, 0}, {0, 0, 2}};
  Vec3 const p{0.1, 0.7, 0.3};
  EXPECT_TRUE(Turn(z, 0, 12)(p) == p);
  EXPECT_TRUE(Turn(z, 36, 12)(p) == p);
  EXPECT_TRUE(Turn(z, 3, 12)(p) == (Vec3{-0.7, 0.1, 0.3}));
  EXPECT_TRUE(Turn(z, 6, 12)(p) == (Vec3{-0.1, -0.7, 0.3}));
  EXPECT_TRUE(Turn(z, -3, 12)(p) == (Vec3{0.7, -0.1, 0.3}));
}

TEST(Turns, AgreeWithTheRotationMatrixAboutAnyAxis) {
  Axis const axis{{0.3, -1, 2}, {1, 2, -0.5}};
  for (int step = -5; step < 40; ++step) {
    Turn const turn(axis, step, 17);
    RigidTransform const wanted = rotation_about(axis.origin, axis.direction, 2 * std::acos(-1.0) * step / 17);
    for (Vec3 const& p : {Vec3{1, 2, 3}, Vec3{-4, 0.5, 0.1}}) {
      EXPECT_LT(distance(turn(p), wanted(p)), 2e-14);
      EXPECT_LT(distance(turn.transform()(p), wanted(p)), 2e-14);
    }
  }
}

Mesh passage(int blades) {
  PassageOptions options;
  options.nodes = 10'000;
  options.blades = blades;
  return make_passage(options);
}

TEST(WheelRows, CountThePassagesOfTheWheel) {
  for (int const blades : {7, 36, 41}) {
    Mesh mesh = passage(blades);
    PassageLinks const links = passage_links(mesh, connect_and_check(mesh, {}), {});
    WheelRows const rows = find_rows(mesh, links, Axis{});
    ASSERT_EQ(rows.rows.size(), 1U);
    EXPECT_EQ(rows.rows[0].passages, blades);
    EXPECT_EQ(rows.rows[0].zones.size(), mesh.zones.size());
  }
}

TEST(WheelRows, AreRefusedAboutAnotherAxis) {
  Mesh mesh = passage(36);
  PassageLinks const links = passage_links(mesh, connect_and_check(mesh, {}), {});
  expect_all_in(message_of<MeshError>([&] {
                  find_rows(mesh, links, Axis{{0, 0, 0}, {0, 1, 0}});
                }),
                {"periodic", "does not turn about the axis"});
  expect_all_in(message_of<MeshError>([&] {
                  find_rows(mesh, links, Axis{{0, 0.01, 0}, {1, 0, 0}});
                }),
                {"360 / 36", "check the axis"});
}

TEST(WheelRows, SharedNodesCoincideInTheWheel) {
  Mesh mesh = passage(5);
  PassageLinks const links = passage_links(mesh, connect_and_check(mesh, {}), {});
  WheelRows const rows = find_rows(mesh, links, Axis{});
  SharedNodes const shared(links, rows, true);
  std::vector<Vec3> where(shared.n_groups());
  std::vector<char> seen(shared.n_groups(), 0);
  int across = 0;
  for (auto const& m : shared.members()) {
    // Node n of passage -offset is the group's point of passage 0.
    Vec3 const p = Turn(Axis{}, -m.offset, 5)(mesh.coordinates[m.node]);
    EXPECT_FALSE(shared.on_axis(m.group));
    if (seen[m.group] == 0) where[m.group] = p;
    seen[m.group] = 1;
    EXPECT_LT(distance(p, where[m.group]), 1e-14);
    across += m.offset != 0 ? 1 : 0;
  }
  EXPECT_GT(across, 0);
}

TEST(WheelMeshes, RefuseNamesThatGetTooLong) {
  Mesh mesh = passage(36);
  mesh.zones.front().name = std::string(30, 'z');
  PassageLinks const links = passage_links(mesh, connect_and_check(mesh, {}), {});
  WheelRows const rows = find_rows(mesh, links, Axis{});
  expect_all_in(message_of<MeshError>([&] { make_wheel_mesh(mesh, links, rows, {36}, WheelFamilies::shared); }),
                {std::string(30, 'z'), "34 characters of 32"});
}

}  // namespace
}  // namespace gridmorph::test
