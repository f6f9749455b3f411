// Targets given node for node.
#include <gtest/gtest.h>
#include <gridmorph/core/error.hpp>
#include <gridmorph/geometry/rigid_transform.hpp>

#include "target_cases.hpp"

namespace gridmorph::test {
namespace {

using Mapping = TargetRule::Mapping;

Vec3 bent(Vec3 const& x) { return {x.x + 0.1 * x.y, x.y + 0.02 * x.x * x.x, x.z + 0.15 * x.x * x.x - 0.1 * x.y}; }

/// A grid run through in another order: directions swapped, each reversed, a closed one started elsewhere.
TargetGrid rearranged(TargetGrid const& grid, bool swap, bool reverse0, bool reverse1, int start) {
  TargetGrid out{grid.name, swap ? std::array<int, 2>{grid.extent[1], grid.extent[0]} : grid.extent, {}};
  auto const from = [&](int a, int b) {
    if (start > 0) a = (a + start) % (grid.extent[0] - 1);
    if (reverse0) a = grid.extent[0] - 1 - a;
    if (reverse1) b = grid.extent[1] - 1 - b;
    return grid.points[std::size_t(a) + std::size_t(grid.extent[0]) * b];
  };
  for (int q = 0; q < out.extent[1]; ++q)
    for (int p = 0; p < out.extent[0]; ++p) out.points.push_back(swap ? from(q, p) : from(p, q));
  return out;
}

TEST(TargetNodes, ATargetThatIsTheBaselineMovesNothing) {
  Mesh const mesh = shell_mesh();
  TargetRun const run(mesh, rule_of(grids_of(mesh, same_place)));
  EXPECT_TRUE(run.stands_still());
  EXPECT_EQ(run.reach().mapping, Mapping::nodes);
}

TEST(TargetNodes, NodesGoToTheirPointsBitForBit) {
  Mesh const mesh = shell_mesh();
  TargetRun const run(mesh, rule_of(grids_of(mesh, bent)));
  for (int p = 0; p < 2; ++p) {
    auto const points = nodes_of(mesh, p);
    auto const u = run.displacement(p);
    for (std::size_t n = 0; n < points.size(); ++n) EXPECT_TRUE(u[n] == bent(points[n]) - points[n]);
  }
}

TEST(TargetNodes, EveryOrderOfTheGridsAndOfTheirDirectionsIsFound) {
  Mesh const mesh = shell_mesh();
  TargetGeometry const straight = grids_of(mesh, bent);
  for (int code = 0; code < 8; ++code) {
    TargetGeometry mixed;
    mixed.grids = {rearranged(straight.grids[1], (code & 1) != 0, (code & 2) != 0, (code & 4) != 0, 0),
                   rearranged(straight.grids[0], (code & 4) != 0, (code & 1) != 0, (code & 2) != 0, 0)};
    EXPECT_LT(TargetRun(mesh, rule_of(mixed)).error(bent), 1e-15) << code;
  }
}

TEST(TargetNodes, AClosedGridMayStartAnywhere) {
  Mesh const mesh = wing_mesh();
  TargetGeometry const straight = grids_of(mesh, bent);
  for (int const start : {1, 17, 59})
    for (bool const swap : {false, true})
      for (bool const reverse : {false, true}) {
        TargetGeometry turned;
        turned.grids = {rearranged(straight.grids[0], swap, reverse, !reverse, start)};
        EXPECT_LT(TargetRun(mesh, rule_of(turned)).error(bent), 1e-15) << start << swap << reverse;
      }
}

TEST(TargetNodes, ALargeTurnDoesNotConfuseTheOrder) {
  Mesh const mesh = wing_mesh();
  RigidTransform const turn = rotation_about({0.3, 1, 2}, {1, -1, 0.5}, 2.8);
  TargetGeometry turned = grids_of(mesh, [&](Vec3 const& x) { return turn(x); });
  turned.grids[0] = rearranged(turned.grids[0], true, true, false, 11);
  EXPECT_LT(TargetRun(mesh, rule_of(turned)).error([&](Vec3 const& x) { return turn(x); }), 1e-14);
}

TEST(TargetNodes, ListsOfPointsGoPatchAfterPatch) {
  Mesh const mesh = shell_mesh();
  TargetGeometry list;
  for (int p = 0; p < 2; ++p)
    for (Vec3 const& x : nodes_of(mesh, p)) list.nodes.push_back(bent(x));
  EXPECT_LT(TargetRun(mesh, rule_of(list, Mapping::nodes)).error(bent), 1e-15);
  list.nodes.pop_back();
  EXPECT_THROW(TargetRun(mesh, rule_of(list, Mapping::nodes)), MotionError);
}

TEST(TargetNodes, NodesThatCoincideMoveAlikeBitForBit) {
  Mesh const mesh = shell_mesh();
  TargetGeometry target = grids_of(mesh, bent);
  // Single precision in one of the pieces: copies of one place are not the same to the bit.
  for (Vec3& x : target.grids[1].points) x = {double(float(x.x)), double(float(x.y)), double(float(x.z))};
  TargetRun const run(mesh, rule_of(target));
  auto const left = run.displacement(0), right = run.displacement(1);
  int const n = target.grids[0].extent[0], m = target.grids[1].extent[0];
  for (int j = 0; j < target.grids[0].extent[1]; ++j)
    EXPECT_TRUE(left[std::size_t(n) * j + n - 1] == right[std::size_t(m) * j]) << j;
}

TEST(TargetNodes, PiecesThatComeApartAreAnError) {
  Mesh const mesh = shell_mesh();
  TargetGeometry target = grids_of(mesh, bent);
  for (Vec3& x : target.grids[1].points) x.z += 0.01;
  EXPECT_THROW(TargetRun(mesh, rule_of(target)), MotionError);
}

TEST(TargetNodes, GridsOfAnotherSizeAreAnErrorWhereNodesAreAskedFor) {
  Mesh const mesh = shell_mesh();
  EXPECT_THROW(TargetRun(mesh, rule_of(grids_of(shell_mesh(13, 10), same_place), Mapping::nodes)), MotionError);
}

TEST(TargetNodes, ReachIsTheDistanceFromTheOwnPoint) {
  Mesh const mesh = shell_mesh();
  TargetRun const run(mesh, rule_of(grids_of(mesh, bent)));
  EXPECT_LT(run.reach().max, 1e-15);
  auto const unmoved = run.surface.target_reach(mesh.coordinates).at(0);
  double worst = 0;
  for (int p = 0; p < 2; ++p)
    for (Vec3 const& x : nodes_of(mesh, p)) worst = std::max(worst, distance(x, bent(x)));
  EXPECT_NEAR(unmoved.max, worst, 1e-15);
  EXPECT_EQ(unmoved.nodes, Index(nodes_of(mesh, 0).size() + nodes_of(mesh, 1).size()));
}

TEST(TargetNodes, PointsThatAreNoNodesAreRefused) {
  Mesh const mesh = shell_mesh();
  TargetRun const run(mesh, rule_of(grids_of(mesh, bent)));
  std::vector<Vec3> const points{{0.1234, 0.2, 0.3}};
  std::vector<Vec3> out(1);
  EXPECT_THROW(run.surface.displacement(0, points, out), MotionError);
}

TEST(TargetNodes, ATargetOfPeriodicInterfacesIsRefused) {
  Mesh const mesh = translational(1, 3);
  Motion motion;
  motion.rules = {{{"type:periodic"}, rule_of(grids_of(shell_mesh(), same_place)), 0, "test"}};
  EXPECT_THROW(resolve(mesh, motion), MotionError);
}

}  // namespace
}  // namespace gridmorph::test
