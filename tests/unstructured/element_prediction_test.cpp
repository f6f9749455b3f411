// Predictions of elements beside what comes out, and beside those of the same cells in blocks.
#include "support/made_bodies.hpp"
#include "support/mesh_builders.hpp"
#include "support/unstructured_case.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/as_hexahedra.hpp>
#include <gridmorph/morph/morph.hpp>
#include <gridmorph/morph/prediction.hpp>

#include <gtest/gtest.h>

#include <algorithm>

namespace gridmorph {
namespace {

using Case = test::UnstructuredCase;

/// n unit cells along each side; the wall "body" takes the middle third.
Mesh box_with_body(int n, bool tetrahedra) {
  double const low = n / 3, high = n - n / 3;
  return test::box_around(
      {n, n, n},
      [=](Vec3 const& p) { return p.x > low && p.x < high && p.y > low && p.y < high && p.z > low && p.z < high; },
      tetrahedra);
}

/// A body that moves by `share` of a motion far too large for the gap around it.
Motion moved(Mesh const& mesh, double share) {
  double const n = mesh.size() / std::sqrt(3.0);
  Vec3 const centre{n / 2, n / 2, n / 2};
  return test::motion_of(
      {test::rule_for({"body"}, test::rotation(centre, {1, 2, 3}, 1.5 * share, Vec3{0.2 * share * n, 0, 0}))});
}

Prediction prediction(Mesh const& of, Motion const& motion, PredictionOptions const& options = {},
                      HostInstance const& host = {}) {
  IndexedMesh const mesh(host, of);
  MorphPlan const plan(host, mesh, motion);
  return predict(host, mesh, plan, plan.boundary_displacement(), options);
}

/// Whether both are the same cell with the same value.
bool are_equal(CellValue const& a, CellValue const& b) {
  return a.value == b.value && a.zone == b.zone && a.cell == b.cell;
}

class ElementPredictions : public testing::TestWithParam<bool> {};

TEST_P(ElementPredictions, OfAllElementsAreWhatComesOut) {
  Case const c(box_with_body(9, GetParam()));
  for (double const share : {0.1, 1.0}) {
    Motion const motion = moved(c.mesh, share);
    Prediction const p = prediction(c.mesh, motion, {1, 0});
    PredictedCells const& all = p.all;
    QualityRegion const q = c.quality(c.morph(motion).x);
    EXPECT_EQ(p.n_cells, c.mesh.n_elements());
    EXPECT_EQ(all.cells, c.mesh.n_elements());
    EXPECT_EQ(all.inverted, q.newly_inverted);
    EXPECT_EQ(all.determinant.value, q[Measure::determinant_3x3x3].min);
    EXPECT_EQ(all.angle_deg.value, q[Measure::minimum_angle_deg].min);
    EXPECT_EQ(all.relative_displacement[0].value, q[Measure::relative_displacement].max);
    EXPECT_EQ(all.inverted > 0, share == 1) << "the larger motion is meant to invert some";
  }
}

TEST_P(ElementPredictions, OfSomeElementsBoundTheWorstAndHoldTheMostStrained) {
  Mesh const mesh = box_with_body(15, GetParam());
  Motion const motion = moved(mesh, 0.4);
  PredictedCells const all = prediction(mesh, motion, {1, 0}).all, some = prediction(mesh, motion, {64, 50}).all;
  EXPECT_LT(some.cells, all.cells / 2);
  EXPECT_GE(some.cells, 50);
  EXPECT_LE(some.inverted, all.inverted);
  EXPECT_GE(some.determinant.value, all.determinant.value);
  EXPECT_GE(some.kept.value, all.kept.value);
  EXPECT_TRUE(are_equal(some.relative_displacement[0], all.relative_displacement[0]));
}

TEST_P(ElementPredictions, OfRegionsAreThoseOfAllTakenApart) {
  Mesh const mesh = box_with_body(15, GetParam());
  Prediction const p = prediction(mesh, moved(mesh, 0.4), {8, 100});
  PredictedCells sum;
  double kept = 1;
  for (auto const& [stage, name, cells] : p.groups) {
    sum.cells += cells.cells;
    sum.inverted += cells.inverted;
    kept = std::min(kept, cells.kept.value);
    EXPECT_GE(cells.kept.value, p.groups.front().cells.kept.value) << name;
  }
  EXPECT_EQ(sum.cells, p.all.cells);
  EXPECT_EQ(sum.inverted, p.all.inverted);
  EXPECT_EQ(kept, p.all.kept.value);
  EXPECT_GT(p.groups.size(), 1u);
}

TEST_P(ElementPredictions, OfNoMotionAreTheBaseline) {
  Mesh const mesh = box_with_body(9, GetParam());
  PredictedCells const all = prediction(mesh, moved(mesh, 0)).all;
  EXPECT_EQ(all.inverted, 0);
  EXPECT_EQ(all.kept.value, 1);
  EXPECT_EQ(all.relative_displacement[0].value, 0);
  EXPECT_EQ(all.determinant.value, all.determinant_before);
}

TEST_P(ElementPredictions, AreTheSameInAllExecutionSpaces) {
  Mesh const mesh = box_with_body(12, GetParam());
  auto const on = [&](HostInstance const& host) { return prediction(mesh, moved(mesh, 0.7), {16, 200}, host).all; };
  PredictedCells const one = on(Kokkos::Serial()), other = on(Kokkos::DefaultHostExecutionSpace());
  EXPECT_EQ(one.cells, other.cells);
  EXPECT_EQ(one.inverted, other.inverted);
  EXPECT_TRUE(are_equal(one.kept, other.kept));
  EXPECT_TRUE(are_equal(one.relative_displacement[0], other.relative_displacement[0]));
}

INSTANTIATE_TEST_SUITE_P(Of, ElementPredictions, testing::Bool(),
                         [](auto const& info) { return info.param ? "tetrahedra" : "hexahedra"; });

TEST(BothKinds, OfPredictionsAgreeWhereAMeshMovesAsOne) {
  Mesh const blocks = test::box({7, 6, 5}, test::Shape::curved, 3);
  Motion const motion =
      test::motion_of({test::rule_for({"*"}, test::rotation({0.2, 0, 0}, {1, 2, 3}, 0.7, {1, 0, 2}))});
  Prediction const a = prediction(blocks, motion, {1}), b = prediction(as_hexahedra(blocks), motion, {1});
  EXPECT_EQ(a.n_cells, b.n_cells);
  EXPECT_EQ(a.all.cells, b.all.cells);
  EXPECT_EQ(a.all.cells, blocks.n_cells());
  constexpr double tolerance = 1e-9;
  for (PredictedCells const* p : {&a.all, &b.all}) {
    EXPECT_EQ(p->inverted, 0);
    EXPECT_NEAR(p->kept.value, 1, tolerance);
    EXPECT_NEAR(p->determinant.value, p->determinant_before, tolerance);
  }
  EXPECT_NEAR(a.all.determinant.value, b.all.determinant.value, tolerance);
  EXPECT_NEAR(a.all.angle_deg.value, b.all.angle_deg.value, tolerance);
  auto const& along = a.all.relative_displacement;
  double const largest = std::ranges::max(along, {}, &CellValue::value).value;
  EXPECT_NEAR(largest, b.all.relative_displacement[0].value, tolerance);
  EXPECT_GT(largest, 0.1);
}

TEST(BothKinds, RefuseThePlanOfAnotherMesh) {
  Mesh const blocks = test::box({5, 4, 3}, test::Shape::straight, 1),
             other = test::box({5, 4, 4}, test::Shape::straight, 1);
  MorphPlan const plan(blocks, test::motion_of({test::rule_for({"*"}, FixedRule{})}));
  for (Mesh const& mesh : {other, as_hexahedra(blocks)})
    EXPECT_THROW((void)predict(HostInstance(), IndexedMesh(mesh), plan, plan.boundary_displacement()), ConfigError);
}

}  // namespace
}  // namespace gridmorph
