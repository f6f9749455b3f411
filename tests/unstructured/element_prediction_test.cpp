// Predictions of elements beside what comes out.
#include "support/made_bodies.hpp"
#include "support/unstructured_case.hpp"

#include <gridmorph/morph/element_prediction.hpp>

#include <gtest/gtest.h>

#include <algorithm>

namespace gridmorph {
namespace {

using Case = test::UnstructuredCase;
using Morphed = test::UnstructuredMorphed;

/// n unit cells along each side; the wall "body" takes the middle third.
Mesh box_with_body(int n, bool tetrahedra) {
  double const low = n / 3, high = n - n / 3;
  return test::box_around(
      {n, n, n},
      [=](Vec3 const& p) { return p.x > low && p.x < high && p.y > low && p.y < high && p.z > low && p.z < high; },
      tetrahedra);
}

/// A body that moves by `share` of a motion far too large for the gap around it.
Morphed moved(Case const& c, double share) {
  double const n = c.mesh.size() / std::sqrt(3.0);
  Vec3 const centre{n / 2, n / 2, n / 2};
  return c.morph(test::motion_of(
      {test::rule_for({"body"}, test::rotation(centre, {1, 2, 3}, 1.5 * share, Vec3{0.2 * share * n, 0, 0}))}));
}

ElementPrediction prediction(HostInstance const& host, Case const& c, Morphed const& m,
                             ElementPredictionOptions const& options = {}) {
  return predict(host, c.mesh, m.prepared, m.x, volume_signs(c.mesh), options);
}

class ElementPredictions : public testing::TestWithParam<bool> {};

TEST_P(ElementPredictions, OfAllElementsAreWhatComesOut) {
  Case const c(box_with_body(9, GetParam()));
  for (double const share : {0.1, 1.0}) {
    Morphed const m = moved(c, share);
    PredictedElements const all = prediction({}, c, m, {1, 0}).all;
    QualityRegion const q = c.quality(m.x);
    EXPECT_EQ(all.elements, c.mesh.n_elements());
    EXPECT_EQ(all.inverted, q.newly_inverted);
    EXPECT_EQ(all.determinant.value, q[Measure::determinant_3x3x3].min);
    EXPECT_EQ(all.angle_deg.value, q[Measure::minimum_angle_deg].min);
    EXPECT_EQ(all.relative_displacement.value, q[Measure::relative_displacement].max);
    EXPECT_EQ(all.inverted > 0, share == 1) << "the larger motion is meant to invert some";
  }
}

TEST_P(ElementPredictions, OfSomeElementsBoundTheWorstAndHoldTheMostStrained) {
  Case const c(box_with_body(15, GetParam()));
  Morphed const m = moved(c, 0.4);
  ElementPrediction const all = prediction({}, c, m, {1, 0}), some = prediction({}, c, m, {64, 50});
  EXPECT_LT(some.all.elements, all.all.elements / 2);
  EXPECT_GE(some.all.elements, 50);
  EXPECT_LE(some.all.inverted, all.all.inverted);
  EXPECT_GE(some.all.determinant.value, all.all.determinant.value);
  EXPECT_GE(some.all.kept.value, all.all.kept.value);
  EXPECT_EQ(some.all.relative_displacement.value, all.all.relative_displacement.value);
  EXPECT_EQ(some.all.relative_displacement.element, all.all.relative_displacement.element);
}

TEST_P(ElementPredictions, OfRegionsAreThoseOfAllTakenApart) {
  Case const c(box_with_body(15, GetParam()));
  ElementPrediction const p = prediction({}, c, moved(c, 0.4), {8, 100});
  PredictedElements sum;
  double kept = 1;
  for (PredictedRegion const& region : p.regions) {
    sum.elements += region.elements.elements;
    sum.inverted += region.elements.inverted;
    kept = std::min(kept, region.elements.kept.value);
    EXPECT_GE(region.elements.kept.value, p.regions.front().elements.kept.value) << region.name;
  }
  EXPECT_EQ(sum.elements, p.all.elements);
  EXPECT_EQ(sum.inverted, p.all.inverted);
  EXPECT_EQ(kept, p.all.kept.value);
  EXPECT_GT(p.regions.size(), 1u);
}

TEST_P(ElementPredictions, OfNoMotionAreTheBaseline) {
  Case const c(box_with_body(9, GetParam()));
  ElementPrediction const p = prediction({}, c, moved(c, 0));
  EXPECT_EQ(p.all.inverted, 0);
  EXPECT_EQ(p.all.kept.value, 1);
  EXPECT_EQ(p.all.relative_displacement.value, 0);
  EXPECT_EQ(p.all.determinant.value, p.all.determinant_before);
}

TEST_P(ElementPredictions, AreTheSameInAllExecutionSpaces) {
  Case const c(box_with_body(12, GetParam()));
  Morphed const m = moved(c, 0.7);
  ElementPrediction const one = prediction(HostInstance(Kokkos::Serial()), c, m, {16, 200}),
                          other = prediction(HostInstance(Kokkos::DefaultHostExecutionSpace()), c, m, {16, 200});
  EXPECT_EQ(one.all.elements, other.all.elements);
  EXPECT_EQ(one.all.inverted, other.all.inverted);
  EXPECT_EQ(one.all.kept.value, other.all.kept.value);
  EXPECT_EQ(one.all.kept.element, other.all.kept.element);
  EXPECT_EQ(one.all.relative_displacement.element, other.all.relative_displacement.element);
}

INSTANTIATE_TEST_SUITE_P(Of, ElementPredictions, testing::Bool(),
                         [](auto const& info) { return info.param ? "tetrahedra" : "hexahedra"; });

}  // namespace
}  // namespace gridmorph
