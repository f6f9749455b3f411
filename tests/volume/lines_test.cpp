// Poles, lines of no length, near fields, and the uses of a Morpher.
#include <gridmorph/core/error.hpp>

#include "support/morph_run.hpp"
#include "support/motions.hpp"
#include "support/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace gridmorph::test {
namespace {

std::vector<std::string> const sides{"v_min", "v_max", "w_min", "w_max"};

PlanOptions near_field(BoundaryLayer::Extent extent, int layers, double thickness = 0) {
  PlanOptions options;
  options.boundary_layers = {{{"u_min"}, extent, layers, thickness, BoundaryLayer::Mode::translate}};
  return options;
}

/// All u lines shrink to a point where v = 0.
Mesh wedge_with_a_collapsed_face() {
  Bricks b;
  b.name = "wedge";
  b.extent = {6, 5, 4};
  b.position = [](Vec3 const& q) { return Vec3{2 * q.x * q.y, q.y, q.z + 0.1 * q.x * q.y}; };
  return make(b);
}

TEST(Lines, OfNoLengthAreDividedByNodeCount) {
  Mesh mesh = wedge_with_a_collapsed_face();
  PreparedMorph const prepared =
      prepare(mesh, motion({rule({"u_min", "u_max"}, function_rule(waves(0.1))), rule(sides, FreeRule{})}),
              without_near_field());
  // The two ends of a collapsed line are asked for different displacements.
  Random random(2);
  std::vector<Vec3> boundary(prepared.plan().boundary_nodes.size());
  for (Vec3& v : boundary) v = random.vector(1);
  Morphed const out = run_plan(Kokkos::DefaultHostExecutionSpace(), mesh, prepared.plan(), boundary);
  Zone const& zone = mesh.zones[0];
  for (int k = 0; k < 4; ++k) {
    Vec3 const u0 = out.displacement[zone.node({0, 0, k})], u1 = out.displacement[zone.node({5, 0, k})];
    for (int i = 0; i < 6; ++i)
      EXPECT_LT(distance(out.displacement[zone.node({i, 0, k})], u0 + (i / 5.0) * (u1 - u0)), 1e-15);
  }
}

/// Displacement along the lines of a straight box with even spacing whose one wall moves by one unit, 3 of 12 layers as
/// one.
std::vector<double> along_a_box(std::string const& wall, std::string const& opposite, VolumeOptions const& volume) {
  PlanOptions options;
  options.boundary_layers = {{{wall}, BoundaryLayer::Extent::layers, 3, 0, BoundaryLayer::Mode::translate}};
  options.volume = volume;
  Outcome const r = morph(box({13, 4, 3}, Shape::straight, 1),
                          motion({rule({wall}, function_rule([](Vec3 const&) {
                                         return Vec3{0, 1, 0};
                                       })),
                                  rule({opposite}, FixedRule{}), rule(sides, FreeRule{})}),
                          options);
  std::vector<double> out;
  for (int i = 3; i < 13; ++i) out.push_back(r.u(r.mesh.zones[0].node({wall == "u_min" ? i : 12 - i, 2, 1})).y);
  return out;
}

TEST(Laws, MatchedLeavesNearFieldsWithTheirSlopeAndEndsWithoutCurvature) {
  VolumeOptions volume;
  volume.law = Law::matched;
  for (auto const& [wall, opposite] : {std::pair("u_min", "u_max"), std::pair("u_max", "u_min")}) {
    std::vector<double> const u = along_a_box(wall, opposite, volume);
    for (int n = 0; n < 10; ++n) {
      double const t = n / 9.0;
      EXPECT_NEAR(u[n], 1 - (3 * t * t - t * t * t) / 2, 1e-14) << wall << ' ' << n;
    }
  }
}

TEST(Laws, MixedIsPartOfTheLinearAndPartOfTheC1Law) {
  VolumeOptions volume;
  volume.law = Law::mixed;
  for (double const share : {0.0, 0.6, 1.0}) {
    volume.linear_share = share;
    std::vector<double> const u = along_a_box("u_min", "u_max", volume);
    for (int n = 0; n < 10; ++n) {
      double const t = n / 9.0;
      EXPECT_NEAR(u[n], 1 - (share * t + (1 - share) * t * t * (3 - 2 * t)), 1e-14);
    }
  }
}

TEST(Laws, GoByTheKindsOfTheEndsOfChainsInEitherOrder) {
  for (auto const& between : {std::array<std::string, 2>{"wall", "inflow"}, {"inflow", "wall"}, {"wall", "outflow"}}) {
    VolumeOptions volume;
    volume.laws = {{between, Law::c1}};
    bool const fits = between[0] != "wall" || between[1] != "outflow";
    std::vector<double> const u = along_a_box("u_min", "u_max", volume);
    double const t = 2 / 9.0;
    EXPECT_NEAR(u[2], 1 - (fits ? t * t * (3 - 2 * t) : t), 1e-14);
  }
}

OwnLaw square() {
  return {[](double t) { return t * t; }, "square"};
}

TEST(Laws, OfTheUsersOwnStartFromTheEndThatRanksBetter) {
  VolumeOptions volume;
  volume.law = Law::own;
  volume.own_law = square();
  std::vector<double> const u = along_a_box("u_min", "u_max", volume);
  for (int n = 0; n < 10; ++n) EXPECT_NEAR(u[n], 1 - n * n / 81.0, 1e-14) << "from the wall to the inflow, node " << n;
  // The same box seen from the other side: the wall stands still, and the law starts from it all the same.
  std::vector<double> const v = along_a_box("u_max", "u_min", volume);
  for (int n = 0; n < 10; ++n) EXPECT_NEAR(v[n], (9 - n) * (9 - n) / 81.0, 1e-14) << n;
}

TEST(Laws, BetweenPatchesStartFromTheFirstOfThem) {
  for (auto const& [wall, opposite] : {std::pair("u_min", "u_max"), std::pair("u_max", "u_min")})
    for (bool const from_wall : {true, false}) {
      VolumeOptions volume;
      // A selector that fits nothing here, one of a patch that chains do not end on, and the ends of the chain.
      volume.laws = {{{wall, "v_min"}, Law::c1},
                     {{from_wall ? wall : opposite, from_wall ? opposite : wall}, Law::own, square()}};
      std::vector<double> const u = along_a_box(wall, opposite, volume);
      for (int n = 0; n < 10; ++n) {
        double const t = n / 9.0;
        EXPECT_NEAR(u[n], from_wall ? 1 - t * t : (1 - t) * (1 - t), 1e-14) << wall << ' ' << from_wall << ' ' << n;
      }
    }
}

TEST(Laws, OfTheUsersOwnBetweenEndsThatRankAlikeAreTheSameFromBoth) {
  VolumeOptions volume;
  volume.laws = {{{"u_*", "u_*"}, Law::own, square()}};
  std::vector<double> const u = along_a_box("u_min", "u_max", volume);
  for (int n = 0; n < 10; ++n) EXPECT_NEAR(u[n], 1 - n / 9.0, 1e-14) << "(t^2 + 1 - (1 - t)^2) / 2 = t, node " << n;
}

TEST(Laws, OfTheUsersOwnThatAreTheC1LawGiveItsMesh) {
  Motion const m =
      motion({rule({"step"}, function_rule(turn_about_z({1.2, 0.6, 0}, 0.1))),
              rule({"u_min", "u_max", "v_min", "v_max"}, FixedRule{}), rule({"w_min", "w_max"}, FreeRule{})});
  PlanOptions options;
  options.boundary_layers = {{{}, BoundaryLayer::Extent::layers, 1, 0, BoundaryLayer::Mode::translate}};
  options.volume.law = Law::c1;
  Outcome const c1 = morph(around_a_box(7), m, options);
  options.volume.law = Law::own;
  options.volume.own_law = {[](double t) { return t * t * (3 - 2 * t); }, "c1"};
  Outcome const own = morph(around_a_box(7), m, options);
  for (Index n = 0; n < own.mesh.n_nodes(); ++n) EXPECT_LT(distance(own.u(n), c1.u(n)), 1e-14) << n;
}

TEST(Lines, NodesThatMeetOnAPoleMoveAsOne) {
  for (bool free : {false, true}) {
    Mesh mesh = o_grid(0, 1);
    std::vector<MotionRule> rules{rule({"far", "w_min", "w_max"}, function_rule(waves(0.1)))};
    rules.push_back(free ? rule({"pole"}, FreeRule{}) : rule({"pole"}, function_rule(waves(0.1))));
    Outcome const r = morph(std::move(mesh), motion(rules));
    Zone const& zone = r.mesh.zones[0];
    for (int k = 0; k < zone.extent[2]; ++k)
      for (int i = 1; i < zone.extent[0]; ++i)
        EXPECT_LT(distance(r.u(zone.node({i, 0, k})), r.u(zone.node({0, 0, k}))), 1e-15) << "free pole: " << free;
  }
}

TEST(NearField, IsConstantOffTheWallForTheLayersAskedFor) {
  Outcome const r =
      morph(box({9, 7, 6}, Shape::curved, 1),
            motion({rule({"u_min"}, function_rule(waves(0.1))), rule({"u_max"}, FixedRule{}), rule(sides, FreeRule{})}),
            near_field(BoundaryLayer::Extent::layers, 3));
  Zone const& zone = r.mesh.zones[0];
  for (int k = 0; k < 6; ++k)
    for (int j = 0; j < 7; ++j) {
      for (int i = 1; i <= 3; ++i) EXPECT_TRUE(same_bits(r.u(zone.node({i, j, k})), r.u(zone.node({0, j, k}))));
      // Beyond it the displacement falls linearly by the arc length of the rest of the line.
      double length = 0, done = 0;
      auto const edge = [&](int i) {
        return distance(r.mesh.coordinates[zone.node({i, j, k})], r.mesh.coordinates[zone.node({i - 1, j, k})]);
      };
      for (int i = 4; i < 9; ++i) length += edge(i);
      for (int i = 4; i < 9; ++i) {
        done += edge(i);
        EXPECT_LT(distance(r.u(zone.node({i, j, k})), (1 - done / length) * r.u(zone.node({0, j, k}))), 1e-14);
      }
    }
  Index cells = 0;
  for (CellBox const& box : r.plan().near_field) cells += box.cells.size();
  EXPECT_EQ(cells, 3 * 6 * 5);
}

TEST(NearField, OfAThicknessHasTheLayersThatReachIt) {
  // The straight box is 2 long in 8 cells of 0.25: 0.6 is reached by the third one.
  Outcome const r =
      morph(box({9, 7, 6}, Shape::straight, 1),
            motion({rule({"u_min"}, function_rule(waves(0.1))), rule({"u_max"}, FixedRule{}), rule(sides, FreeRule{})}),
            near_field(BoundaryLayer::Extent::thickness, 0, 0.6));
  Zone const& zone = r.mesh.zones[0];
  EXPECT_TRUE(same_bits(r.u(zone.node({3, 3, 3})), r.u(zone.node({0, 3, 3}))));
  EXPECT_FALSE(r.u(zone.node({4, 3, 3})) == r.u(zone.node({0, 3, 3})));
}

TEST(NearField, OfABlockEndsAtTheFirstBlockLimit) {
  PlanOptions options;
  options.boundary_layers = {{{"step"}, BoundaryLayer::Extent::block, 0, 0, BoundaryLayer::Mode::translate}};
  Motion const m =
      motion({rule({"step"}, function_rule(turn_about_z({1.2, 0.6, 0}, 0.1))),
              rule({"u_min", "u_max", "v_min", "v_max"}, FixedRule{}), rule({"w_min", "w_max"}, FreeRule{})});
  // The four blocks beside the box reach from the wall to the fixed outer boundary.
  EXPECT_THROW(morph(around_a_box(1), m, options), PlanError);
}

TEST(NearField, RunsThroughZoneLimits) {
  PlanOptions const options = near_field(BoundaryLayer::Extent::layers, 5);
  Outcome const r =
      morph(bricks_with_t_junctions(1),
            motion({rule({"u_min"}, function_rule(waves(0.1))), rule({"u_max"}, FixedRule{}), rule(sides, FreeRule{})}),
            options);
  // Brick 1 has 3 cells off the wall; the near field reaches 2 cells into bricks 2 and 3.
  Zone const& first = r.mesh.zones[0];
  for (int zone : {1, 2})
    for (int k = 0; k < 6; ++k)
      for (int j = 0; j < r.mesh.zones[zone].extent[1]; ++j) {
        Vec3 const wall = r.u(first.node({0, zone == 1 ? j : j + 2, k}));
        EXPECT_TRUE(same_bits(r.u(r.mesh.zones[zone].node({2, j, k})), wall));
        EXPECT_FALSE(r.u(r.mesh.zones[zone].node({3, j, k})) == wall);
      }
}

TEST(Morpher, ServesManyDisplacementsOneAfterAnother) {
  Mesh mesh = star(5, 1);
  PreparedMorph const prepared = prepare(mesh, motion({rule({"*"}, function_rule(waves(0.1)))}), without_near_field());
  Random random(4);
  std::vector<Vec3> one(prepared.plan().boundary_nodes.size()), two(one.size());
  for (std::size_t n = 0; n < one.size(); ++n) {
    one[n] = random.vector(1);
    two[n] = random.vector(1);
  }
  using Exec = Kokkos::DefaultHostExecutionSpace;
  Exec const exec;
  Morphed const fresh = run_plan(exec, mesh, prepared.plan(), two);
  Coordinates u(mesh.n_nodes());
  DeviceField<Exec::memory_space> const x(mesh.coordinates), out(u);
  auto const morpher = MorpherAccess::of(exec, prepared.plan(), x);
  for (auto const* boundary : {&two, &one, &two}) {
    morpher.displacements(exec, upload<Exec::memory_space>(*boundary), out);
    exec.fence();
  }
  EXPECT_EQ(different_bits(out.host_copy(), fresh.displacement), 0);
}

TEST(Morpher, ReadsAndWritesInterleavedArrays) {
  Mesh mesh = bricks_with_t_junctions(1);
  Outcome const r = morph(mesh, motion({rule({"*"}, function_rule(waves(0.1)))}));
  using Exec = Kokkos::DefaultHostExecutionSpace;
  using Vectors = Kokkos::View<double* [3], Kokkos::LayoutRight, Exec::memory_space>;
  Vectors const x("test::x", mesh.n_nodes()), moved("test::moved", mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    Vec3 const p = mesh.coordinates[n];
    x(n, 0) = p.x;
    x(n, 1) = p.y;
    x(n, 2) = p.z;
  }
  Exec const exec;
  auto const morpher = MorpherAccess::of(exec, r.plan(), x);
  morpher.positions(exec, upload<Exec::memory_space>(r.boundary), moved);
  exec.fence();
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    EXPECT_TRUE(same_bits(Vec3{moved(n, 0), moved(n, 1), moved(n, 2)}, r.morphed.position[n]));
}

TEST(Morpher, MovesAMeshInPlace) {
  using Exec = Kokkos::DefaultHostExecutionSpace;
  Exec const exec;
  Mesh mesh = star(5, 1);
  Outcome const r = morph(mesh, motion({rule({"*"}, function_rule(waves(0.1)))}));
  DeviceField<Exec::memory_space> const x(mesh.coordinates);
  auto const morpher = MorpherAccess::of(exec, r.plan(), x);
  morpher.positions(exec, upload<Exec::memory_space>(r.boundary), x);
  exec.fence();
  EXPECT_EQ(different_bits(x.host_copy(), r.morphed.position), 0);
}

/// An annulus sector between curved end walls that the flow slides on: everything a plan can hold.
struct SlidingSector {
  Mesh mesh = annulus_sector({}, 1);
  PreparedMorph prepared = [this] {
    Sector const shape;
    Motion m = motion({rule({"inlet", "outlet"}, function_rule(turning_waves(shape, 0.05))),
                       rule({"hub", "case"}, SlipRule{SlipRule::Surface::revolution})});
    m.axis = {shape.origin, shape.axis};
    return prepare(mesh, m, without_near_field());
  }();
};

TEST(Morpher, TakesSeveralFieldsAtOnceAndGivesEachWhatItGetsAlone) {
  using Exec = Kokkos::DefaultHostExecutionSpace;
  using Memory = Exec::memory_space;
  Exec const exec;
  SlidingSector s;
  constexpr int room = 10;      // more than one pass takes
  constexpr int n_fields = 23;  // more than there is room for
  std::vector<Vec3> const given = s.prepared.boundary_displacement();
  std::vector<std::vector<Vec3>> alone(n_fields, given);
  for (int f = 0; f < n_fields; ++f)
    for (std::size_t n = 0; n < given.size(); ++n) alone[f][n] = (1 - 0.06 * f) * given[n];
  DeviceField<Memory> const x(s.mesh.coordinates);
  auto const morpher = MorpherAccess::of(exec, s.prepared.plan(), x, {room});
  std::vector<Kokkos::View<Vec3*, Memory>> boundary;
  std::vector<Coordinates> u;
  for (auto const& values : alone) {
    boundary.push_back(upload<Memory>(values));
    u.emplace_back(s.mesh.n_nodes());
  }
  using In = Morpher<Exec>::In;
  using Out = Morpher<Exec>::Out;
  std::vector<In> const in(boundary.begin(), boundary.end());
  std::vector<Out> const out(u.begin(), u.end());
  morpher.displacements(exec, in, out);
  exec.fence();
  for (int f = 0; f < n_fields; ++f)
    EXPECT_EQ(different_bits(u[f], run_plan(exec, s.mesh, s.prepared.plan(), alone[f]).displacement), 0)
        << "field " << f;
  EXPECT_THROW(morpher.displacements(exec, std::span(in).first(2), std::span(out).first(1)), ConfigError);
}

TEST(Morpher, GridVelocityIsTheDerivativeOfTheDisplacement) {
  using Exec = Kokkos::DefaultHostExecutionSpace;
  Exec const exec;
  SlidingSector s;
  std::vector<Vec3> const given = s.prepared.boundary_displacement();
  std::vector<Vec3> rate(given.size());
  for (std::size_t n = 0; n < given.size(); ++n) {
    Vec3 const p = s.mesh.coordinates[s.prepared.plan().boundary_nodes[n]];
    rate[n] = {0.3 * p.y, -0.2 * p.z, 0.5 * p.x * p.y};
  }
  DeviceField<Exec::memory_space> const x(s.mesh.coordinates);
  Coordinates v(s.mesh.n_nodes());
  DeviceField<Exec::memory_space> const out(v);
  auto const morpher = MorpherAccess::of(exec, s.prepared.plan(), x, {1, true});
  morpher.velocities(exec, upload<Exec::memory_space>(given), upload<Exec::memory_space>(rate), out);
  exec.fence();
  Coordinates const velocity = out.host_copy();
  double const dt = 1e-5;
  auto const at = [&](double time) {
    std::vector<Vec3> boundary = given;
    for (std::size_t n = 0; n < given.size(); ++n) boundary[n] += time * rate[n];
    return run_plan(exec, s.mesh, s.prepared.plan(), boundary).displacement;
  };
  Coordinates const before = at(-dt), after = at(dt);
  double worst = 0, largest = 0;
  for (Index n = 0; n < s.mesh.n_nodes(); ++n) {
    worst = std::max(worst, distance(velocity[n], (0.5 / dt) * (after[n] - before[n])));
    largest = std::max(largest, norm(velocity[n]));
  }
  EXPECT_GT(largest, 0.1);
  EXPECT_LT(worst, 1e-7 * largest);
  auto const without = MorpherAccess::of(exec, s.prepared.plan(), x);
  EXPECT_THROW(without.velocities(exec, upload<Exec::memory_space>(given), upload<Exec::memory_space>(rate), out),
               ConfigError);
}

}  // namespace
}  // namespace gridmorph::test
