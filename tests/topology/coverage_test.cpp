// Every face cell belongs to exactly one patch or interface; what is refused and what is completed.
#include <gridmorph/core/error.hpp>

#include "support/expect_error.hpp"
#include "support/mesh_builders.hpp"
#include "topology/topology_support.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace gridmorph::test {
namespace {

void check(Mesh const& mesh) { check_coverage(mesh, connect(mesh, {})); }

int patch_on(Mesh const& mesh, std::string const& family) {
  return int(std::find_if(mesh.patches.begin(), mesh.patches.end(),
                          [&](Patch const& p) { return p.families.front() == family; }) -
             mesh.patches.begin());
}

TEST(Coverage, AcceptsEveryBuiltMesh) {
  for (Mesh const& mesh : {box({4, 5, 6}, Shape::curved, 1), bricks_with_t_junctions(1), l_shape(1), around_a_box(1),
                           annulus_sector({}, 1), o_grid(1, 1), o_grid(0, 1), c_grid(1), star(3, 1), star(5, 1),
                           translational(1, 1), translational(2, 1)})
    EXPECT_NO_THROW(check(mesh)) << mesh.source;
}

TEST(Coverage, RefusesAnUncoveredFaceAndNamesZoneFaceAndRange) {
  Mesh mesh = box({4, 5, 6}, Shape::curved, 1);
  mesh.patches.erase(mesh.patches.begin() + patch_on(mesh, "v_max"));
  expect_all_in(message_of<MeshError>([&] { check(mesh); }), {"box1", "j_max", "[1:4, 5:5, 1:6]", "open_faces"});
}

TEST(Coverage, RefusesAHoleInAFace) {
  Mesh mesh = box({6, 5, 6}, Shape::curved, 1);
  mesh.patches[patch_on(mesh, "w_min")].range.end[0] = 4;
  expect_all_in(message_of<MeshError>([&] { check(mesh); }), {"box1", "k_min", "[4:6, 1:5, 1:1]"});
}

TEST(Coverage, RefusesOverlappingPatchesAndNamesBoth) {
  Mesh mesh = box({6, 5, 6}, Shape::curved, 1);
  Patch extra = mesh.patches[patch_on(mesh, "u_min")];
  extra.name = "second";
  extra.families = {"second"};
  extra.range.begin[1] = 2;
  mesh.patches.push_back(extra);
  expect_all_in(message_of<MeshError>([&] { check(mesh); }), {"second", "u_min", "overlaps", "box1", "i_min"});
}

TEST(Coverage, RefusesAPatchOnAnInterface) {
  Mesh mesh = l_shape(1);
  Interface1to1 const& face = mesh.interfaces.front();
  mesh.patches.push_back({"intruder", "", PatchKind::wall, {"intruder"}, face.zone, face.range});
  expect_all_in(message_of<MeshError>([&] { check(mesh); }), {"intruder", "overlaps", face.name});
}

TEST(Coverage, RefusesPatchesOutOfBoundsOrInsideTheZone) {
  Mesh outside = box({6, 5, 6}, Shape::curved, 1);
  outside.patches[0].range.end[1] = 9;
  expect_all_in(message_of<MeshError>([&] { check(outside); }), {outside.patches[0].name, "box1", "1:9"});
  Mesh inside = box({6, 5, 6}, Shape::curved, 1);
  ++inside.patches[0].range.begin[0];
  ++inside.patches[0].range.end[0];
  expect_all_in(message_of<MeshError>([&] { check(inside); }), {inside.patches[0].name, "2:2"});
  Mesh negative = box({6, 5, 6}, Shape::curved, 1);
  negative.patches[0].range.begin[2] = -3;
  EXPECT_THROW(check(negative), MeshError);
}

TEST(Coverage, RefusesPatchesOfZonesThatDoNotExist) {
  Mesh mesh = box({6, 5, 6}, Shape::curved, 1);
  mesh.patches[0].zone = 5;
  expect_all_in(message_of<MeshError>([&] { check(mesh); }), {mesh.patches[0].name, "zone number 5"});
  mesh.patches[0].zone = -1;
  EXPECT_THROW(check(mesh), MeshError);
}

TEST(Coverage, PatchesAreCheckedBeforeTheyAreCompleted) {
  Mesh mesh = box({6, 5, 6}, Shape::curved, 1);
  mesh.patches[0].range.end[1] = 4000;
  EXPECT_THROW(complete_patches(mesh, connect(mesh, {}), {0, "open"}), MeshError);
}

TEST(Coverage, OpenFacesBecomeAPatchWhereTheUserSaysSo) {
  Mesh mesh = box({6, 5, 6}, Shape::curved, 1);
  mesh.patches.erase(mesh.patches.begin() + patch_on(mesh, "v_max"));
  mesh.patches[patch_on(mesh, "w_min")].range.end[0] = 4;
  TopologyOptions const options{0, "open"};
  complete_patches(mesh, connect(mesh, options), options);
  EXPECT_NO_THROW(check(mesh));
  EXPECT_EQ(std::count_if(mesh.patches.begin(), mesh.patches.end(), [](Patch const& p) { return p.name == "open"; }),
            2);
  EXPECT_FALSE(mesh.notes.empty());
}

TEST(Coverage, CollapsedFacesBecomePolesByThemselves) {
  Mesh mesh = o_grid(0, 1);
  mesh.patches.erase(mesh.patches.begin() + patch_on(mesh, "pole"));
  complete_patches(mesh, connect(mesh, {}), {});
  EXPECT_NO_THROW(check(mesh));
  EXPECT_EQ(mesh.patches.back().kind, PatchKind::degenerate);
  EXPECT_EQ(mesh.patches.back().range, face_of(whole(mesh.zones[0]), 1, 0));
}

}  // namespace
}  // namespace gridmorph::test
