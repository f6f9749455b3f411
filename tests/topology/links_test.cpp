// Interfaces: matched nodes, fitted periodic transforms, refusals.
#include <gridmorph/boundary/periodic_axis.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/geometry/rotation.hpp>
#include <gridmorph/plan/topology.hpp>

#include "support/expect_error.hpp"
#include "support/mesh_builders.hpp"
#include "support/random.hpp"
#include "support/scramble.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>

namespace gridmorph::test {
namespace {

TEST(Links, ComeInPairsThatUndoEachOther) {
  Mesh const mesh = scramble(bricks_with_t_junctions(1), {3, 4}).mesh;
  Links const links = connect(mesh, {});
  ASSERT_EQ(links.all.size() % 2, 0u);
  for (Link const& link : links.all) {
    auto const back = std::find_if(links.all.begin(), links.all.end(), [&](Link const& other) {
      return other.zone == link.donor_zone && other.donor_zone == link.zone &&
             other.range == link.to_donor(link.range) && other.to_donor(other.range) == link.range;
    });
    ASSERT_NE(back, links.all.end());
    Index3 const p = link.range.begin;
    EXPECT_EQ(back->to_donor(link.to_donor(p)), p);
  }
}

TEST(Links, StoredFromOneSideOrBothAreTheSame) {
  Mesh const once = bricks_with_t_junctions(1);
  Mesh const twice = scramble(once, {1, 0, false, false, false}).mesh;
  ASSERT_EQ(twice.interfaces.size(), 2 * once.interfaces.size());
  EXPECT_EQ(connect(once, {}).all.size(), connect(twice, {}).all.size());
}

/// CGNS angles are about x, then y, then z: for an oblique axis they are no rotation vector.
TEST(PeriodicAxis, IsThatOfTheTransformForObliqueAxesHalfTurnsAndFullAnglesAlike) {
  Vec3 const centre{0.3, -0.2, 0.5};
  for (Vec3 const& direction : {Vec3{1, 2, -0.5}, Vec3{-0.4, 0.3, 0.8}, Vec3{1, 1, 1}, Vec3{0, 0, 1}})
    for (double const angle : {0.1, 2.0, 3.14159265358979312}) {
      Vec3 const unit = (1 / norm(direction)) * direction;
      Periodic const periodic = periodic_rotation(centre, direction, angle);
      auto const turn = as_turn(periodic.declared, 1e-12);
      ASSERT_TRUE(turn);
      EXPECT_NEAR(turn->angle_rad, angle, 1e-12);
      double const sense = angle > 3 && dot(turn->direction, unit) < 0 ? -1 : 1;  // half a turn has no sense
      EXPECT_LT(distance(sense * turn->direction, unit), 1e-7);
      EXPECT_LT(norm(cross(turn->origin - centre, unit)), 1e-7);
    }
  EXPECT_FALSE(as_turn(rotation_about(centre, {1, 0, 0}, 0.5).then({Mat3{}, {1, 0, 0}}), 1e-6)) << "a screw";
  EXPECT_FALSE(as_turn({Mat3{}, {1, 2, 3}}, 1e-6));
}

TEST(PeriodicAxis, PointsOnALineLeaveTheTurnAboutItAsDeclared) {
  Periodic const periodic = periodic_rotation({}, {0, 0, 1}, 0.5);
  std::vector<Vec3> from, to;
  for (double const r : {1.0, 1.3, 2.0}) {  // the periodic edge of a 2-D mesh
    from.push_back({r, 0, 0});
    to.push_back(periodic.declared(from.back()));
  }
  RigidTransform const fit = fit_periodic(periodic, from, to, 4);
  for (Vec3 const& p : {Vec3{1, 2, 3}, Vec3{-1, 0.5, 0}}) EXPECT_LT(distance(fit(p), periodic.declared(p)), 1e-14);
}

TEST(Links, PeriodicRotationIsFittedToTheNodesNotTakenFromTheFile) {
  Sector sector;
  sector.copies = 7;  // an angle that single precision cannot hold
  Mesh const mesh = annulus_sector(sector, 1);
  ASSERT_FALSE(flaws(mesh, 1e-11).empty()) << "the declared angle is meant to be off";
  Links const links = connect(mesh, {});
  ASSERT_EQ(links.all.size(), 2u);
  for (Link const& link : links.all) {
    EXPECT_TRUE(link.periodic);
    EXPECT_LT(link.mismatch, 1e-14 * links.mesh_size);
  }
  Vec3 const p{0.3, 1.7, -0.4};
  Vec3 const there = links.all[0].transform(p), turned = links.all[1].transform(there);
  EXPECT_LT(distance(turned, p), 1e-14);
  Vec3 const c = sector_coordinates(sector, p), c2 = sector_coordinates(sector, there);
  EXPECT_NEAR(c2.x, c.x, 1e-13);
  EXPECT_NEAR(c2.y, c.y, 1e-13);
  EXPECT_NEAR(std::abs(std::remainder(c2.z - c.z, 8 * std::atan(1.0))), 8 * std::atan(1.0) / 7, 1e-13);
}

/// A sector of one cell across, its sides in two zones: one high, one of a thin strip, with what single precision makes
/// of nodes.
Mesh sector_with_a_strip(double pitch, double pitch_of_the_strip, double height, double noise) {
  Random random(5);
  MeshBuilder build("strip");
  auto const zone = [&](std::string const& name, double from, double to, double angle) {
    return build.zone(name, {5, 5, 3}, [&, from, to, angle](Index3 const& n) {
      double const r = from + (to - from) * n[1] / 4, a = angle * n[2] / 2;
      return Vec3{0.25 * n[0], r * std::cos(a), r * std::sin(a)} + random.vector(noise);
    });
  };
  for (auto const& [z, angle] : {std::pair(zone("high", 1, 2, pitch), pitch),
                                 std::pair(zone("strip", 2, 2 + height, pitch_of_the_strip), pitch_of_the_strip)}) {
    IndexRange const all = whole(build.mesh().zones[z]);
    // One is declared there, the other one back; both as the pitch of the first.
    bool const back = z == 1;
    build.join(z, face_of(all, 2, back ? 1 : 0), z, face_of(all, 2, back ? 0 : 1), {},
               periodic_rotation({}, {1, 0, 0}, back ? -pitch : pitch));
  }
  return build.finish();
}

double farthest_from(RigidTransform const& t, RigidTransform const& wanted) {
  double out = 0;
  for (Vec3 const& p : {Vec3{1, 0, 0}, Vec3{0, 2, 0}, Vec3{0, 0, 2}}) out = std::max(out, distance(t(p), wanted(p)));
  return out;
}

TEST(Links, SidesOfAPitchAreFittedAsOneSoThatAStripTurnsAsWellAsTheRest) {
  double const pitch = 0.3, noise = 6e-8;
  Mesh const mesh = sector_with_a_strip(pitch, pitch, 0.002, noise);
  TopologyOptions loose;
  loose.matching_tolerance = 1e-5;
  std::set<double> off;
  for (Link const& link : connect(mesh, loose).all) {
    bool const back = (link.transform.rotation * Vec3{0, 1, 0}).z < 0;
    off.insert(farthest_from(link.transform, periodic_rotation({}, {1, 0, 0}, back ? -pitch : pitch).declared));
  }
  // Alone the strip, as thin as 3e4 times the noise, would leave its turn about its own length open by some 1e-5.
  EXPECT_LT(*off.rbegin(), 5 * noise);
}

TEST(Links, SidesThatTurnOtherwiseThanTheRestAreFittedAlone) {
  double const pitch = 0.3, other = 0.3 + 2e-7;
  TopologyOptions loose;
  loose.matching_tolerance = 1e-5;
  for (Link const& link : connect(sector_with_a_strip(pitch, other, 0.5, 0), loose).all) {
    bool const back = (link.transform.rotation * Vec3{0, 1, 0}).z < 0;
    double const angle = link.zone == 0 ? pitch : other;
    EXPECT_LT(farthest_from(link.transform, periodic_rotation({}, {1, 0, 0}, back ? -angle : angle).declared), 1e-12);
    EXPECT_LT(link.mismatch, 1e-14);
  }
}

TEST(Links, FitFindsAnyRigidTransform) {
  Random random(11);
  for (int n = 0; n < 20; ++n) {
    RigidTransform const t = rotation_about(random.vector(2), random.vector(1), random.between(-3.1, 3.1));
    std::vector<Vec3> from, to;
    for (int p = 0; p < 12; ++p) {
      from.push_back(random.vector(3));
      to.push_back(t(from.back()));
    }
    RigidTransform const fit = fit_rigid_transform(from, to);
    for (int p = 0; p < 12; ++p) EXPECT_LT(distance(fit(from[p]), to[p]), 1e-13);
    Vec3 const far{10, -10, 10};
    EXPECT_LT(distance(fit(far), t(far)), 1e-12);
  }
}

TEST(Links, TranslationIsFittedToo) {
  Mesh mesh = translational(1, 2);
  mesh.interfaces[0].periodic->declared.translation += Vec3{0, 0, 1e-9};
  for (Link const& link : connect(mesh, {}).all) {
    EXPECT_LT(link.mismatch, 1e-14);
    EXPECT_EQ(link.transform.rotation * Vec3({1, 2, 3}), Vec3({1, 2, 3}));
  }
}

TEST(Links, RefusesInterfacesWhoseNodesDoNotCoincide) {
  Mesh mesh = l_shape(1);
  Interface1to1 const& face = mesh.interfaces.front();
  Index3 p = face.range.begin;
  ++p[1];
  ++p[2];
  Index const n = mesh.zones[face.zone].node(p);
  mesh.coordinates.x(n) += 1e-3;
  std::string const text = message_of<MeshError>([&] { connect(mesh, {}); });
  expect_all_in(text, {face.name, mesh.zones[face.zone].name, mesh.zones[face.donor_zone].name, "0.001",
                       describe_node(mesh, n), "matching_tolerance"});
  EXPECT_NO_THROW(connect(mesh, {.matching_tolerance = 2e-3, .open_faces = ""}));
}

TEST(Links, RefusesADonorZoneThatDoesNotExist) {
  Mesh mesh = l_shape(1);
  mesh.interfaces.front().donor_zone = 17;
  expect_all_in(message_of<MeshError>([&] { connect(mesh, {}); }), {mesh.interfaces.front().name, "donor zone"});
  mesh.interfaces.front().donor_zone = -1;
  EXPECT_THROW(connect(mesh, {}), MeshError);
}

TEST(Links, RefusesRangesOutOfBoundsOnEitherSide) {
  Mesh own = l_shape(1);
  own.interfaces.front().range.end[1] += 40;
  expect_all_in(message_of<MeshError>([&] { connect(own, {}); }), {own.interfaces.front().name, "range"});
  Mesh donor = l_shape(1);
  donor.interfaces.front().to_donor.donor_origin[1] += 2;
  expect_all_in(message_of<MeshError>([&] { connect(donor, {}); }), {donor.interfaces.front().name, "donor range"});
  Mesh inside = l_shape(1);
  Interface1to1& face = inside.interfaces.front();
  int const axis = face_axis(face.range);
  --face.range.begin[axis];
  --face.range.end[axis];
  EXPECT_THROW(connect(inside, {}), MeshError);
}

TEST(Links, AllBadInterfacesAreReportedAtOnce) {
  Mesh mesh = l_shape(1);
  ASSERT_GE(mesh.interfaces.size(), 2u);
  for (auto& face : mesh.interfaces) face.donor_zone = 99;
  expect_all_in(message_of<MeshError>([&] { connect(mesh, {}); }), {mesh.interfaces[0].name, mesh.interfaces[1].name});
}

TEST(Links, NonFiniteCoordinatesAreNamed) {
  Mesh mesh = box({4, 5, 6}, Shape::straight, 1);
  mesh.coordinates.y(mesh.zones[0].node({1, 2, 3})) = std::nan("");
  expect_all_in(message_of<MeshError>([&] { connect(mesh, {}); }), {"i 2, j 3, k 4", "finite"});
}

}  // namespace
}  // namespace gridmorph::test
