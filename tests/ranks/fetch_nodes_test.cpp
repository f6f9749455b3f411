// Coordinates come from the homes of their nodes, whoever has copies of them.
#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/fetch_nodes.hpp>

#include "ranks/drawn_parts.hpp"
#include "ranks/world.hpp"
#include "support/expect_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace gridmorph::test {
namespace {

Vec3 place_of(Mesh const& mesh, int zone, Index3 const& p) {
  double const n = double(mesh.zones[zone].node(p));
  return {std::sin(n), n, 1 / (1 + n)};
}

/// Coordinates of own parts: of copies whose home is another part none, so that nobody gets theirs.
Coordinates own_coordinates(Mesh const& mesh, Distribution const& distribution) {
  Coordinates out(distribution.n_nodes());
  double const nan = std::numeric_limits<double>::quiet_NaN();
  for (Part const& part : distribution.own())
    for_indices(part.nodes, [&](Index3 const& p) {
      Part const& home = distribution.home(part.zone, p);
      bool const is_home = home.rank == part.rank && home.first_node == part.first_node;
      out.set(part.node(p), is_home ? place_of(mesh, part.zone, p) : Vec3{nan, nan, nan});
    });
  return out;
}

/// Boxes of this rank: some, one of no node among them, on some ranks none at all.
std::vector<NodeBox> drawn_boxes(Mesh const& mesh, Ranks const& ranks, Random& random) {
  std::vector<NodeBox> out;
  for (int r = 0; r < ranks.size(); ++r) {
    int const n = random.below(4) == 0 ? 0 : random.below(8);
    for (int b = 0; b < n; ++b) {
      int const z = random.below(int(mesh.zones.size()));
      NodeBox const box{z, drawn_range(mesh.zones[z], random)};
      if (r == ranks.rank()) out.push_back(box);
    }
  }
  return out;
}

TEST(FetchNodes, BringsCoordinatesFromTheirHomes) {
  auto const ranks = world();
  Random random(7);  // the same zones, parts and boxes on all ranks
  for (Joint const joint : {Joint::none, Joint::plane, Joint::layers})
    for (int time = 0; time < 6; ++time) {
      Mesh const mesh = drawn_zones(4, 18, random);
      Distribution const distribution(ranks, mesh, drawn_parts(mesh, ranks->size(), joint, random));
      auto const boxes = drawn_boxes(mesh, *ranks, random);
      Coordinates const fetched = fetch_nodes(distribution, own_coordinates(mesh, distribution), boxes);
      Index n = 0, n_differ = 0;
      for (NodeBox const& box : boxes)
        for_indices(box.nodes, [&](Index3 const& p) {
          Vec3 const x = fetched[n++], y = place_of(mesh, box.zone, p);
          n_differ += x.x != y.x || x.y != y.y || x.z != y.z;
        });
      EXPECT_EQ(fetched.size(), n);
      EXPECT_EQ(n_differ, 0);
    }
}

TEST(FetchNodes, FailsOnAllRanksWhereABoxLeavesItsZone) {
  auto const ranks = world();
  Mesh mesh;
  mesh.add_zone("A", {4, 4, 4});
  Distribution const distribution(ranks, mesh, {{0, {{0, 0, 0}, {4, 4, 4}}, 0}});
  Coordinates const own = own_coordinates(mesh, distribution);
  std::vector<NodeBox> boxes{{0, {{0, 0, 0}, {2, 2, 2}}}};
  if (ranks->rank() == ranks->size() - 1) boxes.push_back({0, {{0, 0, 0}, {2, 2, 5}}});
  expect_all_in(message_of<MeshError>([&] { (void)fetch_nodes(distribution, own, boxes); }),
                {"zone 'A'", "[1:2, 1:2, 1:5]"});
}

TEST(FetchNodes, RefusesCoordinatesOfOtherParts) {
  auto const ranks = world();
  Mesh mesh;
  mesh.add_zone("A", {4, 4, 4});
  Distribution const distribution(ranks, mesh, {{0, {{0, 0, 0}, {4, 4, 4}}, 0}});
  Coordinates const own(distribution.n_nodes() + (ranks->rank() == 0 ? 1 : 0));
  expect_all_in(message_of<MeshError>([&] { (void)fetch_nodes(distribution, own, {}); }), {"64 nodes", "65"});
}

TEST(Distribution, IsRefusedWhereRanksHaveDifferentLists) {
  auto const ranks = world();
  if (ranks->size() == 1) GTEST_SKIP() << "one process has one list";
  Mesh mesh;
  mesh.add_zone("A", {4, 4, 4});
  std::vector<Part> parts{{0, {{0, 0, 0}, {4, 4, 4}}, 0}};
  if (ranks->rank() == 1) parts.push_back({0, {{1, 1, 1}, {2, 2, 2}}, 1});
  expect_all_in(message_of<MeshError>([&] { Distribution(ranks, mesh, parts); }), {"different zones or parts"});
}

}  // namespace
}  // namespace gridmorph::test
