// The wake of the demo passage, as a region of blocks and of hexahedra.
#include "support/morph_run.hpp"
#include "support/motions.hpp"
#include "support/unstructured_case.hpp"

#include <generators/passage.hpp>
#include <generators/passage_motion.hpp>
#include <gridmorph/mesh/as_hexahedra.hpp>
#include <gridmorph/morph/morph.hpp>
#include <gridmorph/morph/prediction.hpp>
#include <gridmorph/motion/wake/wake_places.hpp>
#include <gridmorph/quality/quality.hpp>

#include <gtest/gtest.h>

namespace gridmorph::test {
namespace {

/// The blade turns about the axis by an angle, and its wake goes along.
Motion turned(double angle) {
  Mat3 const turn = rotation_matrix({1, 0, 0}, angle);
  WakeRule wake;
  wake.of = {"blade"};
  Motion m = motion({rule({"blade"}, RigidRule{turn, {}}), rule({"wake"}, wake),
                     rule({"inlet", "outlet"}, CircumferentialSlideRule{{"blade"}}),
                     rule({"type:periodic"}, FollowRule{{"blade"}}),
                     rule({"hub", "case"}, SlipRule{SlipRule::Surface::revolution})});
  m.axis = Axis{{0, 0, 0}, {1, 0, 0}};
  InnerRegion region;
  region.name = "wake";
  region.zones = {"outlet*"};
  region.wake = InnerRegion::Wake{{"blade"}, false, {}, {1, 0, 0}, {}, 0.05, 0.03};
  m.regions = {region};
  return m;
}

PassageOptions small_options() {
  PassageOptions options;
  options.nodes = 10'000;
  return options;
}

Mesh small_passage() { return make_passage(small_options()); }

constexpr double angle = 0.02;

/// Every node of the region is where the turn about the axis takes it.
void expect_turned(Mesh const& mesh, std::vector<Index> const& nodes, Coordinates const& morphed) {
  RigidTransform const turn = rotation_about({0, 0, 0}, {1, 0, 0}, angle);
  ASSERT_GT(nodes.size(), 100U);
  for (Index const n : nodes) ASSERT_LE(distance(morphed[n], turn(mesh.coordinates[n])), 1e-12) << n;
}

TEST(PassageWake, OfBlocksTurnsWithItsBlade) {
  PreparedMorph const prepared = prepare(HostInstance(), small_passage(), turned(angle), without_near_field());
  std::vector<Index> nodes;
  for (std::size_t p = 0; p < prepared.mesh.patches.size(); ++p)
    if (prepared.mesh.patches[p].name == "wake") {
      auto const& of = prepared.surface.boundary().surface(int(p)).nodes;
      nodes.insert(nodes.end(), of.begin(), of.end());
    }
  auto const morphed =
      run_plan(Kokkos::DefaultHostExecutionSpace(), prepared.mesh, prepared.plan(), prepared.boundary_displacement());
  expect_turned(prepared.mesh, nodes, morphed.position);
  QualityInput<Kokkos::HostSpace> input;
  input.coordinates = views(morphed.position);
  input.baseline = views(prepared.mesh.coordinates);
  EXPECT_EQ(measure_quality(Kokkos::DefaultHostExecutionSpace(), prepared.mesh, input).far_field.inverted, 0);
}

TEST(PassageWake, OfHexahedraTurnsWithItsBlade) {
  UnstructuredCase const one(as_hexahedra(small_passage()));
  UnstructuredMorphed const morphed = one.guarded_morph(turned(angle));
  Boundary const& boundary = morphed.prepared.boundary.motion->boundary();
  std::vector<Index> nodes;
  for (std::size_t p = 0; p < boundary.patches().size(); ++p)
    if (boundary.patches()[p].name == "wake") nodes = boundary.surface(int(p)).nodes;
  expect_turned(one.mesh, nodes, morphed.x);
  EXPECT_EQ(one.inverted(morphed.x), 0);
}

/// The sections of the blade turn by 10 degrees, and the wake goes along and fades.
Motion turned_sections(double width, double fade) {
  Motion m = turned(0);
  m.rules[0].rule = function_rule(
      [options = small_options()](Vec3 const& p) { return passage_displacement(options, rotated_sections(), p); });
  std::get<WakeRule>(m.rules[1].rule).fade = fade;
  m.regions[0].wake->width = width;
  m.regions[0].wake->length = 0.1;
  return m;
}

TEST(PassageWake, FadesToWhatThePeriodicSidesDo) {
  PreparedMorph const prepared = prepare(HostInstance(), small_passage(), turned_sections(0.03, 0.02), {});
  std::vector<Vec3> points;
  for (Index n = 0; n < prepared.mesh.n_nodes(); n += 17)
    if (prepared.mesh.coordinates[n].x > 0.1) points.push_back(prepared.mesh.coordinates[n]);
  ASSERT_GT(points.size(), 20U);
  std::vector<Vec3> wake(points.size()), follow(points.size());
  prepared.surface.displacement(1, points, wake);
  prepared.surface.displacement(3, points, follow);
  double moved = 0;
  for (std::size_t n = 0; n < points.size(); ++n) {
    EXPECT_LE(distance(wake[n], follow[n]), 1e-15) << n;
    moved = std::max(moved, norm(wake[n]));
  }
  EXPECT_GT(moved, 1e-3);
}

/// Short fades shear more than an angle can keep; no width and no fade inverts cells.
TEST(PassageWake, OfAnyWidthInvertsNothing) {
  Mesh const mesh = small_passage();
  auto const predicted = [&](Motion const& m) {
    MorphPlan const plan(mesh, m);
    return predict(HostInstance(), IndexedMesh(mesh), plan, plan.boundary_displacement(), {.every = 1}).all;
  };
  Motion without = turned_sections(0.01, 0.1);
  without.regions.clear();
  without.rules.erase(without.rules.begin() + 1);
  double const angle = predicted(without).angle_deg.value;
  for (double const width : {0.006, 0.012, 0.02, 0.03})
    for (double const fade : {0.1, 0.2}) {
      PredictedCells const cells = predicted(turned_sections(width, fade));
      EXPECT_EQ(cells.inverted, 0) << width << ", " << fade;
      if (fade > 0.1) {
        EXPECT_GT(cells.angle_deg.value, 0.8 * angle) << width << ", " << fade;
      }
    }
}

/// Whatever the blade does, copies one pitch apart get copies of the displacement.
TEST(PassageWake, RepeatsFromPassageToPassage) {
  Mesh const mesh = small_passage();
  Motion m = turned(angle);
  m.rules[0].rule = function_rule([](Vec3 const& p) { return Vec3{0.1 * p.y * p.z, 0.02 * p.x, -0.1 * p.x * p.y}; });
  PreparedMorph const prepared = prepare(HostInstance(), mesh, m, without_near_field());
  RigidTransform const pitch = prepared.surface.boundary().periodic_transforms().front();
  std::vector<Vec3> points, copies;
  for (Index n = 0; n < mesh.n_nodes(); n += 37)
    if (mesh.coordinates[n].x > 0.06) {
      points.push_back(mesh.coordinates[n]);
      copies.push_back(pitch(points.back()));
    }
  ASSERT_GT(points.size(), 20U);
  std::vector<Vec3> u(points.size()), of_copies(points.size());
  prepared.surface.displacement(1, points, u);
  prepared.surface.displacement(1, copies, of_copies);
  for (std::size_t n = 0; n < points.size(); ++n) EXPECT_LE(distance(of_copies[n], pitch.rotation * u[n]), 1e-12) << n;
}

}  // namespace
}  // namespace gridmorph::test
