// Bulbs: their shape along contour and span, and what they make of a blade.
#include "annulus.hpp"
#include "support/expect_error.hpp"
#include "support/motions.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/motion/boundary_motion.hpp>
#include <gridmorph/motion/inflation_heights.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace gridmorph::test {
namespace {

using namespace gridmorph::test;

SpanwiseTable same(double value) { return {{{0, value}}}; }

Bulb bulb_of(double height, double extent) {
  Bulb out;
  out.height = same(height);
  out.extent = same(extent);
  return out;
}

/// A place at a distance from the leading edge along a straight contour of chord 2.
SurfacePlace place(double chords, double side, double span) {
  SurfacePlace out;
  out.chord = 2;
  out.span_fraction = span;
  out.side = side;
  out.from_leading_edge = 2 * chords;
  out.from_trailing_edge = 2 * (1 - chords);
  return out;
}

TEST(Bulbs, HaveTheirHeightInTheMiddleAndNoneBeyondTheirRim) {
  for (auto const shape : {Bulb::Shape::cosine, Bulb::Shape::parabola, Bulb::Shape::bump}) {
    Bulb bulb = bulb_of(0.3, 0.2);
    bulb.shape = shape;
    bulb.position = same(-0.4);
    bulb.span = 0.5;
    bulb.span_extent = 0.25;
    EXPECT_NEAR(bulb.at(place(0.4, -1, 0.5)), 0.3, 1e-15);
    EXPECT_EQ(bulb.at(place(0.4, 1, 0.5)), 0);
    EXPECT_EQ(bulb.at(place(0.61, -1, 0.5)), 0);
    EXPECT_EQ(bulb.at(place(0.4, -1, 0.76)), 0);
    // The same height all around an ellipse.
    double const half = bulb.at(place(0.5, -1, 0.5));
    EXPECT_NEAR(bulb.at(place(0.4, -1, 0.625)), half, 1e-14);
    EXPECT_NEAR(half,
                0.3 * (shape == Bulb::Shape::cosine     ? 0.5
                       : shape == Bulb::Shape::parabola ? 0.75
                                                        : std::exp(1 - 4 / 3.)),
                1e-14);
  }
}

TEST(Bulbs, WithoutASpanAreRidgesThatFollowTheirTables) {
  Bulb bulb = bulb_of(0, 0.1);
  bulb.height = {{{0, 1}, {1, 3}}, SpanwiseTable::Interpolation::linear};
  bulb.edge = Bulb::Edge::trailing;
  for (double const span : {0.0, 0.3, 1.0}) {
    EXPECT_NEAR(bulb.at(place(1, 1, span)), 1 + 2 * span, 1e-14);
    EXPECT_EQ(bulb.at(place(0.89, 1, span)), 0);
  }
}

TEST(Bulbs, ThatReachAroundTheOtherEdgeOrHaveNoExtentAreRefused) {
  auto const refused = [](Bulb const& bulb) { return message_of<MotionError>([&] { (void)make_bulbs({bulb}, {}); }); };
  Bulb bulb = bulb_of(1, 0.5);
  bulb.position = same(0.6);
  expect_all_in(refused(bulb), {"bulb 1", "1.1 chords", "other edge"});
  expect_all_in(refused(bulb_of(1, 0)), {"bulb 1", "must be positive"});
  expect_all_in(refused(bulb_of(std::nan(""), 0.1)), {"not finite"});
  bulb = bulb_of(1, 0.1);
  bulb.span = 0.5;
  expect_all_in(refused(bulb), {"along the span", "must be positive"});
}

/// Largest displacement of the nodes of the blade, and where; all of it along the normals.
TEST(Bulbs, OnALeadingEdgeAtTheHubRaiseWhatIsThereAndNothingElse) {
  RowMesh row;
  row.add(o_blade(241, 61));
  row.add(end_wall("hub", 0, 401, 5));
  row.add(end_wall("case", 1, 401, 5));
  Mesh const mesh = row.finish();
  Bulb bulb = bulb_of(0.02, 0.25);
  bulb.span = 0;
  bulb.span_extent = 0.4;
  Motion m = motion({rule({"blade"}, make_bulbs({bulb}, {})),
                     rule({"hub", "case"}, SlipRule{.surface = SlipRule::Surface::revolution})});
  m.axis = {{0, 0, 0}, {1, 0, 0}};
  BoundaryMotion const moves(mesh, resolve(mesh, m));
  double most = 0, at_edge = 0;
  int still = 0;
  for (Index const n : moves.boundary().surface(0).nodes) {
    Vec3 const at = mesh.coordinates[n];
    Vec3 u;
    moves.displacement(0, {&at, 1}, {&u, 1});
    double const h = span_of(at.x, radius_of(at)), c = (at.x - leading(h)) / chord(h);
    most = std::max(most, norm(u));
    if (h < 1e-9 && c < 1e-9) at_edge = norm(u);
    if (h > 0.4 || c > 0.3) {
      EXPECT_EQ(u, Vec3{}) << h << ' ' << c;
      ++still;
    }
  }
  EXPECT_GT(still, 100);
  EXPECT_NEAR(at_edge, 0.02, 0.003);  // along the hub, whose slope is 6 degrees
  EXPECT_LE(most, 0.021);
}

TEST(Bulbs, ThickerThanTheChordAreRefusedWithTheShareThatWouldDo) {
  RowMesh row;
  row.add(o_blade(81, 21));
  Mesh const mesh = row.finish();
  Motion m = motion({rule({"blade"}, make_bulbs({bulb_of(5, 0.3)}, {}))});
  m.axis = {{0, 0, 0}, {1, 0, 0}};
  std::string const message = message_of<MotionError>([&] { BoundaryMotion(mesh, resolve(mesh, m)); });
  expect_all_in(message, {"more than the chord", "of the height would do"});
}

}  // namespace
}  // namespace gridmorph::test
