// Plans and motions that cannot be: what the messages say.
#include <gridmorph/core/error.hpp>

#include "support/expect_error.hpp"
#include "support/morph_run.hpp"
#include "support/motions.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace gridmorph::test {
namespace {

std::vector<std::string> const sides{"v_min", "v_max", "w_min", "w_max"};

VectorField constant(Vec3 const& u) {
  return [u](Vec3 const&) { return u; };
}

TEST(Refusals, BlocksThatNothingReachesAreNamed) {
  auto const text = message_of<PlanError>([] { morph(l_shape(1), motion({rule({"*"}, FreeRule{})})); });
  expect_all_in(text, {"'L1'", "'L2'", "'L3'", "no chain"});
}

// Beside a node so far away all others are at one place, for the tolerance that goes with the size of the mesh.
TEST(Refusals, NodesFarAwayFromAllOthersAreNamed) {
  for (double const far : {1e11, -1e16, 1e99}) {
    Mesh mesh = l_shape(1);
    mesh.coordinates.y(7) = far;
    auto const text = message_of<MeshError>([&] { morph(mesh, motion({rule({"*"}, FixedRule{})})); });
    expect_all_in(text, {describe_node(mesh, 7), "1 node ", "1e+08 times", "repair the mesh"});
  }
  Mesh mesh = l_shape(1);
  for (Index n = 0; n < mesh.n_nodes(); ++n) mesh.coordinates.x(n) += 1e15;
  auto const text = message_of<MeshError>([&] { morph(mesh, motion({rule({"*"}, FixedRule{})})); });
  expect_all_in(text, {"1e+15", "0.22", "nearer to the origin"});
}

TEST(Refusals, OrdersOfChainsThatComeToNoKnownFaceAreNamed) {
  PreparedMorph const prepared = prepare(box({5, 4, 6}, Shape::straight, 1),
                                         motion({rule({"u_min"}, function_rule(constant({0, 0, 0.25}))),
                                                 rule({"u_max", "v_min", "v_max", "w_min", "w_max"}, FreeRule{})}),
                                         without_near_field());
  auto const planned = [&](ChainOrder const& first) {
    return make_plan(HostInstance(), prepared.mesh, prepared.links, prepared.surface, prepared.options, first);
  };
  EXPECT_EQ(planned({{{0, 0}}}).order, prepared.planned.order);
  for (int const axis : {1, 2})
    expect_all_in(message_of<PlanError>([&] { planned({{{0, axis}}}); }), {"order of chains", "box1", "known face"});
}

TEST(Refusals, RulesThatDisagreeOnASharedEdgeAreNamedWithPlaceAndSize) {
  auto const text = message_of<MotionError>([] {
    morph(box({5, 4, 6}, Shape::straight, 1),
          motion({rule({"u_min"}, function_rule(constant({0, 0, 0.25}))), rule({"v_min"}, FixedRule{}),
                  rule({"u_max", "v_max", "w_min", "w_max"}, FreeRule{})}));
  });
  expect_all_in(text, {"u_min", "v_min", "6 common nodes", "box1", "i 1, j 1", "0.25", "rank"});
}

TEST(Refusals, EveryPairThatDisagreesIsListed) {
  auto const text = message_of<MotionError>([] {
    morph(box({5, 4, 6}, Shape::straight, 1),
          motion({rule({"u_min"}, function_rule(constant({0, 0, 0.25}))), rule({"v_min", "w_max"}, FixedRule{}),
                  rule({"u_max", "v_max", "w_min"}, FreeRule{})}));
  });
  expect_all_in(text, {"u_min", "v_min", "w_max"});
}

TEST(Conformity, TheRuleOfLowerRankWinsOnTheSharedEdge) {
  for (bool moving_wins : {true, false}) {
    Outcome const r =
        morph(box({5, 4, 6}, Shape::straight, 1),
              motion({rule({"u_min"}, function_rule(constant({0, 0, 0.25})), moving_wins ? 0 : 2),
                      rule({"v_min"}, FixedRule{}, 1), rule({"u_max", "v_max", "w_min", "w_max"}, FreeRule{})}));
    Zone const& zone = r.mesh.zones[0];
    for (int k = 0; k < 6; ++k) {
      EXPECT_EQ(r.u(zone.node({0, 0, k})), (Vec3{0, 0, moving_wins ? 0.25 : 0}));
      EXPECT_EQ(r.u(zone.node({0, 2, k})), (Vec3{0, 0, 0.25}));
      EXPECT_EQ(r.u(zone.node({2, 0, k})), Vec3{});
    }
  }
}

TEST(Conformity, DifferencesBelowTheToleranceAreOneAndTheSame) {
  Motion m = motion({rule({"u_min"}, function_rule(constant({0, 0, 1e-5}))), rule({"v_min"}, FixedRule{}),
                     rule({"u_max", "v_max", "w_min", "w_max"}, FreeRule{})});
  EXPECT_THROW(morph(box({5, 4, 6}, Shape::straight, 1), m), MotionError);
  m.conformity_tolerance = 1e-4;
  EXPECT_NO_THROW(morph(box({5, 4, 6}, Shape::straight, 1), m));
}

TEST(Refusals, DisplacementsThatAreNotFiniteAreNamed) {
  auto const text = message_of<MotionError>([] {
    morph(box({5, 4, 6}, Shape::straight, 1),
          motion({rule({"u_min"}, function_rule([](Vec3 const& p) {
                         return Vec3{p.y > 0.5 ? std::numeric_limits<double>::quiet_NaN() : 0, 0, 0};
                       })),
                  rule({"u_max"}, FixedRule{}), rule(sides, FreeRule{})}));
  });
  expect_all_in(text, {"test", "nan"});
}

PlanOptions layers(std::vector<std::string> walls, BoundaryLayer::Extent extent, int n) {
  PlanOptions options;
  options.boundary_layers = {{std::move(walls), extent, n, 0, BoundaryLayer::Mode::translate}};
  return options;
}

Motion one_wall() {
  return motion({rule({"u_min"}, function_rule(waves(0.1))), rule({"u_max"}, FixedRule{}), rule(sides, FreeRule{})});
}

TEST(NearField, ThatReachesAnotherBoundaryIsRefused) {
  Index3 const n{5, 4, 6};
  auto const run = [&](BoundaryLayer::Extent extent, int count) {
    morph(box(n, Shape::straight, 1), one_wall(), layers({"u_min"}, extent, count));
  };
  for (int count : {4, 5, 400})
    expect_all_in(message_of<PlanError>([&] { run(BoundaryLayer::Extent::layers, count); }), {"u_min", "layers"});
  expect_all_in(message_of<PlanError>([&] { run(BoundaryLayer::Extent::block, 0); }), {"u_min", "u_max"});
  EXPECT_NO_THROW(run(BoundaryLayer::Extent::layers, 3));
}

TEST(NearField, NeedsAWallThatIsMovedByARule) {
  expect_all_in(
      message_of<PlanError>([] {
        morph(box({5, 4, 6}, Shape::straight, 1), one_wall(), layers({"v_min"}, BoundaryLayer::Extent::layers, 1));
      }),
      {"v_min", "free"});
  EXPECT_THROW(
      morph(box({5, 4, 6}, Shape::straight, 1), one_wall(), layers({"nowhere"}, BoundaryLayer::Extent::layers, 1)),
      Error);
  EXPECT_THROW(morph(box({5, 4, 6}, Shape::straight, 1), motion({rule({"*"}, FixedRule{})}),
                     layers({}, BoundaryLayer::Extent::layers, 1)),
               PlanError);
}

}  // namespace
}  // namespace gridmorph::test
