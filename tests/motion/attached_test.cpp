// What goes along with walls.
#include <gridmorph/core/error.hpp>
#include <gridmorph/geometry/rotation.hpp>
#include <gridmorph/motion/boundary_motion.hpp>

#include "support/expect_error.hpp"
#include "support/motions.hpp"

#include <gtest/gtest.h>

namespace gridmorph::test {
namespace {

using How = AttachedRule::How;

/// A box of 2 x 1 x 1.2 whose face u_min moves by `field`; u_max goes along with it.
Vec3 attached_displacement(VectorField const& field, AttachedRule rule_of_part, Vec3 const& at) {
  rule_of_part.of = {"u_min"};
  Mesh const mesh = box({3, 5, 5}, Shape::straight, 1);
  Motion const m = motion({rule({"u_min"}, function_rule(field)), rule({"u_max"}, rule_of_part)});
  BoundaryMotion const moves(mesh, resolve(mesh, m));
  EXPECT_TRUE(moves.is_explicit(1));
  Vec3 u;
  moves.displacement(1, {&at, 1}, {&u, 1});
  return u;
}

TEST(Attached, ARigidMotionOfTheWallsIsTakenOverWhateverItsSize) {
  for (double const angle : {0.01, 1.0, 3.0}) {
    Mat3 const turn = rotation_by({0.3 * angle, -0.5 * angle, 0.8 * angle});
    VectorField const field = [&](Vec3 const& p) { return turn * p - p + Vec3{0.1, 0.2, -0.3}; };
    Vec3 const at{2, 0.3, 0.7};
    EXPECT_LE(distance(attached_displacement(field, {{}, How::rigid}, at), field(at)), 1e-14);
  }
}

TEST(Attached, AShiftIsTheMeanOfTheWallsAndKeepsSpacing) {
  VectorField const field = [](Vec3 const& p) { return Vec3{p.y, 0, 2 * p.z}; };  // means 0.5 and 1.2
  Vec3 const u = attached_displacement(field, {{}, How::shift}, {2, 0.9, 0.1});
  EXPECT_LE(distance(u, {0.5, 0, 1.2}), 1e-14);
}

TEST(Attached, TheNearestPlaceOfTheWallDecidesNodeByNode) {
  VectorField const field = [](Vec3 const& p) { return Vec3{0, p.z, -p.y}; };  // linear, so exact between nodes
  Vec3 const at{2, 0.33, 0.71};
  EXPECT_LE(distance(attached_displacement(field, {{}, How::nearest}, at), field(at)), 1e-14);
}

TEST(Attached, OnlyNodesNearThePlaceCountAndNoneIsAnError) {
  VectorField const field = [](Vec3 const& p) { return Vec3{p.z, 0, 0}; };
  Vec3 const corner{0, 0, 1.2};
  EXPECT_LE(distance(attached_displacement(field, {{}, How::shift, std::pair(corner, 0.1)}, {2, 0, 0}), {1.2, 0, 0}),
            1e-15);
  expect_all_in(message_of<MotionError>([&] {
                  attached_displacement(field, {{}, How::shift, std::pair(Vec3{-1, 0, 0}, 0.5)}, {2, 0, 0});
                }),
                {"no node of the walls", "distance of 1.0"});
}

TEST(Attached, WallsAtRestGiveExactlyZero) {
  for (How const how : {How::rigid, How::shift, How::nearest})
    EXPECT_EQ(attached_displacement([](Vec3 const&) { return Vec3{}; }, {{}, how}, {2, 0.3, 0.7}), Vec3{});
}

TEST(Attached, WallsWhoseMotionIsNotKnownBeforehandAreRefused) {
  Mesh const mesh = box({3, 5, 5}, Shape::straight, 1);
  expect_all_in(message_of<MotionError>([&] {
                  resolve(mesh, motion({rule({"u_min"}, FreeRule{}), rule({"u_max"}, AttachedRule{{"u_min"}})}));
                }),
                {"'u_min'", "not known beforehand"});
}

}  // namespace
}  // namespace gridmorph::test
