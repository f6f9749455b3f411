// Wings that bend in hundreds of blocks, with nothing asked for but the motion.
#include "support/morph_run.hpp"
#include "support/motions.hpp"

#include <generators/aircraft.hpp>
#include <gridmorph/morph/best_order.hpp>
#include <gridmorph/morph/morph.hpp>
#include <gridmorph/morph/plan_access.hpp>
#include <gridmorph/morph/prediction.hpp>

#include <gtest/gtest.h>

#include <algorithm>

namespace gridmorph::test {
namespace {

/// The tip goes up by so much of the semi-span; sections stay upright on the wing's line.
Motion bent_wing(double share) {
  VectorField const bend = [share](Vec3 const& p) {
    double const span = 14.9, t = std::max(p.y - 2.2, 0.0) / span, up = share * 17.1;
    return Vec3{0, -2 * up * t / span * (p.z + 0.7 - 0.0875 * (p.y - 2)), up * t * t};
  };
  AttachedRule carried;
  carried.of = {"wing"};
  carried.near = {{15, 6, -0.35}, 1.5};
  return motion({rule({"wing", "aileron"}, function_rule(bend)), rule({"nacelle"}, carried),
                 rule({"fuselage"}, SlipRule{SlipRule::Surface::baseline, {}, {}}), rule({"symmetry"}, SlipRule{})});
}

Mesh aircraft() {
  AircraftOptions options;
  options.nodes = 100'000;
  return make_aircraft(options);
}

/// Of all cells.
PredictedCells predicted(Mesh const& mesh, MorphPlan const& plan) {
  return predict(HostInstance(), IndexedMesh(mesh), plan, plan.boundary_displacement(), {.every = 1}).all;
}

TEST(Bends, OfAWingAreSoundByDefaultWhereOrdersByPriorityInvertCells) {
  Mesh const mesh = aircraft();
  for (double const share : {0.05, 0.1, 0.2, 0.4}) {
    PlanOptions by_priority;
    by_priority.volume.order = OrderBy::priority;
    PredictedCells const found = predicted(mesh, MorphPlan(mesh, bent_wing(share))),
                         before = predicted(mesh, MorphPlan(mesh, bent_wing(share), by_priority));
    EXPECT_EQ(found.inverted, 0) << share;
    EXPECT_GT(found.kept.value, 0.1) << share;
    if (share >= 0.1) {
      EXPECT_GT(before.inverted, 0) << share << ": there is something to find";
    }
  }
}

TEST(Bends, AreSearchedWithinTheTimeOfTwentyPlans) {
  PlanOptions options;
  PreparedMorph const prepared = prepare(HostInstance(), aircraft(), bent_wing(0.2), options);
  auto const boundary = prepared.boundary_displacement();
  EXPECT_TRUE(is_inverted_by_priority(HostInstance(), prepared, boundary));
  FoundOrder const found = find_order_quickly(HostInstance(), prepared, boundary);
  EXPECT_TRUE(found.better);
  EXPECT_LE(found.tried, 20);
}

TEST(Bends, ThatAreSoundByPriorityAreLeftToIt) {
  PreparedMorph const prepared = prepare(HostInstance(), aircraft(), bent_wing(0.01), {});
  EXPECT_FALSE(is_inverted_by_priority(HostInstance(), prepared, prepared.boundary_displacement()));
  MorphPlan const plan(aircraft(), bent_wing(0.01));
  EXPECT_EQ(PlanAccess::blocks(plan)->planned.order, prepared.planned.order);
}

}  // namespace
}  // namespace gridmorph::test
