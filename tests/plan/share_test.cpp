// Shares of plans: what they leave out, what a Morpher of one serves, what is refused. That nodes go to the same bits
// is an invariant of all cases.
#include <gridmorph/core/error.hpp>
#include <gridmorph/morph/morpher.hpp>
#include <gridmorph/morph/plan_access.hpp>
#include <gridmorph/morph/plan_share.hpp>
#include <gridmorph/plan/share.hpp>

#include "support/expect_error.hpp"
#include "support/morph_run.hpp"
#include "support/motions.hpp"
#include "support/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

namespace gridmorph::test {
namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;
using In = Morpher<Exec>::In;
using Out = Morpher<Exec>::Out;

/// Zones side by side along w, each between the wall u_min, which moves, and u_max, which stands.
Mesh side_by_side(int n) {
  Bricks bricks{"side by side", {7, 4, 4 * n + 1}, {}, [](Vec3 const& p) { return Vec3{2 * p.x, p.y, 5 * p.z}; }};
  for (int z = 0; z < n; ++z) bricks.zones.push_back({{0, 0, 4 * z}, {7, 4, 4 * z + 5}});
  return make(bricks);
}

Motion wall_moves() {
  return motion({rule({"u_min"}, function_rule(waves(0.1))), rule({"u_max"}, FixedRule{}),
                 rule({"v_min", "v_max", "w_min", "w_max"}, FreeRule{})});
}

std::vector<NodeBox> zones(Mesh const& mesh, std::vector<int> const& numbers) {
  std::vector<NodeBox> out;
  for (int const z : numbers) out.push_back({z, whole(mesh.zones[z])});
  return out;
}

/// Nodes of the skeleton that are swept, line parameters, values at ends of lines.
std::array<Index, 3> work(Plan const& plan) {
  std::array<Index, 3> out{};
  for (Stage const& stage : plan.stages) {
    for (kernels::SkeletonSweep const& sweep : stage.sweeps) out[0] += Index(sweep.n_p) * sweep.n_q;
    out[1] += stage.lines.n_parameters;
    out[2] += stage.lines.n_end_values;
  }
  return out;
}

TEST(Share, OfAllIsThePlanAndOfAFewZonesTheirPartOfIt) {
  Mesh const mesh = side_by_side(8);
  PreparedMorph const prepared = prepare(mesh, wall_moves(), without_near_field());
  auto const all = work(prepared.plan());
  EXPECT_EQ(work(share_of({}, prepared.plan(), mesh, zones(mesh, {0, 1, 2, 3, 4, 5, 6, 7}))), all);
  // The zones are one block to chains: of its lines those of one zone are kept.
  auto const some = work(share_of({}, prepared.plan(), mesh, zones(mesh, {3})));
  for (int k = 0; k < 3; ++k) {
    EXPECT_GT(some[k], 0);
    EXPECT_LT(some[k], all[k] / 2);
  }
  EXPECT_EQ(work(share_of({}, prepared.plan(), mesh, {})), (std::array<Index, 3>{}));
}

TEST(Share, HasTheLinesThatItsNodesDependOnAlone) {
  Mesh const mesh = around_a_box(2);
  PreparedMorph const prepared =
      prepare(mesh, motion({rule({"step"}, function_rule(waves(0.02))), rule({"u_*", "v_*", "w_*"}, FixedRule{})}),
              without_near_field());
  auto const all = work(prepared.plan());
  std::array<Index, 3> fewest = all;
  for (int z = 0; z < int(mesh.zones.size()); ++z) {
    auto const some = work(share_of({}, prepared.plan(), mesh, zones(mesh, {z})));
    for (int k = 0; k < 3; ++k) fewest[k] = std::min(fewest[k], some[k]);
  }
  for (int k = 0; k < 3; ++k) EXPECT_LT(fewest[k], all[k]);
}

TEST(Share, ServesArraysOfAnyKindSeveralFieldsAndVelocities) {
  Mesh const mesh = side_by_side(4);
  MorphPlan const plan(mesh, wall_moves());
  auto const boxes = zones(mesh, {2, 0});
  PlanShare const own_share = share({}, plan, mesh, boxes);
  ASSERT_EQ(own_share.n_nodes(), mesh.zones[2].size() + mesh.zones[0].size());
  EXPECT_EQ(own_share.boundary_nodes(), plan.boundary_nodes());
  EXPECT_EQ(own_share.boundary_displacement(), plan.boundary_displacement());

  using Floats = Kokkos::View<float* [3], Kokkos::LayoutRight, Kokkos::HostSpace>;
  using Doubles = Kokkos::View<double* [3], Kokkos::LayoutLeft, Kokkos::HostSpace>;
  Floats const x("x", mesh.n_nodes()), own_x("own_x", own_share.n_nodes());
  Mesh rounded = mesh;  // the plan is of the coordinates that the program has
  rounded.coordinates = Coordinates(mesh.n_nodes());
  Index own = 0;
  std::vector<Index> node_of;
  for (int const z : {2, 0})
    for (Index n = 0; n < mesh.zones[z].size(); ++n) node_of.push_back(mesh.zones[z].first_node + n);
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    Vec3 const p = mesh.coordinates[n];
    x(n, 0) = float(p.x), x(n, 1) = float(p.y), x(n, 2) = float(p.z);
    rounded.coordinates.set(n, {x(n, 0), x(n, 1), x(n, 2)});
  }
  for (Index const n : node_of) {
    for (int c = 0; c < 3; ++c) own_x(own, c) = x(n, c);
    ++own;
  }
  MorphPlan const of_floats(rounded, wall_moves());
  Exec const exec;
  Morpher<Exec> const morpher(exec, of_floats, x, {.fields = 2, .velocity = true});
  Morpher<Exec> const part(exec, share({}, of_floats, rounded, boxes), own_x, {.fields = 2, .velocity = true});
  auto b = of_floats.boundary_displacement();
  std::vector<Vec3> twice;
  for (Vec3 const& u : b) twice.push_back(2 * u);
  Kokkos::View<Vec3*, Kokkos::HostSpace> const given(b.data(), b.size()), other(twice.data(), twice.size());
  Doubles const u("u", mesh.n_nodes()), v("v", mesh.n_nodes()), own_u("own_u", own), own_v("own_v", own);
  auto const expect_same = [&](auto const& mine, auto const& all, char const* what) {
    exec.fence();
    for (Index n = 0; n < own; ++n)
      for (int c = 0; c < 3; ++c) ASSERT_EQ(mine(n, c), all(node_of[n], c)) << what << ' ' << n;
  };
  std::vector<In> const both{given, other};
  morpher.displacements(exec, both, std::vector<Out>{u, v});
  part.displacements(exec, both, std::vector<Out>{own_u, own_v});
  expect_same(own_u, u, "displacement");
  expect_same(own_v, v, "twice the displacement");
  morpher.velocities(exec, given, other, v);
  part.velocities(exec, given, other, own_v);
  expect_same(own_v, v, "velocity");
  morpher.positions(exec, given, x);
  part.positions(exec, given, own_x);
  expect_same(own_x, x, "position");
}

/// A guard's smoothing of two modes: random shifts of some nodes in space, and of points of the skeleton on a plane.
SmoothingMap some_smoothing(Mesh const& mesh, Plan const& plan) {
  Random random(9);
  SmoothingMap map;
  map.n_modes = 2;
  map.n_nodes = mesh.n_nodes();
  map.n_boundary = Index(plan.boundary_nodes.size());
  for (Index n = 0; n < 2 * map.n_boundary; ++n) map.gauge.push_back(random.vector(1));
  for (Index n = 0; n < map.n_nodes; n += 3) {
    map.node.push_back(n);
    for (int mode = 0; mode < 2; ++mode) map.shift.push_back(random.vector(0.01));
  }
  map.surfaces.emplace_back();
  map.surfaces.front().direction = {0, 0.6, 0.8};
  map.surfaces.front().size = 1;
  for (kernels::NodeCopy const& copy : plan.skeleton_nodes) {
    if (copy.matrix >= 0 || random.coin()) continue;
    kernels::SlidingShift slide{copy.source, copy.destination, -1, {0, -1, -1}, {0, 0, 0}, {}};
    slide.position = mesh.coordinates[copy.destination];
    map.slide_nodes.push_back({copy.destination, std::int32_t(map.slides.size()), -1});
    map.slides.push_back(slide);
    for (int mode = 0; mode < 2; ++mode) map.slide_shift.push_back(random.vector(0.01));
  }
  return map;
}

TEST(Share, HasWhatAGuardMovedItsNodesBy) {
  Mesh const mesh = around_a_box(3);
  MorphPlan const plan(mesh, motion({rule({"step"}, function_rule(waves(0.02))), rule({"u_*", "v_*"}, FixedRule{}),
                                     rule({"w_*"}, FreeRule{})}));
  MorphPlan const guarded =
      plan.with(std::make_shared<SmoothingMap const>(some_smoothing(mesh, *PlanAccess::chains(plan))));
  auto const moved = [&](auto const& plan_or_share, Coordinates const& x) {
    Coordinates out(x.size());
    Morpher<Exec> const morpher(Exec(), plan_or_share, x);
    morpher.positions(Exec(), upload<Kokkos::HostSpace>(plan.boundary_displacement()), out);
    Exec().fence();
    return out;
  };
  Coordinates const without = moved(plan, mesh.coordinates), with = moved(guarded, mesh.coordinates);
  EXPECT_GT(different_bits(without, with), mesh.n_nodes() / 3);
  // A zone twice, as if it were a layer of ghost nodes too, and another.
  auto const boxes = zones(mesh, {4, 1, 4});
  Coordinates x(2 * mesh.zones[4].size() + mesh.zones[1].size()), expected(x.size());
  Index own = 0;
  for (int const z : {4, 1, 4})
    for (Index n = 0; n < mesh.zones[z].size(); ++n, ++own) {
      x.set(own, mesh.coordinates[mesh.zones[z].first_node + n]);
      expected.set(own, with[mesh.zones[z].first_node + n]);
    }
  PlanShare const own_share = share({}, guarded, mesh, boxes);
  EXPECT_EQ(different_bits(moved(own_share, x), expected), 0);
  EXPECT_EQ(different_bits(moved(PlanShare::from_bytes(own_share.to_bytes()), x), expected), 0);
}

TEST(Share, RefusesWhatItCannotBe) {
  Mesh const mesh = side_by_side(3);
  MorphPlan const plan(mesh, wall_moves());
  auto const of = [&](std::vector<NodeBox> const& boxes) { return share({}, plan, mesh, boxes); };
  expect_all_in(message_of<ConfigError>([&] { of({{3, whole(mesh.zones[0])}}); }), {"zone 3", "3 zones"});
  expect_all_in(message_of<ConfigError>([&] { of({{-1, whole(mesh.zones[0])}}); }), {"zone -1"});
  for (IndexRange const& nodes : {IndexRange{{0, 0, 0}, {8, 4, 5}}, IndexRange{{-1, 0, 0}, {7, 4, 5}},
                                  IndexRange{{0, 2, 0}, {7, 2, 5}}, IndexRange{{0, 3, 0}, {7, 1, 5}}})
    expect_all_in(message_of<ConfigError>([&] {
                    of({{1, nodes}});
                  }),
                  {to_string(nodes), mesh.zones[1].name, "[1:7, 1:4, 1:5]"});
  Mesh other = side_by_side(2);
  expect_all_in(message_of<ConfigError>([&] { (void)share({}, plan, other, {}); }),
                {"mesh of 420 nodes", "this one has 280"});
}

}  // namespace
}  // namespace gridmorph::test
