// Zones that touch although no connection says so.
#include "support/made_bodies.hpp"
#include "support/unstructured_case.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/mesh/undeclared_connections.hpp>

#include <gtest/gtest.h>

#include <cstring>

namespace gridmorph {
namespace {

using namespace test;
using Case = UnstructuredCase;

/// A box around a body in two zones that touch at x = 8; no connection, but a patch on either side: "left", "right".
/// The right zone's nodes there are off by `gap`.
struct TwoZones {
  Mesh mesh;
  std::vector<std::pair<Index32, Index32>> pairs;
};
TwoZones two_zones(PatchKind kind, double gap) {
  TwoZones out{test::in_two_zones(test::box_around(
                                      {14, 9, 9},
                                      [](Vec3 const& p) {
                                        return norm(p - Vec3{5, 4.5, 4.5}) < 2;
                                      },
                                      true),
                                  [](Vec3 const& p) { return p.x < 8; }),
               {}};
  auto const connection = out.mesh.connections.front();
  out.mesh.connections.clear();
  for (bool const right : {false, true}) {
    Patch patch;
    patch.name = right ? "right" : "left";
    patch.kind = kind;
    patch.zone = right ? connection.donor_zone : connection.zone;
    patch.nodes = right ? connection.donor_nodes : connection.nodes;
    std::sort(patch.nodes.begin(), patch.nodes.end());
    out.mesh.patches.push_back(std::move(patch));
  }
  for (std::size_t n = 0; n < connection.nodes.size(); ++n) {
    out.pairs.emplace_back(connection.nodes[n], connection.donor_nodes[n]);
    out.mesh.coordinates.y(connection.donor_nodes[n]) += gap;
  }
  return out;
}

bool equal_bits(Vec3 const& a, Vec3 const& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

TEST(TouchingZones, NodesThatCoincideMoveAsOne) {
  for (double const gap : {0.0, 1e-8}) {
    TwoZones const t = two_zones(PatchKind::other, gap);
    Case const c(t.mesh);
    auto const m =
        c.morph(motion_of({rule_for({"body"}, translation({0.5, 0, 0.2})), rule_for({"left", "right"}, FreeRule{})}));
    double largest = 0;
    Coordinates const u(c.mesh.n_nodes());
    auto const morpher = MorpherAccess::of(Case::Host(), m.prepared.plan, c.mesh.coordinates);
    morpher.displacements({}, Kokkos::View<Vec3 const*, Kokkos::HostSpace>(m.boundary.data(), m.boundary.size()), u);
    Case::Host().fence();
    for (auto const& [a, b] : t.pairs) {
      largest = std::max(largest, norm(u[a]));
      EXPECT_TRUE(equal_bits(u[a], u[b])) << a;
    }
    EXPECT_GT(largest, 0.05);
    EXPECT_EQ(c.inverted(m.x), 0);
  }
}

TEST(TouchingZones, ARuleForOneSideHoldsForBoth) {
  TwoZones const t = two_zones(PatchKind::other, 0);
  Case const c(t.mesh);
  auto const m =
      c.morph(motion_of({rule_for({"left"}, translation({0.3, 0, 0})), rule_for({"*_min", "*_max"}, FreeRule{})}));
  for (auto const& [a, b] : t.pairs) {
    EXPECT_NEAR(m.x[a].x - c.mesh.coordinates[a].x, 0.3, 1e-14);
    EXPECT_TRUE(equal_bits(m.x[a], m.x[b]));
  }
}

TEST(TouchingZones, PlanesThatSlideStayTwo) {
  TwoZones const t = two_zones(PatchKind::connection, 0);
  auto const place = nodes_at_one_place(t.mesh);
  for (auto const& [a, b] : t.pairs) EXPECT_NE(place[a], place[b]);
}

TEST(TouchingZones, NodesFartherApartThanTheToleranceStayTwo) {
  TwoZones const t = two_zones(PatchKind::other, 1e-5);
  auto const place = nodes_at_one_place(t.mesh);
  for (auto const& [a, b] : t.pairs) EXPECT_NE(place[a], place[b]);
}

// Both sides of a mixing plane between rows.
TEST(TouchingZones, NodesOfDifferentGroupsStayTwo) {
  TwoZones const t = two_zones(PatchKind::other, 0);
  std::vector<int> group(t.mesh.n_nodes(), 0);
  for (auto const& [left, right] : t.pairs) group[left] = 1;
  auto const place = nodes_at_one_place(HostInstance(), t.mesh, group);
  for (auto const& [left, right] : t.pairs) EXPECT_NE(place[left], place[right]);
  for (auto const& [left, right] : t.pairs) group[right] = 1;
  auto const joined = nodes_at_one_place(HostInstance(), t.mesh, group);
  for (auto const& [left, right] : t.pairs) EXPECT_EQ(joined[left], joined[right]);
}

}  // namespace
}  // namespace gridmorph
