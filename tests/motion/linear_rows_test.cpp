// Linear cascades: rows whose periodic sides are a translation apart. The oracle is the same cascade bent into an
// annulus, whose motion comes nearer with its radius.
#include "support/cascade.hpp"
#include "support/expect_error.hpp"

#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/motion/boundary_motion.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace gridmorph::test {
namespace {

enum RuleNumber { blade, ends, sides, walls };

SectionsRule redesign() {
  SectionsRule rule;
  rule.stagger_rad = {{{0, 0.05}, {1, -0.1}}};
  rule.lean = {{{0, 0}, {0.5, 0.03}, {1, 0.01}}};
  rule.chord = {{{0, 0.05}, {1, -0.05}}};
  return rule;
}

Motion rules(SectionsRule const& rule, SlipRule::Surface surface) {
  Motion motion;
  motion.rules = {{{"blade"}, rule, 0, "blade"},
                  {{"inlet", "outlet"}, CircumferentialSlideRule{{"blade"}}, 0, "ends"},
                  {{"type:periodic"}, FollowRule{{"blade"}}, 0, "sides"},
                  {{"hub", "case"}, SlipRule{.surface = surface}, 0, "walls"}};
  return motion;
}

/// Displacements by all rules but that of the walls: of the ends at inlet and outlet, others at all nodes of the mesh.
std::vector<std::array<Vec3, 3>> everywhere(Mesh const& mesh, SectionsRule const& rule, SlipRule::Surface surface) {
  BoundaryMotion const motion(mesh, resolve(mesh, rules(rule, surface)));
  std::vector<std::array<Vec3, 3>> out(mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    for (int const r : {blade, ends, sides}) {
      Vec3 const p = mesh.coordinates[n];
      Index const i = n % mesh.zones.front().extent[0];
      if (r == ends && i != 0 && i != mesh.zones.front().extent[0] - 1) continue;
      motion.displacement(r, {&p, 1}, {&out[n][r], 1});
    }
  return out;
}

double apart(double radius) {
  auto const linear = everywhere(cascade(), redesign(), SlipRule::Surface::plane);
  Mesh const bent = cascade(radius);
  auto const annular = everywhere(bent, redesign(), SlipRule::Surface::revolution);
  double worst = 0;
  for (Index n = 0; n < bent.n_nodes(); ++n) {
    Vec3 const p = bent.coordinates[n];
    double const r = std::hypot(p.y, p.z), c = p.y / r, s = p.z / r;
    for (int const k : {blade, ends, sides}) {
      Vec3 const u = annular[n][k];
      worst = std::max(worst, distance(linear[n][k], {u.x, c * u.y + s * u.z, c * u.z - s * u.y}));
    }
  }
  return worst;
}

TEST(LinearRows, AreAnnuliOfLargeRadius) {
  double const near = apart(100), far = apart(1000);
  EXPECT_LT(near, 1e-3);
  EXPECT_LT(far, 0.15 * near);
}

TEST(LinearRows, AShiftAlongThePitchShiftsAllOfTheRow) {
  SectionsRule rule;
  rule.lean = {{{0, 0.125}, {1, 0.125}}};
  for (auto const& node : everywhere(cascade(), rule, SlipRule::Surface::plane))
    for (int const r : {blade, sides}) EXPECT_LT(distance(node[r], {0, 0, 0.125}), 1e-15);
}

TEST(LinearRows, ABladeThatDoesNotMoveMovesNothing) {
  for (auto const& node : everywhere(cascade(), {}, SlipRule::Surface::plane))
    for (Vec3 const& u : node) EXPECT_EQ(u, Vec3{});
}

TEST(LinearRows, CopiesAPitchApartMoveAlike) {
  Mesh const mesh = cascade();
  auto const u = everywhere(mesh, redesign(), SlipRule::Surface::plane);
  Boundary const boundary(mesh);
  int compared = 0;
  for (AnyConnection const& c : connections_of(mesh))
    for (auto const& [own, donor] : boundary.pairs(c.number)) {
      EXPECT_LT(distance(u[own][sides], u[donor][sides]), 1e-15);
      ++compared;
    }
  EXPECT_GT(compared, 100);
}

// Where the sides end in the blade's edges, its own rule and the sides' agree.
TEST(LinearRows, SidesFollowTheEdgesOfTheBlade) {
  Mesh const mesh = cascade();
  auto const u = everywhere(mesh, redesign(), SlipRule::Surface::plane);
  Zone const& zone = mesh.zones.front();
  for (int const i : {10, 24})
    for (int j = 0; j < zone.extent[1]; ++j)
      for (int const k : {0, zone.extent[2] - 1}) {
        auto const& node = u[zone.node({i, j, k})];
        EXPECT_LT(distance(node[blade], node[sides]), 1e-14);
      }
}

TEST(LinearRows, ThePitchMustLieAcrossTheAxis) {
  Mesh const mesh = cascade();
  Motion motion = rules(redesign(), SlipRule::Surface::plane);
  motion.axis.direction = {1, 0, 1};
  expect_all_in(message_of<MotionError>([&] { BoundaryMotion(mesh, resolve(mesh, motion)); }),
                {"linear cascade", "axis along the flow"});
}

}  // namespace
}  // namespace gridmorph::test
