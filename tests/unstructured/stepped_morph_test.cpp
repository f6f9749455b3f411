// Motions in several steps: the way of the walls, what arrives where it should, and turns that one step cannot make.
#include "support/random.hpp"
#include "support/reduced.hpp"
#include "support/unstructured_case.hpp"
#include "support/unstructured_meshes.hpp"

#include <generators/sphere.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/geometry/rotation.hpp>
#include <gridmorph/guard/guard.hpp>
#include <gridmorph/guard/motion_path.hpp>
#include <gridmorph/guard/relaxation.hpp>
#include <gridmorph/morph/plan_access.hpp>

#include <gtest/gtest.h>

#include <memory>
#include <numbers>

namespace gridmorph::test {
namespace {

constexpr double degrees = std::numbers::pi / 180;

std::vector<Vec3> cloud(int n, unsigned seed, bool flat) {
  Random random(seed);
  std::vector<Vec3> points;
  for (int k = 0; k < n; ++k) {
    Vec3 p = random.vector(1);
    if (flat) p.z = 0.25 * p.x - 0.5 * p.y;
    points.push_back(p + Vec3{3, -2, 5});
  }
  return points;
}

TEST(RigidFit, FindsTheMotionOfARigidBody) {
  for (bool const flat : {false, true})
    for (double const angle : {0.0, 1e-6, 40.0, 179.0}) {
      auto const before = cloud(50, 3, flat);
      RigidTransform motion = rotation_about({1, 0, 2}, {1, 2, 3}, angle * degrees);
      motion.translation += Vec3{4, 5, -6};
      std::vector<Vec3> after;
      for (Vec3 const& p : before) after.push_back(motion(p));
      auto const fit = rigid_fit(before, after);
      ASSERT_TRUE(fit) << angle;
      for (std::size_t n = 0; n < before.size(); ++n)
        EXPECT_LT(distance(fit->to + fit->rotation * (before[n] - fit->from), after[n]), 1e-12) << angle;
      EXPECT_NEAR(norm(rotation_vector(fit->rotation)), angle * degrees, 1e-9);
      EXPECT_LT(norm(rotation_by(rotation_vector(fit->rotation)) * Vec3{1, 2, 4} - fit->rotation * Vec3{1, 2, 4}),
                1e-12);
    }
}

TEST(RigidFit, LinesAndMirroredPointsHaveNone) {
  std::vector<Vec3> line, mirrored;
  for (int k = 0; k < 9; ++k) line.push_back(double(k) * Vec3{1, 2, 3});
  EXPECT_FALSE(rigid_fit(line, line));
  auto const points = cloud(30, 5, false);
  for (Vec3 p : points) {
    p.x = -p.x;
    mirrored.push_back(p);
  }
  EXPECT_FALSE(rigid_fit(points, mirrored));
  EXPECT_FALSE(rigid_fit({}, {}));
}

UnstructuredCase sphere(Index elements) {
  SphereOptions options;
  options.elements = elements;
  return UnstructuredCase(make_sphere(options));
}

Motion turn(double angle, Vec3 const& shift = {}) {
  return motion_of({rule_for({"sphere"}, rotation({0, 0, 0}, {1, 2, 3}, angle * degrees, shift)),
                    rule_for({"outer"}, translation({0, 0, 0}))});
}

TEST(MotionPath, ABodyKeepsItsShapeOnTheWay) {
  auto const c = sphere(12'000);
  auto const prepared = prepare(c.mesh, c.topology, c.face_patches, turn(120, {0.5, 0, 0}), {});
  auto const u = prepared.boundary_displacement();
  MotionPath const path(c.mesh.coordinates, prepared.graph, prepared.boundary, u);
  auto const& known = prepared.plan.known;
  for (double const share : {0.0, 0.25, 0.7, 1.0}) {
    auto const now = path.at(share);
    RigidTransform const expected = rotation_about({0, 0, 0}, {1, 2, 3}, share * 120 * degrees);
    for (std::size_t k = 0; k < known.size(); ++k) {
      Vec3 const x = c.mesh.coordinates[known[k]];
      Vec3 const where = prepared.boundary.drives[k] ? expected(x) + share * Vec3{0.5, 0, 0} : x;
      EXPECT_LT(distance(x + now[k], where), 1e-11) << share;
      if (share == 1) {
        EXPECT_EQ(norm(now[k] - u[k]), 0);
      }
    }
  }
}

TEST(MotionPath, WhatBendsGoesStraight) {
  auto const c = sphere(12'000);
  FunctionRule const bend{"bends", [](std::span<Vec3 const> x, std::span<Vec3> u) {
                            for (std::size_t n = 0; n < x.size(); ++n) u[n] = {x[n].z * x[n].z, 0, -0.5 * x[n].x};
                          }};
  auto const prepared = prepare(c.mesh, c.topology, c.face_patches, motion_of({rule_for({"sphere"}, bend)}), {});
  auto const u = prepared.boundary_displacement();
  auto const half = MotionPath(c.mesh.coordinates, prepared.graph, prepared.boundary, u).at(0.5);
  for (std::size_t k = 0; k < u.size(); ++k) EXPECT_EQ(norm(half[k] - 0.5 * u[k]), 0);
}

TEST(SteppedMorph, ABodyTurnsByARightAngle) {
  for (Index const elements : reduced() ? std::vector<Index>{40'000} : std::vector<Index>{40'000, 90'000}) {
    auto c = sphere(elements);
    auto const motion = turn(150);
    auto in_one = c.guarded_morph(motion);
    auto const known = in_one.prepared.plan.known;
    MorphPlan const plan = PlanAccess::of(std::move(in_one.prepared));
    Coordinates const baseline = c.mesh.coordinates;
    int calls = 0;
    StepOptions options;
    options.progress = [&](int step) { EXPECT_EQ(step, ++calls); };
    Coordinates const x = morph_in_steps(c.mesh, c.topology, c.face_patches, plan, in_one.boundary, options);
    EXPECT_EQ(calls, 2);
    EXPECT_EQ(c.mesh.coordinates.x.data(), baseline.x.data());
    EXPECT_EQ(c.inverted(x), 0) << elements;
    for (std::size_t k = 0; k < known.size(); ++k)
      EXPECT_EQ(norm(x[known[k]] - (baseline[known[k]] + in_one.boundary[k])), 0);
  }
}

TEST(SteppedMorph, AShiftOfEverythingIsOne) {
  auto c = sphere(12'000);
  Motion const motion =
      motion_of({rule_for({"sphere"}, translation({1, 2, 3})), rule_for({"outer"}, translation({1, 2, 3}))});
  MorphPlan const plan(c.mesh, motion);
  StepOptions options;
  options.steps = 3;
  auto const u = plan.boundary_displacement();
  Coordinates const x = morph_in_steps(c.mesh, c.topology, c.face_patches, plan, u, options);
  for (Index n = 0; n < c.mesh.n_nodes(); ++n) EXPECT_LT(norm(x[n] - c.mesh.coordinates[n] - Vec3{1, 2, 3}), 1e-12);
}

/// A box whose sides slide while a patch of the floor is pushed up: nodes stay on their planes.
TEST(SteppedMorph, SlipPlanesAreKept) {
  UnstructuredCase c(to_prisms_and_tetrahedra(unit_box({8, 8, 8}), 2));
  FunctionRule const push{
      "push", [](std::span<Vec3 const> x, std::span<Vec3> u) {
        for (std::size_t n = 0; n < x.size(); ++n)
          u[n] = {0.5, 0, 1.5 * std::exp(-0.2 * (std::pow(x[n].x - 4, 2) + std::pow(x[n].y - 4, 2)))};
      }};
  Motion const motion =
      motion_of({rule_for({"k_min"}, push), rule_for({"i_min", "i_max", "j_min", "j_max"}, SlipRule{}),
                 rule_for({"k_max"}, translation({0, 0, 0}))});
  EXPECT_NO_THROW({
    MorphPlan const plan(c.mesh, motion);
    auto const u = plan.boundary_displacement();
    StepOptions options;
    options.steps = 3;
    Coordinates const before = c.mesh.coordinates;
    Coordinates const x = morph_in_steps(c.mesh, c.topology, c.face_patches, plan, u, options);
    for (Index n = 0; n < c.mesh.n_nodes(); ++n)
      if (before[n].y == 0 || before[n].y == 8) {
        EXPECT_NEAR(x[n].y, before[n].y, 1e-12);
      }
  });
}

TEST(SteppedMorph, ABackgroundMeshOfOnesOwnIsRefusedAndTheMeshIsAsItWas) {
  auto c = sphere(12'000);
  MorphPlan const plan(c.mesh, turn(10));
  Coordinates const before = c.mesh.coordinates;
  StepOptions options;
  options.plan.elements.background = std::make_shared<Background const>();
  auto const u = plan.boundary_displacement();
  EXPECT_THROW(morph_in_steps(c.mesh, c.topology, c.face_patches, plan, u, options), PlanError);
  options.plan.elements.background = {};
  options.progress = [](int step) {
    if (step == 2) throw MotionError("stop");
  };
  EXPECT_THROW(morph_in_steps(c.mesh, c.topology, c.face_patches, plan, u, options), MotionError);
  EXPECT_EQ(c.mesh.coordinates.x.data(), before.x.data());
}

}  // namespace
}  // namespace gridmorph::test
