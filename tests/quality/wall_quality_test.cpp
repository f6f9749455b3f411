// First cell height and orthogonality at walls: analytic walls and a plain second computation.
#include <gridmorph/core/error.hpp>
#include <gridmorph/quality/quality.hpp>

#include "quality/test_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph {
namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;

/// All six faces of a one-zone mesh as patches, in the order i_min, i_max, j_min, ...
void add_faces(Mesh& mesh) {
  Index3 const n = mesh.zones[0].extent;
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      Patch patch;
      patch.zone = 0;
      patch.range = {{0, 0, 0}, n};
      patch.range.begin[axis] = side == 0 ? 0 : n[axis] - 1;
      patch.range.end[axis] = patch.range.begin[axis] + 1;
      mesh.patches.push_back(patch);
    }
}

WallQuality measure(Mesh const& mesh, Coordinates const& now, bool against_baseline, std::vector<int> const& patches) {
  QualityInput<Kokkos::HostSpace> input;
  input.coordinates = views(now);
  if (against_baseline) input.baseline = views(mesh.coordinates);
  input.walls = wall_faces(mesh, std::span<int const>(patches));
  return measure_quality(Exec(), mesh, input).wall;
}

TEST(WallQuality, HeightAndAngleOfAShearedBoxAreThoseOfTheShear) {
  double const shear = 0.5, height = 0.01;
  Mesh mesh = test::one_zone({5, 4, 6}, [&](Index3 const& p) {
    double const z = height * p[2] * (1 + p[2]) / 2;
    return Vec3{p[0] + shear * z, double(p[1]), z};
  });
  add_faces(mesh);
  WallQuality const low = measure(mesh, mesh.coordinates, false, {4});
  EXPECT_EQ(low.nodes, 20);
  EXPECT_NEAR(low.first_height_min, height, 1e-15);
  EXPECT_NEAR(low.first_height_max, height, 1e-15);
  EXPECT_NEAR(low.first_height_mean, height, 1e-15);
  EXPECT_NEAR(low.orthogonality_deg_max, std::atan(shear) * 180 / std::acos(-1.0), 1e-9);
  WallQuality const high = measure(mesh, mesh.coordinates, false, {5});
  EXPECT_NEAR(high.first_height_min, 5 * height, 1e-14);
  EXPECT_EQ(measure(mesh, mesh.coordinates, false, {4, 5}).nodes, 40);
}

TEST(WallQuality, ChangesAgainstTheBaselineAreMeasuredWhereTheyHappen) {
  Mesh mesh = test::one_zone({5, 4, 6}, [](Index3 const& p) { return Vec3{double(p[0]), double(p[1]), 0.1 * p[2]}; });
  add_faces(mesh);
  Coordinates const after = test::moved(mesh, [](Vec3 const& p) { return p; });
  after.z(mesh.zones[0].node({2, 1, 1})) *= 1.3;
  after.x(mesh.zones[0].node({3, 2, 1})) += 0.1;  // 45 degrees
  WallQuality const wall = measure(mesh, after, true, {4});
  EXPECT_NEAR(wall.height_change_max, 0.3, 1e-13);
  EXPECT_EQ(wall.height_change_worst.node, (Index3{2, 1, 0}));
  EXPECT_NEAR(wall.orthogonality_change_deg_max, 45, 1e-6);
  EXPECT_EQ(wall.orthogonality_change_worst.node, (Index3{3, 2, 0}));
  EXPECT_EQ(wall.orthogonality_worst.node, (Index3{3, 2, 0}));
  WallQuality const same = measure(mesh, mesh.coordinates, true, {4});
  EXPECT_EQ(same.height_change_max, 0);
  EXPECT_EQ(same.orthogonality_change_deg_max, 0);
}

// Polar grid around a cylinder, radius as i: heights are radial steps; central differences along a circle are tangent
// to it, one-sided ones are turned by half a step.
TEST(WallQuality, NormalsOnACylinderAreRadialInsideAndTurnedByHalfAStepAtThePatchEdges) {
  double const step = 0.1;
  Mesh mesh = test::one_zone({4, 9, 3}, [&](Index3 const& p) {
    double const r = 1 + 0.05 * p[0], angle = step * p[1];
    return Vec3{r * std::cos(angle), r * std::sin(angle), double(p[2])};
  });
  Patch inner;
  inner.zone = 0;
  inner.range = {{0, 0, 0}, {1, 9, 3}};
  mesh.patches.push_back(inner);
  WallQuality const wall = measure(mesh, mesh.coordinates, false, {0});
  EXPECT_NEAR(wall.first_height_max, 0.05, 1e-14);
  EXPECT_NEAR(wall.first_height_min, 0.05 * std::cos(step / 2), 1e-14);
  EXPECT_NEAR(wall.orthogonality_deg_max, step / 2 * 180 / std::acos(-1.0), 1e-8);
  EXPECT_NEAR(wall.orthogonality_deg_mean, wall.orthogonality_deg_max * 2 / 9, 1e-6);
}

TEST(WallQuality, DoesNotDependOnWhichFaceOfAZoneTheWallIs) {
  auto const place = [](Index3 const& p) {
    return test::wavy({0.1 * p[0], 0.15 * p[1], 0.05 * p[2] * (1 + 0.2 * p[2])}, 0.02);
  };
  Mesh plain = test::one_zone({6, 5, 4}, place);
  add_faces(plain);
  WallQuality const expected = measure(plain, plain.coordinates, false, {4});
  for (Orientation const& o : test::all_orientations()) {
    Index3 const n{6, 5, 4};
    Index3 extent{}, origin{};
    for (int a = 0; a < 3; ++a) {
      extent[o.axis[a]] = n[a];
      origin[o.axis[a]] = o.sign[a] > 0 ? 0 : n[a] - 1;
    }
    IndexMap const back = IndexMap{o, {0, 0, 0}, origin}.inverse();
    Mesh turned = test::one_zone(extent, [&](Index3 const& q) { return place(back(q)); });
    add_faces(turned);
    WallQuality const wall = measure(turned, turned.coordinates, false, {2 * o.axis[2] + (o.sign[2] > 0 ? 0 : 1)});
    EXPECT_EQ(wall.nodes, expected.nodes);
    EXPECT_NEAR(wall.first_height_min, expected.first_height_min, 1e-14);
    EXPECT_NEAR(wall.first_height_mean, expected.first_height_mean, 1e-14);
    EXPECT_NEAR(wall.orthogonality_deg_max, expected.orthogonality_deg_max, 1e-6);
    EXPECT_NEAR(wall.orthogonality_deg_mean, expected.orthogonality_deg_mean, 1e-6);
  }
}

TEST(WallQuality, LeavesOutNodesWithoutANormalOrALine) {
  Mesh mesh = test::one_zone({4, 5, 3}, [](Index3 const& p) {
    double const angle = 0.3 * p[1];
    return Vec3{p[0] * std::cos(angle), p[0] * std::sin(angle), double(p[2])};
  });
  add_faces(mesh);
  EXPECT_EQ(measure(mesh, mesh.coordinates, false, {0}).nodes, 0);   // the axis itself
  EXPECT_EQ(measure(mesh, mesh.coordinates, false, {4}).nodes, 15);  // a plane across it, without its 5 pole nodes
}

TEST(WallQuality, IsGivenByFamilyAndByBcNameWithoutOne) {
  Mesh mesh = test::one_zone({5, 4, 6}, [](Index3 const& p) {
    return Vec3{double(p[0]), 0.5 * p[1], 0.1 * p[2] + 0.01 * p[2] * p[2]};
  });
  add_faces(mesh);  // i_min, i_max: "blade"; j_min, j_max: BC "side"; k_min: BC "floor", in two families
  for (int const p : {0, 1}) mesh.patches[p].families = {"blade"};
  for (int const p : {2, 3}) mesh.patches[p].name = "side";
  mesh.patches[4].name = "floor";
  mesh.patches[4].families = {"hub", "all walls"};
  QualityInput<Kokkos::HostSpace> input;
  input.coordinates = views(mesh.coordinates);
  input.baseline = views(mesh.coordinates);
  std::vector<int> const patches{4, 0, 2, 1, 3};
  input.walls = wall_faces(mesh, std::span<int const>(patches));
  QualityReport const report = measure_quality(Exec(), mesh, input);
  std::vector<std::string> names;
  Index nodes = 0;
  for (WallGroup const& group : report.wall_groups) {
    names.push_back(group.name);
    nodes += group.quality.nodes;
  }
  ASSERT_EQ(names, (std::vector<std::string>{"hub", "blade", "side"}));
  EXPECT_EQ(nodes, report.wall.nodes);
  for (auto const& [group, alone] : {std::pair{0, std::vector<int>{4}}, {1, {0, 1}}, {2, {2, 3}}}) {
    WallQuality const expected = measure(mesh, mesh.coordinates, true, alone),
                      &found = report.wall_groups[group].quality;
    EXPECT_EQ(found.nodes, expected.nodes);
    EXPECT_EQ(found.first_height_min, expected.first_height_min);
    EXPECT_EQ(found.first_height_mean, expected.first_height_mean);
    EXPECT_EQ(found.orthogonality_deg_max, expected.orthogonality_deg_max);
  }
  EXPECT_NEAR(report.wall_groups[0].quality.first_height_max, 0.11, 1e-14);
  EXPECT_NEAR(report.wall_groups[1].quality.first_height_max, 1, 1e-14);
  EXPECT_NEAR(report.wall_groups[2].quality.first_height_max, 0.5, 1e-14);
}

TEST(WallFaces, LeaveOutRangesThatAreNoFaces) {
  Mesh mesh = test::one_zone({4, 5, 3}, [](Index3 const& p) { return Vec3{double(p[0]), double(p[1]), double(p[2])}; });
  for (IndexRange const& range :
       {IndexRange{{0, 0, 0}, {1, 1, 3}}, IndexRange{{2, 0, 0}, {3, 5, 3}}, IndexRange{{0, 4, 0}, {4, 5, 2}}}) {
    Patch patch;
    patch.zone = 0;
    patch.range = range;
    mesh.patches.push_back(patch);
  }
  std::vector<int> const all{0, 1, 2};
  auto const faces = wall_faces(mesh, std::span<int const>(all));
  ASSERT_EQ(faces.size(), 1u);
  EXPECT_EQ(faces[0].axis, 1);
  EXPECT_EQ(faces[0].side, 1);
}

TEST(WallQuality, RefusesAWallOutsideItsZone) {
  Mesh const mesh = test::one_zone({4, 5, 3}, [](Index3 const& p) {
    return Vec3{double(p[0]), double(p[1]), double(p[2])};
  });
  QualityInput<Kokkos::HostSpace> input;
  input.coordinates = views(mesh.coordinates);
  input.walls = {{0, {{0, 0, 0}, {1, 6, 3}}, 0, 0}};
  EXPECT_THROW(measure_quality(Exec(), mesh, input), MeshError);
}

}  // namespace
}  // namespace gridmorph
