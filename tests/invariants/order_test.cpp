// Orders of chains found by prediction, on every mesh that the invariants are checked on.
#include "invariants/cases.hpp"
#include "invariants/checks.hpp"

#include "support/reduced.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/morph/best_order.hpp>
#include <gridmorph/morph/morph.hpp>
#include <gridmorph/morph/plan_access.hpp>
#include <gridmorph/morph/predictor.hpp>

#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace gridmorph::test {
namespace {

bool is_no_worse(PredictedCells const& a, PredictedCells const& b) {
  return a.inverted <= b.inverted && a.scaled_jacobian.value >= b.scaled_jacobian.value && a.kept.value >= b.kept.value;
}

class Orders : public ::testing::TestWithParam<Case> {
 protected:
  PreparedMorph prepared = prepare(GetParam().mesh(), GetParam().motion(1), GetParam().options);
  std::vector<Vec3> boundary = prepared.boundary_displacement();

  /// No first chain, followed by the others by priority, is better.
  void expect_best_of_first_chains(FoundOrder const& found) {
    Predictor predictor(HostInstance(), prepared, {});
    OrderTrial const rules = predictor.try_order({}, boundary);
    EXPECT_EQ(rules.order, prepared.planned.order);
    for (auto const& first : rules.next) {
      PredictedCells cells;
      try {
        cells = predictor.try_order({first}, boundary).prediction.all;
      } catch (PlanError const&) {
        continue;  // leaves blocks that nothing reaches
      }
      if (!is_no_worse(cells, found.by_priority)) continue;
      EXPECT_LE(found.by_prediction.inverted, cells.inverted);
      EXPECT_GE(found.by_prediction.scaled_jacobian.value, cells.scaled_jacobian.value - 2e-6);
    }
  }

  void expect_all_that_a_morph_must_hold() {
    Morphed morphed = run_plan(Kokkos::DefaultHostExecutionSpace(), prepared.mesh, prepared.plan(), boundary);
    Mesh const mesh = prepared.mesh;
    Outcome const run{mesh, std::move(prepared), boundary, std::move(morphed)};
    EXPECT_EQ(not_finite(run), 0);
    EXPECT_EQ(boundary_values_changed(run), 0);
    EXPECT_EQ(interface_nodes_that_differ(run), "");
    EXPECT_LE(periodic_mismatch(run), 1e-12 * run.plan().mesh_size);
  }
};

TEST_P(Orders, FoundByPredictionAreNeverWorseThanByPriorityAndComeOutAsPredicted) {
  if (reduced() && GetParam().name.find("_turned") != std::string::npos) GTEST_SKIP() << "hundreds of plans";
  FoundOrder const found = find_order(HostInstance(), prepared, boundary);
  EXPECT_TRUE(is_no_worse(found.by_prediction, found.by_priority));
  expect_best_of_first_chains(found);

  PlanOptions options = GetParam().options;
  options.volume.order = OrderBy::prediction;
  MorphPlan const plan(GetParam().mesh(), GetParam().motion(1), options);
  EXPECT_EQ(PlanAccess::blocks(plan)->planned.order, found.order) << "another search finds the same";
  PredictedCells const again = predict(HostInstance(), IndexedMesh(prepared.mesh), plan, boundary).all;
  EXPECT_EQ(again.scaled_jacobian.value, found.by_prediction.scaled_jacobian.value);
  EXPECT_EQ(again.kept.value, found.by_prediction.kept.value);
  EXPECT_EQ(again.inverted, found.by_prediction.inverted);

  prepared.planned =
      make_plan(HostInstance(), prepared.mesh, prepared.links, prepared.surface, prepared.options, found.order);
  expect_all_that_a_morph_must_hold();
}

/// Of a few kinds of topology: each of these looks at hundreds of plans.
class Laws : public Orders {};

TEST_P(Laws, FoundByPredictionAreNeverWorseThanOneForAllAndComeOutAsPredicted) {
  prepared.options.volume.laws_by_prediction = true;
  FoundOrder const found = plan_by_prediction(HostInstance(), prepared, boundary);
  EXPECT_TRUE(is_no_worse(found.by_prediction, found.by_priority));
  EXPECT_GT(found.tried, 4);
  PredictedCells const again = Predictor(HostInstance(), prepared, {}).predict(boundary).all;
  EXPECT_EQ(again.scaled_jacobian.value, found.by_prediction.scaled_jacobian.value);
  EXPECT_EQ(again.kept.value, found.by_prediction.kept.value);
  expect_all_that_a_morph_must_hold();
}

std::vector<Case> some_cases() {
  std::vector<Case> out;
  for (Case& c : make_cases())
    if (c.name == "bricks_one_face" || c.name == "around_a_box" || c.name == "c_grid" || c.name == "sector" ||
        c.name == "o_grid_turned")
      out.push_back(std::move(c));
  return out;
}

INSTANTIATE_TEST_SUITE_P(Few, Laws, ::testing::ValuesIn(some_cases()),
                         [](auto const& test) { return test.param.name; });
INSTANTIATE_TEST_SUITE_P(Of, Orders, ::testing::ValuesIn(make_cases()),
                         [](auto const& test) { return test.param.name; });

}  // namespace
}  // namespace gridmorph::test
