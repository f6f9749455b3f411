// Motions that all boundaries have in common, on meshes of real size and shape.
#include "invariants/common_motion_runs.hpp"
#include "support/reduced.hpp"
#include "support/shared_mesh.hpp"

#include <generators/passage.hpp>
#include <gridmorph/io/mesh_io.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace gridmorph::test {
namespace {

/// Of the mesh that it makes: largest distance of nodes from where the map takes them, and how the smallest determinant
/// changes.
void expect_common(Mesh const& mesh, Motion const& motion, Map const& map, std::string const& what) {
  Outcome const run = morph_split(mesh, motion);
  EXPECT_LE(distance_from(run, map), 1e-12) << what;
  EXPECT_NEAR(smallest_determinant(mesh, run.morphed.position), smallest_determinant(mesh, mesh.coordinates), 1e-10)
      << what;
}

RigidTransform turn(Vec3 const& origin, Vec3 const& axis, double degrees) {
  return rotation_about(origin, axis, degrees * std::numbers::pi / 180);
}

TEST(CommonMotionOfRealBlocks, IsThatOfAWingOf38Zones) {
  Mesh const mesh = read_mesh(shared_mesh("mdo_tutorial_000_vol.cgns"));
  for (double const degrees : {5., 90., 180.}) {
    if (reduced() && degrees != 90) continue;
    RigidTransform const r = turn({1, 2, 3}, {1, 2, 3}, degrees);
    Map const map = [&](Vec3 const& p) { return r(p); };
    expect_common(mesh, motion({rule({"*"}, moves_as(map))}), map, std::to_string(degrees));
  }
}

TEST(CommonMotionOfRealBlocks, IsThatOfAPlaneAirfoil) {
  std::string const file = shared_mesh("slotted_airfoil.cgns");
  if (file.empty()) GTEST_SKIP() << "no stand-in was made";
  Mesh mesh = read_mesh(file);
  // BC names repeat, and the zone tells them apart.
  for (Patch& p : mesh.patches) p.families = {mesh.zones[p.zone].name + "/" + p.name};
  RigidTransform const r = turn({0.3, 0, 0.1}, {0, 1, 0}, 90);
  Map const map = [&](Vec3 const& p) { return r(Vec3{3 * p.x, p.y, 3 * p.z}); };
  // All but the planes, on which nodes slide.
  expect_common(mesh, motion({rule({"*/J*", "*/K*"}, moves_as(map)), rule({"*/I*"}, SlipRule{})}), map, "airfoil");
}

TEST(CommonMotionOfRealBlocks, TurnsAPassageOnItsHubAndCase) {
  PassageOptions options;
  options.nodes = 10'000;
  options.placement = rotation_about({0.1, 0.2, -0.3}, {1, -2, 0.5}, 0.8);
  Axis const axis{options.placement.translation, options.placement.rotation * Vec3{1, 0, 0}};
  Mesh const mesh = make_passage(options);
  for (double const degrees : {5., 180.}) {
    RigidTransform const r = turn(axis.origin, axis.direction, degrees);
    Map const map = [&](Vec3 const& p) { return r(p); };
    Motion m = motion({rule({"blade", "inlet", "outlet", "type:periodic"}, moves_as(map)),
                       rule({"hub", "case"}, SlipRule{SlipRule::Surface::revolution, {}, {}})});
    m.axis = axis;
    expect_common(mesh, m, map, std::to_string(degrees));
  }
}

TEST(CommonMotionOfRealBlocks, TurnsARowOfAStageAndLeavesTheOtherToTheLastBit) {
  Mesh const mesh = read_mesh(shared_mesh("axial_turbine_stage_H.cgns"));
  RigidTransform const r = turn({}, {1, 0, 0}, 30);
  Map const map = [&](Vec3 const& p) { return r(p); };
  Motion m = motion({rule({"BLADE1", "inlet", "mixing_out"}, moves_as(map)),
                     rule({"BLADE2", "outlet", "mixing_in"}, FixedRule{}),
                     rule({"HUB", "SHROUD"}, SlipRule{SlipRule::Surface::revolution, {}, {}})});
  m.axis.direction = {1, 0, 0};
  Outcome const run = morph_split(mesh, m);
  Index const first = mesh.zones[1].first_node;
  double worst = 0;
  Index moved = 0;
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    Vec3 const x = run.morphed.position[n];
    if (n < first)
      worst = std::max(worst, distance(x, map(mesh.coordinates[n])));
    else if (!same_bits(x, mesh.coordinates[n]))
      ++moved;
  }
  EXPECT_LE(worst, 1e-12 * size_of(mesh.coordinates));
  EXPECT_EQ(moved, 0);
}

}  // namespace
}  // namespace gridmorph::test
