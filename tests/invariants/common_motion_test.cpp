// Motions that all boundaries of blocks have in common.
#include "invariants/common_motion_runs.hpp"
#include "support/reduced.hpp"
#include "support/transpose_check.hpp"

#include <gridmorph/morph/morph.hpp>
#include <gridmorph/morph/plan_access.hpp>
#include <gridmorph/morph/prediction.hpp>
#include <gridmorph/morph/predictor.hpp>
#include <gridmorph/morph/stage_by_stage.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph::test {
namespace {

struct Kind {
  std::string name;
  std::function<Mesh()> mesh;
  std::vector<std::string> patches{"*"};
  std::optional<Axis> axis = {};  ///< copies are turned about it
  friend std::ostream& operator<<(std::ostream& out, Kind const& k) { return out << k.name; }
};

Sector const sector{};

std::vector<Kind> kinds() {
  Sector wedge = sector;
  wedge.inner_radius = 0;
  Axis const about{sector.origin, (1 / norm(sector.axis)) * sector.axis};
  return {{"box",
           [] {
             return box({8, 7, 6}, Shape::curved, 1);
           }},
          {"bricks", [] { return bricks_with_t_junctions(4); }},
          {"around_a_box", [] { return around_a_box(7); }},
          {"o_grid", [] { return o_grid(0.8, 12); }},
          {"c_grid", [] { return c_grid(15); }},
          {"star5", [] { return star(5, 10); }},
          {"sector", [] { return annulus_sector(sector, 17); }, {"hub", "case", "inlet", "outlet"}, about},
          {"sector_with_sides", [] { return annulus_sector(sector, 17); }, {"*", "type:periodic"}, about},
          {"wedge", [=] { return annulus_sector(wedge, 20); }, {"case", "inlet", "outlet", "pole"}, about}};
}

std::vector<std::pair<std::string, Map>> motions(std::optional<Axis> const& axis) {
  std::vector<std::pair<std::string, Map>> out;
  Vec3 const origin = axis ? axis->origin : Vec3{3, -2, 1}, direction = axis ? axis->direction : Vec3{1, 2, 3};
  Vec3 const shift = axis ? 0.7 * axis->direction : Vec3{1, 2, -3};
  for (double const degrees : {5., 90., 180.}) {
    if (reduced() && degrees != 90) continue;
    RigidTransform const r = rotation_about(origin, direction, degrees * std::numbers::pi / 180);
    out.emplace_back("turned by " + std::to_string(degrees), [=](Vec3 const& p) { return r(p) + shift; });
  }
  // The axis of copies is fitted to them, to some 1e-14 of the size.
  for (double const s : {axis ? 1e-2 : 1e-3, 1000.}) {
    if (reduced()) continue;
    out.emplace_back("scaled by " + std::to_string(s), [=](Vec3 const& p) { return origin + s * (p - origin); });
  }
  if (!axis)
    out.emplace_back("sheared", [](Vec3 const& p) { return Vec3{p.x + 0.7 * p.y, p.y - 0.2 * p.z, 1.1 * p.z}; });
  return out;
}

class CommonMotionOfBlocks : public ::testing::TestWithParam<Kind> {};

TEST_P(CommonMotionOfBlocks, OnAllBoundariesIsThatOfTheMesh) {
  Mesh const mesh = GetParam().mesh();
  double const before = smallest_determinant(mesh, mesh.coordinates);
  for (auto const& [name, map] : motions(GetParam().axis)) {
    Outcome const run = morph_split(mesh, motion({rule(GetParam().patches, moves_as(map))}));
    EXPECT_LE(distance_from(run, map), 1e-12) << name;
    // What is on an axis keeps to it.
    EXPECT_TRUE(GetParam().name == "wedge" || given_changed(run) == 0) << name;
    if (name == "sheared") continue;
    EXPECT_NEAR(smallest_determinant(mesh, run.morphed.position), before, 1e-10) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Of, CommonMotionOfBlocks, ::testing::ValuesIn(kinds()),
                         [](auto const& info) { return info.param.name; });

/// A row whose hub and case slip, and what turns it as a whole.
Motion row(Map const& map) {
  Motion m = motion({rule({"inlet", "outlet"}, moves_as(map)),
                     rule({"hub", "case"}, SlipRule{SlipRule::Surface::revolution, {}, {}})});
  m.axis = {sector.origin, sector.axis};
  return m;
}

TEST(CommonMotionOfParts, TurnsARowOnItsWallsOfRevolution) {
  Mesh const mesh = bend_sector(sector, 24);
  for (double const degrees : {5., 90., 180.}) {
    RigidTransform const r = rotation_about(sector.origin, sector.axis, degrees * std::numbers::pi / 180);
    Outcome const run = morph_split(mesh, row([&](Vec3 const& p) { return r(p); }));
    EXPECT_LE(distance_from(run, [&](Vec3 const& p) { return r(p); }), 1e-12) << degrees;
  }
}

/// The sides of a straight box slip but for one, and its ends move.
Motion box_on_planes(Map const& map) {
  return motion({rule({"u_*", "v_*"}, moves_as(map)), rule({"w_min", "w_max"}, SlipRule{})});
}

TEST(CommonMotionOfParts, KeepsPlanesThatNodesSlideOn) {
  RigidTransform const r = rotation_about({3, -2, 0}, {0, 0, 1}, 1.2);
  Map const map = [&](Vec3 const& p) { return r(Vec3{1.5 * p.x, 1.5 * p.y, p.z}); };
  Outcome const run = morph_split(box({8, 7, 6}, Shape::straight, 3), box_on_planes(map));
  EXPECT_LE(distance_from(run, map), 1e-12);
}

TEST(CommonMotionOfParts, IsTakenOffWhereWallsMoveBesideIt) {
  // Turned as a whole, and the body by a little besides: as the little turn alone, seen from the frame that turns, but
  // for what is small of second order.
  Mesh const mesh = o_grid(0.8, 12);
  RigidTransform const whole = rotation_about({0, 0, 0}, {1, 2, 3}, 1.3),
                       little = rotation_about({0.1, 0, 0}, {0, 0, 1}, 0.01);
  auto const turned_body = [&](RigidTransform const& all) {
    return motion({rule({"body"}, moves_as([=](Vec3 const& p) { return all(little(p)); })),
                   rule({"far"}, moves_as([=](Vec3 const& p) { return all(p); })), rule({"w_*"}, FreeRule{})});
  };
  Outcome const both = morph_split(mesh, turned_body(whole)), alone = morph(mesh, turned_body({}), {});
  ASSERT_EQ(both.plan().common.size(), 1U);
  double largest = 0, moved = 0;
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    largest = std::max(largest, distance(both.morphed.position[n], whole(alone.morphed.position[n])));
    moved = std::max(moved, norm(alone.u(n)));
  }
  EXPECT_GT(moved, 0.005);
  EXPECT_LT(largest, 0.02 * moved);
  EXPECT_EQ(given_changed(both), 0);
}

TEST(CommonMotionOfParts, IsNoneWhereABoundaryStands) {
  auto const turned = moves_as([](Vec3 const& p) { return rotation_about({}, {0, 0, 1}, 0.2)(p); });
  auto const prepared =
      split(o_grid(0.8, 12), motion({rule({"body"}, turned), rule({"far"}, FixedRule{}), rule({"w_*"}, FreeRule{})}));
  EXPECT_TRUE(prepared.plan().common.empty());
}

/// A box beside another mesh: nothing joins them.
Mesh with_a_box(Mesh const& mesh) {
  Mesh const one = box({5, 4, 6}, Shape::curved, 9);
  Mesh out = mesh;
  int const z = out.add_zone("apart", one.zones.front().extent);
  Coordinates const before = out.coordinates;
  out.coordinates = Coordinates(out.n_nodes());
  Index const first = out.zones[z].first_node;
  for (Index n = 0; n < first; ++n) out.coordinates.set(n, before[n]);
  for (Index n = 0; n < one.n_nodes(); ++n) out.coordinates.set(first + n, one.coordinates[n] + Vec3{0.1, 0.2, 0.3});
  for (Patch patch : one.patches) {
    patch.name = "apart " + patch.name;
    patch.kind = PatchKind::outflow;  // no near field of its own
    for (auto& family : patch.families) family = "apart " + family;
    patch.zone = z;
    out.patches.push_back(patch);
  }
  return out;
}

TEST(CommonMotionOfParts, IsThatOfEachPartByItself) {
  Mesh const fluid = around_a_box(7), mesh = with_a_box(fluid);
  Index const first = fluid.n_nodes();
  RigidTransform const r = rotation_about({1.2, 0.6, 0}, {0, 0, 1}, std::numbers::pi / 2);
  Map const map = [&](Vec3 const& p) { return r(p); };
  auto const sides = rule({"u_*", "v_*"}, FixedRule{}), ends = rule({"w_*"}, FreeRule{});
  // What stands stands to the last bit, whatever the other part does.
  Outcome const stands =
      morph_split(mesh, motion({rule({"step", "u_*", "v_*", "w_*"}, moves_as(map)), rule({"apart *"}, FixedRule{})}));
  for (Index n = first; n < mesh.n_nodes(); ++n)
    ASSERT_TRUE(same_bits(stands.morphed.position[n], mesh.coordinates[n])) << n;
  // A solid goes along with the wall around it.
  Outcome const solid = morph_split(mesh, motion({rule({"step", "apart *"}, moves_as(map)), sides, ends}));
  double worst = 0;
  for (Index n = first; n < mesh.n_nodes(); ++n)
    worst = std::max(worst, distance(solid.morphed.position[n], map(mesh.coordinates[n])));
  EXPECT_LE(worst, 1e-12 * size_of(mesh.coordinates));
  EXPECT_EQ(solid.plan().common.size(), 1U);
  // And the other part does what it does without any of this.
  Outcome const plain = morph(mesh, motion({rule({"step", "apart *"}, moves_as(map)), sides, ends}), {});
  for (Index n = 0; n < first; ++n) ASSERT_TRUE(same_bits(solid.morphed.position[n], plain.morphed.position[n])) << n;
}

/// Motions with something beyond what is in common: walls that turn, and surfaces that nodes slide on.
struct Beyond {
  std::string name;
  Mesh mesh;
  std::function<Motion(double t)> motion;
};

std::vector<Beyond> all_beyond() {
  auto const bent = [](Vec3 const& p, double t) {
    return Vec3{p.x + (0.02 + 0.3 * t) * std::sin(p.y), p.y, p.z + 0.2 * t * p.x * p.x};
  };
  std::vector<Beyond> out;
  out.push_back({"o_grid", with_a_box(o_grid(0.8, 12)), [=](double t) {
                   RigidTransform const r = rotation_about({0, 0.3, 0}, {1, 2, 3}, 0.7 + 0.5 * t);
                   auto const body = [=](Vec3 const& p) { return r(bent(p, t)); };
                   return motion({rule({"body", "far", "w_*"}, moves_as(body)), rule({"apart *"}, FixedRule{})});
                 }});
  out.push_back({"planes", box({7, 6, 5}, Shape::straight, 3), [](double t) {
                   RigidTransform const r = rotation_about({3, -2, 0}, {0, 0, 1}, 1.2 + t);
                   return box_on_planes([=](Vec3 const& p) {
                     return r(Vec3{1.5 * p.x + 0.03 * std::sin(3 * p.y), p.y, p.z * (1 + 0.02 * (1 + t) * p.x)});
                   });
                 }});
  out.push_back({"row", bend_sector(sector, 24), [](double t) {
                   return row([=](Vec3 const& p) {
                     Vec3 const q = sector_coordinates(sector, p);
                     return sector_position(sector, q.x, q.y, q.z + 0.5 + t + 0.02 * (1 + 3 * t) * (q.x - 0.5 * q.y));
                   });
                 }});
  return out;
}

TEST(CommonMotionOfParts, HasRatesThatAreItsSlope) {
  for (auto const& [name, mesh, motion_at] : all_beyond()) {
    PreparedMorph const prepared = split(mesh, motion_at(0));
    ASSERT_EQ(prepared.plan().common.size(), 1U) << name;
    using Exec = Kokkos::DefaultHostExecutionSpace;
    auto const given = [&](double t) {
      return evaluate(prepared.planned.boundary, prepared.surface.with(motion_at(t)), prepared.plan().rotations);
    };
    auto const displacements = [&](double t) { return run_plan(Exec(), mesh, prepared.plan(), given(t)).displacement; };
    double const h = 1e-5;
    auto const ahead = given(h), behind = given(-h);
    Coordinates rate(Index(ahead.size()));
    for (Index k = 0; k < rate.size(); ++k) rate.set(k, (0.5 / h) * (ahead[k] - behind[k]));
    LinearisedMorph<Exec> const at(prepared.plan(), mesh.coordinates, given(0));
    Coordinates const v = at.forwards(rate), up = displacements(h), down = displacements(-h);
    double worst = 0, largest = 0;
    for (Index n = 0; n < mesh.n_nodes(); ++n) {
      worst = std::max(worst, distance(v[n], (0.5 / h) * (up[n] - down[n])));
      largest = std::max(largest, norm(v[n]));
    }
    EXPECT_GT(largest, 0.3) << name;
    EXPECT_LT(worst, 1e-6 * largest) << name;
  }
}

TEST(CommonMotionOfParts, HasTheTransposeOfItsRates) {
  for (auto const& [name, mesh, motion_at] : all_beyond()) {
    PreparedMorph const prepared = split(mesh, motion_at(0));
    using Exec = Kokkos::DefaultHostExecutionSpace;
    LinearisedMorph<Exec> const at(prepared.plan(), mesh.coordinates, prepared.boundary_displacement());
    EXPECT_LE(product_error(at), 1e-13) << name;
    EXPECT_EQ(bits_left_by_others(at), 0) << name;
  }
}

TEST(CommonMotionOfParts, IsTheSameOnAllExecutionSpacesAndWithManyFields) {
  for (auto const& [name, mesh, motion_at] : all_beyond()) {
    PreparedMorph const prepared = split(mesh, motion_at(0));
    std::vector<Vec3> const boundary = prepared.boundary_displacement();
    using Host = Kokkos::DefaultHostExecutionSpace;
    Morphed const reference = run_plan(Host(), mesh, prepared.plan(), boundary);
    on_every_space([&](auto const& exec, char const*) {
      SCOPED_TRACE(name);
      Morphed const other = run_plan(exec, mesh, prepared.plan(), boundary);
      double const rounding = 1e-13 * prepared.plan().mesh_size;
      expect_same_on(exec, other.displacement, reference.displacement, rounding);
      expect_same_on(exec, other.position, reference.position, rounding);
    });
    std::vector<Vec3> other = boundary;
    for (Vec3& u : other) u = -0.3 * u;
    Coordinates one(mesh.n_nodes()), two(mesh.n_nodes());
    auto const morpher = MorpherAccess::of(Host(), prepared.plan(), mesh.coordinates, {.fields = 2});
    using View = Kokkos::View<Vec3 const*, Kokkos::HostSpace>;
    std::vector<Morpher<Host>::In> const in{View(other.data(), other.size()), View(boundary.data(), boundary.size())};
    std::vector<Morpher<Host>::Out> const out{one, two};
    morpher.displacements({}, in, out);
    Host().fence();
    EXPECT_EQ(different_bits(two, reference.displacement), 0) << name;
    EXPECT_EQ(different_bits(one, run_plan(Host(), mesh, prepared.plan(), other).displacement), 0) << name;
  }
}

TEST(CommonMotionOfParts, IsThereStageByStageAndInPredictions) {
  for (auto const& [name, mesh, motion_at] : all_beyond()) {
    Outcome const run = morph_split(mesh, motion_at(0));
    Coordinates last;
    morph_stage_by_stage(run.plan(), mesh.coordinates, run.boundary,
                         [&](StagesDone const&, Coordinates const& x) { last = x; });
    // Positions that visit() gets are of the last stage when it returns.
    Prediction const prediction = Predictor({}, run.prepared, {.every = 1}).predict(run.boundary);
    EXPECT_NEAR(prediction.all.determinant.value, smallest_determinant(mesh, run.morphed.position), 1e-9) << name;
    EXPECT_EQ(different_bits(last, run.morphed.position), 0) << name;
  }
}

TEST(CommonMotionOfParts, AsksForNoOtherOrderOfChains) {
  // Half a turn of the whole: by chains alone it would be inverted, and orders would be tried.
  Mesh const mesh = o_grid(0.8, 12);
  RigidTransform const r = rotation_about({0, 0, 0}, {1, 2, 3}, std::numbers::pi);
  MorphPlan const plan(mesh, motion({rule({"*"}, moves_as([&](Vec3 const& p) { return r(p); }))}));
  auto const notes = plan.notes();
  EXPECT_TRUE(std::none_of(notes.begin(), notes.end(),
                           [](std::string const& note) { return note.find("tried") != std::string::npos; }));
  PlanOptions asked;
  asked.volume.order = OrderBy::prediction;
  MorphPlan const by_prediction(mesh, motion({rule({"*"}, moves_as([&](Vec3 const& p) { return r(p); }))}), asked);
  EXPECT_EQ(PlanAccess::blocks(by_prediction)->plan().common.size(), 1U);
}

}  // namespace
}  // namespace gridmorph::test
