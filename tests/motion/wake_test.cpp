// Wakes behind wings made from formulas, in planes that are no coordinate planes.
#include "annulus.hpp"
#include "support/expect_error.hpp"
#include "support/motions.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/motion/boundary_motion.hpp>
#include <gridmorph/motion/wake/wake_regions.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace gridmorph::test {
namespace {

using test::RowMesh;
using test::Surface;

constexpr double stagger = 0.35, chord_length = 1.5, wing_span = 4;
RigidTransform const tilted{rotation_matrix({1 / 3.0, -2 / 3.0, 2 / 3.0}, 0.7), {3, -1, 2}};
Vec3 const span = tilted.rotation * Vec3{0, 0, 1}, flow = tilted.rotation * Vec3{1, 0, 0};

/// Along the chord from the leading edge, across it, along the span.
Vec3 place(double x, double y, double z) {
  return tilted(
      {std::cos(stagger) * x - std::sin(stagger) * y, std::sin(stagger) * x + std::cos(stagger) * y, wing_span * z});
}
Vec3 behind(double along, double across, double z) { return place(chord_length + along, across, z); }

/// An untapered wing of lens sections without camber, and a patch of its own far away for the rule about the wake.
Mesh wing() {
  RowMesh row;
  row.add({"wing",
           PatchKind::wall,
           {81, 9},
           [](double s, double t) {
             double const turn = s == 1 ? 0 : s, phi = 2 * std::numbers::pi * turn;
             double const c = 0.5 * (1 - std::cos(phi));
             return place(chord_length * c, (phi < std::numbers::pi ? 0.3 : -0.3) * chord_length * c * (1 - c), t);
           },
           {}});
  row.add({"plane", PatchKind::other, {3, 3}, [](double s, double t) { return place(9 + s, 0, t); }, {}});
  return row.finish();
}

WakeRule wake_of_wing() { return {{"wing"}, SectionsRule::Sections::wing, span, flow, {}, 1}; }

Vec3 moved(VectorField const& of_wing, WakeRule const& wake, Vec3 const& at) {
  Mesh const mesh = wing();
  BoundaryMotion const moves(mesh,
                             resolve(mesh, motion({rule({"wing"}, function_rule(of_wing)), rule({"plane"}, wake)})));
  Vec3 u{7, 7, 7};
  moves.displacement(1, {&at, 1}, {&u, 1});
  return u;
}

/// A turn in the planes of the sections, and a shift.
VectorField rigid(double angle) {
  return [=](Vec3 const& p) {
    return rotation_about(place(0.4, 0, 0), span, angle)(p) - p + tilted.rotation * Vec3{0.2, -0.1, 0.05};
  };
}

TEST(Wake, GoesAlongAsAWholeWithAWingThatTurnsInThePlanesOfItsSections) {
  for (double const angle : {0.0, 0.01, -0.5, 1.2})
    for (Vec3 const& at : {behind(0.01, 0, 0.3), behind(0.2, 0.05, 0.5), behind(3, -0.4, 0.93), place(1.45, 0.02, 0.2)})
      EXPECT_LE(distance(moved(rigid(angle), wake_of_wing(), at), rigid(angle)(at)), 1e-11) << angle;
}

TEST(Wake, TakesItsPartOfTheTurnOnly) {
  WakeRule rule = wake_of_wing();
  rule.turn = 0;
  Vec3 const edge = behind(0, 0, 0.5), at = behind(2, 0.1, 0.5);
  EXPECT_LE(distance(moved(rigid(0.3), rule, at), rigid(0.3)(edge)), 1e-11);
  rule.turn = 0.5;
  Mat3 const half = rotation_matrix(span, 0.15);
  EXPECT_LE(distance(moved(rigid(0.3), rule, at), rigid(0.3)(edge) + (half * (at - edge) - (at - edge))), 1e-11);
}

TEST(Wake, FadesAlongItself) {
  WakeRule rule = wake_of_wing();
  rule.fade = 2;
  for (double const across : {0.0, 0.3}) {
    Vec3 const middle = behind(1, across, 0.4);
    EXPECT_LE(distance(moved(rigid(0.3), rule, middle), 0.5 * rigid(0.3)(middle)), 1e-11);
    EXPECT_EQ(moved(rigid(0.3), rule, behind(2, across, 0.4)), Vec3{});
  }
}

TEST(Wake, IsTheWallOnTheWallWhateverItsMotion) {
  VectorField const bent = waves(0.05);
  Mesh const mesh = wing();
  for (Index const n : {0, 30, 41, 200, 500}) {
    Vec3 const node = mesh.coordinates[n];
    EXPECT_LE(distance(moved(bent, wake_of_wing(), node), bent(node)), 1e-12) << n;
  }
}

TEST(Wake, RestsBehindAWingThatRests) {
  EXPECT_EQ(moved([](Vec3 const&) { return Vec3{}; }, wake_of_wing(), behind(0.3, 0.1, 0.5)), Vec3{});
}

InnerRegion region(std::optional<double> angle) {
  InnerRegion out;
  out.name = "wake";
  out.wake = InnerRegion::Wake{{"wing"}, true, span, flow, angle, 2, 0.4};
  return out;
}

/// Whether the region holds the point.
bool holds(InnerRegion const& of, Vec3 const& at) {
  Mesh const mesh = wing();
  Motion m = motion({rule({"wing"}, FixedRule{}), rule({"plane", "wake"}, FixedRule{})});
  m.regions = {of};
  std::vector<std::string> notes;
  auto const boundary = std::make_shared<Boundary const>(mesh);
  return locate_wakes(boundary, resolve(mesh, without_regions(NamedBoundary(mesh), m)), {&of, 1}, notes)
      .front()
      .holds(at);
}

TEST(WakeRegion, IsABandBehindTheTrailingEdge) {
  InnerRegion const wake = region({});
  for (double const z : {0.1, 0.5, 0.9})
    for (double const side : {-1.0, 1.0}) {
      EXPECT_TRUE(holds(wake, behind(0.01, 0.19 * side, z)));
      EXPECT_TRUE(holds(wake, behind(1.99, 0.19 * side, z)));
      EXPECT_FALSE(holds(wake, behind(-0.01, 0.19 * side, z)));
      EXPECT_FALSE(holds(wake, behind(2.01, 0, z)));
      EXPECT_FALSE(holds(wake, behind(1, 0.21 * side, z)));
    }
}

TEST(WakeRegion, GoesWhereTheAngleSays) {
  double const angle = stagger - 0.4;  // from the flow
  InnerRegion const wake = region(angle);
  Vec3 const edge = behind(0, 0, 0.5);
  Vec3 const along = tilted.rotation * Vec3{std::cos(angle), std::sin(angle), 0}, across = cross(span, along);
  EXPECT_TRUE(holds(wake, edge + 1.9 * along + 0.19 * across));
  EXPECT_FALSE(holds(wake, edge + 1.9 * along + 0.21 * across));
  EXPECT_FALSE(holds(wake, behind(1.9, 0, 0.5)));
}

TEST(WakeRegion, KeepsToWhatElseTheRegionSays) {
  InnerRegion wake = region({});
  Vec3 const middle = behind(1, 0, 0.5);
  wake.holds = [middle](Vec3 const& p) { return distance(p, middle) < 0.5; };
  EXPECT_TRUE(holds(wake, middle));
  EXPECT_FALSE(holds(wake, behind(0.3, 0, 0.5)));
}

TEST(WakeRegion, LeavesRulesThatNamePatchesToo) {
  Motion m =
      motion({rule({"wake", "w*"}, FixedRule{}), rule({"wake"}, FixedRule{}), rule({"type:region"}, FixedRule{})});
  m.regions = {region({})};
  Mesh const mesh = wing();
  Motion const left = without_regions(NamedBoundary(mesh), m);
  ASSERT_EQ(left.rules.size(), 1U);
  EXPECT_EQ(left.rules[0].patches, std::vector<std::string>{"w*"});
  EXPECT_TRUE(left.regions.empty());
}

TEST(WakeRegion, WallsThatAreNotThereAreNamedWithTheRegion) {
  InnerRegion wake = region({});
  wake.wake->of = {"blade"};
  wake.where = "case.toml:9";
  expect_all_in(message_of<MotionError>([&] { holds(wake, {}); }), {"region 'wake' (case.toml:9)", "'blade'"});
}

}  // namespace
}  // namespace gridmorph::test
