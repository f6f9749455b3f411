// Bodies that turn as a whole: the rotation that their walls make, how it fades, and what large turns leave of meshes.
#include "kernels/tables.hpp"
#include "support/made_bodies.hpp"
#include "support/random.hpp"
#include "support/reduced.hpp"
#include "support/unstructured_case.hpp"

#include <generators/airfoil.hpp>
#include <generators/sphere.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/geometry/rotation.hpp>
#include <gridmorph/kernels/body_turn.hpp>
#include <gridmorph/kernels/box_tree.hpp>
#include <gridmorph/mesh/file_order.hpp>
#include <gridmorph/plan/elements/facet_distance.hpp>
#include <gridmorph/plan/elements/turning_bodies.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>

namespace gridmorph::test {
namespace {

using Case = UnstructuredCase;
constexpr double degrees = std::numbers::pi / 180;

// ---- the rotation of a cloud of points
// -----------------------------------------------------------------------------------

struct Cloud {
  std::vector<Vec3> arms;

  explicit Cloud(unsigned seed, bool flat = false) {
    Random random(seed);
    Vec3 mean;
    for (int k = 0; k < 40; ++k) {
      arms.push_back(random.vector(1));
      if (flat) arms.back().z = 0;
      mean += (1.0 / 40) * arms.back();
    }
    for (Vec3& a : arms) a = a - mean;
  }
  template <class After>
  [[nodiscard]] kernels::VectorMoments moments(After const& after) const {
    kernels::VectorMoments s;
    for (Vec3 const& a : arms) s.add(a, after(a));
    return s;
  }
};

TEST(BestTurn, IsTheRotationThatWasMade) {
  for (bool const flat : {false, true})
    for (double const angle : {1e-9, 0.3, 2.0, 3.1}) {
      Vec3 const axis = flat ? Vec3{0, 0, 1} : (1 / std::sqrt(14.0)) * Vec3{1, -2, 3};
      Mat3 const r = rotation_by(angle * axis);
      auto const s = Cloud(5, flat).moments([&](Vec3 const& a) { return r * a + Vec3{7, 8, 9}; });
      Vec3 const expected = std::tan(angle / 4) * axis;
      EXPECT_LT(norm(kernels::best_turn<Vec3>(s, {}, {}) - expected), 1e-13) << angle;
      EXPECT_LT(norm(kernels::best_turn<Vec3>(s, {}, axis) - expected), 1e-13) << angle;
    }
}

TEST(BestTurn, OfPointsThatStayOrHaveNoShapeIsExactlyNothing) {
  Cloud const cloud(3);
  EXPECT_EQ(norm(kernels::best_turn<Vec3>(cloud.moments([](Vec3 const& a) { return a; }), {}, {})), 0);
  EXPECT_EQ(norm(kernels::best_turn<Vec3>(cloud.moments([](Vec3 const& a) { return a; }), {}, {0, 0, 1})), 0);
  EXPECT_EQ(norm(kernels::best_turn<Vec3>({}, {}, {})), 0);
}

TEST(BestTurn, HasTheRateOfItsDifferences) {
  Cloud const cloud(11);
  auto const after = [&](double t) {
    return cloud.moments([&](Vec3 const& a) {
      Vec3 const turned = rotation_by(Vec3{0.4 + t, 1.1 - 0.5 * t, 0.3 * t}) * a;
      return turned + Vec3{0.3 * a.y * a.y, t * a.x * a.z, 0.2 * a.x};
    });
  };
  double const h = 1e-6;
  auto const before = after(0.7 - h), later = after(0.7 + h);
  kernels::VectorMoments rate;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) rate.m[i][j] = (later.m[i][j] - before.m[i][j]) / (2 * h);
  for (Vec3 const& axis : {Vec3{}, Vec3{0, 0, 1}}) {
    Vec3 const expected =
        (0.5 / h) * (kernels::best_turn<Vec3>(later, {}, axis) - kernels::best_turn<Vec3>(before, {}, axis));
    auto const found = kernels::best_turn<kernels::DualVec3>(after(0.7), rate, axis);
    EXPECT_LT(norm(found.rate - expected), 1e-8);
    EXPECT_LT(norm(found.value - kernels::best_turn<Vec3>(after(0.7), {}, axis)), 1e-14);
    EXPECT_GT(norm(found.rate), 0.1);
  }
}

// ---- how it fades
// --------------------------------------------------------------------------------------------------------

TEST(TurnShare, FallsFromTheBodyToTheOthersAndHasNoJumps) {
  for (double const way : {1e-3, 0.1, 3.0, 400.0})
    for (double const layer : {0.0, 0.02}) {
      double last = 1;
      constexpr int n = 2000;
      for (int k = 0; k <= n; ++k) {
        double const d = way * k / n;
        double const f = turn_share({d, way - d, layer, 0, 1});
        if (d <= std::min(layer, way / 3) || k == 0) {
          EXPECT_EQ(f, 1);
        }
        EXPECT_LE(f, last);
        EXPECT_LT(last - f, way < 100 ? 0.01 : 0.2);
        last = f;
      }
      EXPECT_EQ(last, 0);
    }
  EXPECT_EQ(turn_share({5, HUGE_VAL, 0, 0, 1}), 1) << "nothing else is there";
  // The two forms meet.
  EXPECT_NEAR(turn_share({1.9e-5, 1.99e-5, 0, 0, 1}), turn_share({1.9e-5, 2.11e-5, 0, 0, 1}), 0.06);
}

TEST(TurnShare, SpreadsTheShearEvenlyAroundARoundBody) {
  // r da/dr of a turn by one radian; evenly would be 1 / log(outer / inner radius) everywhere.
  double const outer = 20, even = 1 / std::log(outer), h = 1e-4;
  double largest = 0;
  for (double r = 1 + h; r < outer - h; r += 0.01) {
    auto const share = [&](double at) { return turn_share({at - 1, outer - at, 0, 0, 1}); };
    largest = std::max(largest, r * (share(r - h) - share(r + h)) / (2 * h));
  }
  EXPECT_LT(largest, 1.7 * even);
}

TEST(TurnShare, OfTwoBodiesIsLessBetweenThem) {
  std::array far{0.5, 0.0}, between{0.5, 0.5}, at_one{1.0, 0.0};
  for (auto* shares : {&far, &between, &at_one}) share_between(*shares);
  EXPECT_EQ(far, (std::array{0.5, 0.0}));
  EXPECT_EQ(at_one, (std::array{1.0, 0.0}));
  EXPECT_DOUBLE_EQ(between[0], 0.4);
  EXPECT_DOUBLE_EQ(between[1], 0.4);
}

TEST(TurnShare, InSightIsOneAtTheBodyAndNoneAtOthers) {
  EXPECT_EQ(turn_share_in_sight(HUGE_VAL, 3), 1);
  EXPECT_EQ(turn_share_in_sight(3, HUGE_VAL), 0);
  EXPECT_EQ(turn_share_in_sight(0, 1), 0);
  EXPECT_DOUBLE_EQ(turn_share_in_sight(2, 2), 0.5);
  for (double q = 0.01; q < 1; q += 0.01)
    EXPECT_GT(turn_share_in_sight(q, 1 - q), turn_share_in_sight(q - 0.01, 1.01 - q)) << q;
  EXPECT_EQ(narrowness(2, 1), 1);
  EXPECT_EQ(narrowness(6, 1), 0);
  EXPECT_EQ(narrowness(HUGE_VAL, 1), 0);
  EXPECT_EQ(compactness(2 * std::numbers::pi, 1), 1) << "a circle";
  EXPECT_EQ(compactness(8 * std::sqrt(0.5), 1), 1) << "a square";
  EXPECT_EQ(compactness(4.2, 1), 0) << "a blade";
}

/// Two lines of width 2 w at heights 0 and 1; the closeness of the lower one at a place between them is known.
struct Lines {
  static constexpr double w = 5;
  static constexpr int n = 60;
  Coordinates x{2 * (n + 1)};
  std::vector<CsrGraph> edges{2};
  std::vector<std::vector<SeenPiece>> walls{2};

  Lines() {
    for (int line = 0; line < 2; ++line)
      for (int i = 0; i <= n; ++i) {
        Index32 const at = i + (n + 1) * line;
        x.set(at, {w * (2.0 * i / n - 1), double(line), 0});
        if (i < n) edges[line].add(std::array{at, at + 1});
        if (i > 0) walls[line].push_back({0.5 * (x[at - 1] + x[at]), distance(x[at - 1], x[at])});
      }
  }
  /// C d / pi at height h over u.
  static double exact(double u, double h) {
    return (std::atan((w - u) / h) + std::atan((w + u) / h)) / std::numbers::pi;
  }
};

TEST(Surroundings, AreAnglesOfLines) {
  Lines const lines;
  std::vector<FacetDistance> from;
  for (CsrGraph const& edges : lines.edges) from.emplace_back(lines.x, edges);
  Surroundings const around({}, {{0, 0.5, 0}}, lines.walls, from, 1);
  std::array<double, 2> seen{}, beside{};
  for (double const u : {0.0, 0.7, -1.9})
    for (double h = 0.05; h < 1; h += 0.05) {
      seen = beside = {};
      around.add({u, h, 0}, 1, seen);
      // Beside a line, closer than its sources are to one another, it is as blurred as they are.
      auto const blur = [](double height) { return height < 0.3 ? 0.2 : 0.1; };
      EXPECT_NEAR(seen[0], Lines::exact(u, h), blur(h)) << u << ' ' << h;
      EXPECT_NEAR(seen[1], Lines::exact(u, 1 - h), blur(1 - h)) << u << ' ' << h;
      around.add({u + 1e-9, h + 1e-9, 0}, 1, beside);
      EXPECT_NEAR(seen[0], beside[0], 1e-7) << "no jumps";
    }
}

TEST(ShiftShare, FallsFromTheBodyToTheOthersAlmostEvenly) {
  double const way = 40, size = 1, infinite = HUGE_VAL;
  double moved = 0;
  double share = 0, last = 1;
  auto const at = [&](double d, double others) {
    shift_shares({&d, 1}, {&size, 1}, {&moved, 1}, others, {&share, 1});
    return share;
  };
  EXPECT_EQ(at(3, infinite), 1) << "nothing else is there";
  constexpr int n = 400;
  for (int k = 0; k <= n; ++k) {
    double const d = way * k / n, s = at(d, way - d);
    EXPECT_LE(s, last);
    EXPECT_LT(last - s, 1.4 / n);
    last = s;
  }
  EXPECT_EQ(at(0, way), 1);
  EXPECT_EQ(last, 0);
  // A body that shifts by nine tenths of the way leaves a tenth of what was there, at the worst place.
  moved = 0.9 * way;
  last = at(0, way);
  for (int k = 1; k <= n; ++k) {
    double const s = at(way * k / n, way - way * k / n);
    EXPECT_LT(moved * (last - s), way / n);
    last = s;
  }
}

TEST(ShiftShare, OfSeveralBodiesAddUpToOneAtMost) {
  Random random(23);
  std::array const sizes{1.0, 0.3, 2.0}, moved{0.0, 0.5, 3.0};
  for (int k = 0; k < 200; ++k) {
    std::array<double, 3> from{}, shares{};
    for (double& d : from) d = std::abs(random.vector(9).x);
    double const others = std::abs(random.vector(9).x);
    shift_shares(from, sizes, moved, others, shares);
    EXPECT_LE(shares[0] + shares[1] + shares[2], 1 + 1e-12);
    for (double const s : shares) EXPECT_GE(s, 0);
    // At a body none of the others'.
    from[1] = 0;
    shift_shares(from, sizes, moved, others, shares);
    EXPECT_EQ(shares, (std::array{0.0, 1.0, 0.0}));
  }
}

TEST(FacetDistance, IsThatOfTheNearestFaceHoweverTheyAreListed) {
  Mesh const mesh = box_around({6, 5, 4}, [](Vec3 const& p) { return norm(p - Vec3{3, 2.5, 2}) < 1.2; });
  CsrGraph faces, backwards;
  for (auto const& patch : mesh.patches)
    if (patch.name == "body")
      for (Index f = 0; f < patch.faces.size(); ++f) faces.add(patch.faces[f]);
  for (Index f = faces.size(); f-- > 0;) {
    std::vector<Index32> face(faces[f].begin(), faces[f].end());
    std::rotate(face.begin(), face.begin() + 1, face.end());
    backwards.add(face);
  }
  FacetDistance const a(mesh.coordinates, faces), b(mesh.coordinates, backwards);
  Random random(7);
  int start_a = 0, start_b = 0;
  for (int k = 0; k < 300; ++k) {
    Vec3 const p = random.vector(6);
    double nearest = HUGE_VAL;
    // Flat axis-parallel squares: the distance of a box without thickness.
    for (Index f = 0; f < faces.size(); ++f) {
      Box box;
      for (Index32 const n : faces[f]) box.include(mesh.coordinates[n]);
      auto const off = [](double low, double high, double x) { return std::max({low - x, x - high, 0.0}); };
      nearest = std::min(nearest, norm(Vec3{off(box.low.x, box.high.x, p.x), off(box.low.y, box.high.y, p.y),
                                            off(box.low.z, box.high.z, p.z)}));
    }
    EXPECT_NEAR(a(p, start_a), nearest, 1e-13);
    EXPECT_NEAR(b(p, start_b), nearest, 1e-13);
  }
}

// ---- morphs
// --------------------------------------------------------------------------------------------------------------

Case c_mesh(int fineness = 1) {
  AirfoilOptions options;
  options.around = 96 * fineness;
  options.wake = 24 * fineness;
  options.across = 32 * fineness;
  options.first_cell = 1e-3;
  return Case(make_airfoil(options));
}
Motion pitch(double angle, Vec3 const& shift = {}) {
  return motion_of({rule_for({"airfoil"}, rotation({0.25, 0.1, 0}, {0, 0, 1}, angle, shift))});
}
/// Largest distance of walls and of the columns on them from where a rigid motion puts them.
double largest_from(Case const& c, UnstructuredMorphed const& m, RigidTransform const& motion) {
  double largest = 0;
  auto const& plan = m.prepared.plan;
  for (auto const* nodes : {&plan.driving, &plan.columns.node})
    for (Index32 const n : *nodes) largest = std::max(largest, distance(m.x[n], motion(c.mesh.coordinates[n])));
  return largest;
}

TEST(TurningBody, AnAirfoilTurnsByHalfATurnInOneStep) {
  auto const c = c_mesh(reduced() ? 1 : 2);
  for (double const angle : {-60.0, 60.0, 120.0, 180.0}) {
    auto const m = c.morph(pitch(angle * degrees));
    ASSERT_EQ(m.prepared.plan.turns_of_bodies.size(), 1);
    EXPECT_EQ(c.inverted(m.x), 0) << angle;
    EXPECT_EQ(c.largest_miss(m), 0);
    EXPECT_GT(m.prepared.plan.columns.node.size(), reduced() ? 400u : 500u);
    EXPECT_LT(largest_from(c, m, rotation_about({0.25, 0.1, 0}, {0, 0, 1}, angle * degrees)), 1e-10);
    if (std::abs(angle) <= 60) {
      EXPECT_GT(c.quality(m.x)[Measure::minimum_angle_deg].min, 60);
    }
  }
}

TEST(TurningBody, ASphereTurnsInAnOuterOneFourDiametersAway) {
  SphereOptions options;
  options.elements = 40'000;
  Case const c(make_sphere(options));
  for (double const angle : {90.0, 180.0}) {
    auto const m = c.guarded_morph(motion_of(
        {rule_for({"sphere"}, rotation({0, 0, 0}, {1, 2, 3}, angle * degrees)), rule_for({"outer"}, FixedRule{})}));
    EXPECT_EQ(c.inverted(m.x), 0) << angle;
    EXPECT_LT(largest_from(c, m, rotation_about({0, 0, 0}, {1, 2, 3}, angle * degrees)), 1e-10);
    if (reduced()) break;
  }
}

/// Two blocks in a box, or one.
Mesh blocks(bool two) {
  return box_around({28, 16, 12}, [&](Vec3 const& p) {
    bool const inside = p.y > 6 && p.y < 10 && p.z > 4 && p.z < 8;
    return inside && ((p.x > 6 && p.x < 10) || (two && p.x > 18 && p.x < 22));
  });
}

TEST(TurningBody, ASphereShiftsByMostOfTheWayToAnOuterOneTwentyDiametersAway) {
  SphereOptions options;
  options.elements = reduced() ? 12'000 : 40'000;
  options.distance = 20;
  Case const c(make_sphere(options));
  double const before = c.quality(c.mesh.coordinates)[Measure::minimum_angle_deg].min;
  for (double const diameters : {4.0, 16.0}) {
    Vec3 const shift = (diameters * 2 * options.radius / std::sqrt(14.0)) * Vec3{1, 2, 3};
    auto const m =
        c.morph(motion_of({rule_for({"sphere"}, rotation({}, {0, 0, 1}, 0, shift)), rule_for({"outer"}, FixedRule{})}));
    EXPECT_EQ(c.inverted(m.x), 0) << diameters;
    EXPECT_EQ(c.largest_miss(m), 0);
    EXPECT_LT(largest_from(c, m, {Mat3{}, shift}), 1e-10);
    if (diameters < 5) {
      EXPECT_GT(c.quality(m.x)[Measure::minimum_angle_deg].min, 0.6 * before);
    }
  }
}

TEST(TurningBody, ItsImageTurnsInTheFrameOfTheImage) {
  Random random(8);
  Vec3 const centre = random.vector(2), axis = random.vector(1), at = random.vector(3);
  RigidTransform const move = rotation_about(random.vector(1), random.vector(1), 0.7);
  double const angle = 0.9, f = 0.4;
  std::vector<kernels::BodyImage> const images{{{{}, {}}, 0}, {{move.rotation, move.translation}, 0}};
  std::vector<double> const share{0, f}, shift_share{0};
  std::vector<Vec3> const centres{centre}, shift{{}};
  kernels::Quaternion<Vec3> const half = kernels::quaternion_of_half(std::tan(angle / 4) / norm(axis) * axis);
  Coordinates x(1);
  x.set(0, at);
  kernels::BodyTurnField<Kokkos::HostSpace, Vec3> const field{view(share),
                                                              view(shift_share),
                                                              view(images),
                                                              view(centres),
                                                              &half,
                                                              nullptr,
                                                              shift.data(),
                                                              nullptr,
                                                              {x.x.data(), x.y.data(), x.z.data()}};
  // Around the image's centre, about the image's axis; the share is exact at 0 and 1 and to 2 degrees between.
  auto const turned = rotation_about(move(centre), move.rotation * axis, f * angle);
  EXPECT_LT(distance(at + field(0), turned(at)), 0.03 * distance(at, move(centre)));
  EXPECT_NEAR(distance(at + field(0), move(centre)), distance(at, move(centre)), 1e-13) << "nothing shrinks";
  EXPECT_NEAR(dot(field(0), move.rotation * axis), 0, 1e-13);
}

TEST(TurningBody, LeavesAShiftThatAllBoundariesShareToTheRest) {
  Case const c(blocks(true));
  Vec3 const shift{3, -2, 1};
  auto const m = c.morph(motion_of({rule_for({"*"}, rotation({}, {0, 0, 1}, 0, shift))}));
  EXPECT_EQ(m.prepared.plan.turns_of_bodies.size(), 2);
  for (Index n = 0; n < m.x.size(); ++n) EXPECT_LT(distance(m.x[n], c.mesh.coordinates[n] + shift), 1e-12) << n;
}

TEST(TurningBody, TwoThatTurnDifferentlyEachHaveTheirs) {
  Case const c(blocks(true));
  Vec3 const first{8, 8, 6}, second{20, 8, 6};
  auto const left = rotation_about(first, {0, 0, 1}, 25 * degrees),
             right = rotation_about(second, {1, 0, 0}, -30 * degrees);
  FunctionRule const turns{"turns", [&](std::span<Vec3 const> x, std::span<Vec3> u) {
                             for (std::size_t n = 0; n < x.size(); ++n)
                               u[n] = (x[n].x < 14 ? left(x[n]) : right(x[n])) - x[n];
                           }};
  PlanOptions options;
  options.boundary_layers.push_back({.walls = {"body"}, .extent = BoundaryLayer::Extent::layers, .layers = 1});
  auto const m = c.morph(motion_of({rule_for({"body"}, turns)}), options);
  ASSERT_EQ(m.prepared.plan.turns_of_bodies.size(), 2);
  EXPECT_EQ(c.inverted(m.x), 0);
  EXPECT_EQ(c.largest_miss(m), 0);
  ASSERT_GT(m.prepared.plan.columns.node.size(), 100u);
  for (Index32 const n : m.prepared.plan.columns.node) {
    Vec3 const x = c.mesh.coordinates[n];
    EXPECT_LT(distance(m.x[n], (x.x < 14 ? left : right)(x)), 1e-10);
  }
}

TEST(TurningBody, BesideAWallThatStands) {
  // As far from it as half the body is wide.
  Case const c(box_around({20, 16, 12}, [](Vec3 const& p) {
    return std::abs(p.x - 4) < 2 && std::abs(p.y - 8) < 2 && std::abs(p.z - 6) < 2;
  }));
  for (double const angle : {15.0, 30.0}) {
    auto const m = c.morph(motion_of({rule_for({"body"}, rotation({4, 8, 6}, {1, 0, 0}, angle * degrees)),
                                      rule_for({"i_min"}, FixedRule{}), rule_for({"i_max"}, FreeRule{})}));
    EXPECT_EQ(m.prepared.plan.turns_of_bodies.size(), 1);
    EXPECT_EQ(c.inverted(m.x), 0) << angle;
    EXPECT_EQ(c.largest_miss(m), 0);
  }
}

TEST(TurningBody, SlidesAboutTheNormalOfAPlaneThatItStandsOn) {
  Case const c(
      box_around({16, 16, 8}, [](Vec3 const& p) { return std::abs(p.x - 8) < 3 && std::abs(p.y - 8) < 1 && p.z < 4; }));
  auto const turned = [&](Vec3 const& axis) {
    return c.morph(motion_of({rule_for({"body"}, rotation({8, 8, 0}, axis, 45 * degrees)),
                              rule_for({"k_min"}, SlipRule{}), rule_for({"k_max"}, FixedRule{})}));
  };
  auto const m = turned({0, 0, 1});
  auto const& bodies = m.prepared.plan.turns_of_bodies;
  ASSERT_EQ(bodies.size(), 1);
  EXPECT_NEAR(std::abs(bodies.axis[0].z), 1, 1e-14);
  EXPECT_EQ(c.inverted(m.x), 0);
  double slid = 0;
  for (Index32 const n : c.nodes_of("k_min")) {
    EXPECT_NEAR(m.x[n].z, 0, 1e-13);
    if (distance(c.mesh.coordinates[n], {8, 8, 0}) < 5) slid = std::max(slid, distance(m.x[n], c.mesh.coordinates[n]));
  }
  EXPECT_GT(slid, 1.5) << "its nodes go round with the body";
}

TEST(TurningBody, WhatEndsOnBoundariesThatStandDoesNotTurnAsAWhole) {
  Case const c(
      box_around({12, 12, 8}, [](Vec3 const& p) { return std::abs(p.x - 6) < 2 && std::abs(p.y - 6) < 2 && p.z < 4; }));
  FunctionRule const twist{"twists", [](std::span<Vec3 const> x, std::span<Vec3> u) {
                             for (std::size_t n = 0; n < x.size(); ++n)
                               u[n] = rotation_about({6, 6, 0}, {0, 0, 1}, 0.1 * x[n].z)(x[n]) - x[n];
                           }};
  auto const m = c.morph(motion_of({rule_for({"body"}, twist), rule_for({"k_min"}, FixedRule{})}));
  EXPECT_EQ(m.prepared.plan.turns_of_bodies.size(), 0);
}

TEST(TurningBody, ThatIsNotDisplacedLeavesEveryBit) {
  auto const c = c_mesh();
  auto const planned = c.morph(pitch(2));
  Coordinates x(c.mesh.n_nodes());
  std::vector<Vec3> const rest(planned.boundary.size());
  apply_on_host(MorpherAccess::of(Case::Host(), planned.prepared.plan, c.mesh.coordinates), rest, x);
  for (Index n = 0; n < x.size(); ++n) EXPECT_EQ(x[n], c.mesh.coordinates[n]) << n;
}

TEST(TurningBody, ThatBendsTooKeepsItsColumnsUprightAndItsElements) {
  auto const c = c_mesh();
  // A quarter turn of a section whose rear half is bent by 11 degrees.
  auto const turn = rotation_about({0.5, 0, 0}, {0, 0, 1}, 90 * degrees);
  FunctionRule const rule{"bends", [&](std::span<Vec3 const> x, std::span<Vec3> u) {
                            for (std::size_t n = 0; n < x.size(); ++n) {
                              double const s = std::max(0.0, x[n].x - 0.5);
                              u[n] = turn(x[n] + Vec3{0, 0.2 * s * s, 0}) - x[n];
                            }
                          }};
  auto const m = c.morph(motion_of({rule_for({"airfoil"}, rule)}));
  EXPECT_EQ(c.inverted(m.x), 0);
  EXPECT_EQ(c.largest_miss(m), 0);
  auto const& plan = m.prepared.plan;
  for (std::size_t k = 0; k < plan.columns.node.size(); ++k) {
    Index32 const n = plan.columns.node[k], w = plan.driving[plan.columns.root[k]];
    EXPECT_NEAR(distance(m.x[n], m.x[w]), distance(c.mesh.coordinates[n], c.mesh.coordinates[w]), 1e-12);
  }
  EXPECT_GT(c.quality(m.x)[Measure::minimum_angle_deg].min, 40);
}

TEST(TurningBody, GivesTheSameBitsWithAnyThreads) {
  auto const c = c_mesh();
  auto const with = [&](auto const& exec) { return positions_on(exec, c, pitch(1.7, {0.3, 0.1, 0}), {}); };
  Coordinates const serial = with(Kokkos::Serial()), host = with(Case::Host());
  for (Index n = 0; n < serial.size(); ++n) ASSERT_EQ(serial[n], host[n]) << n;
}

TEST(TurningBody, DoesNotDependOnNumbers) {
  auto const c = c_mesh();
  auto const motion = pitch(2.5, {3, -2, 0});
  Mesh mesh = c.mesh;
  Random random(17);
  FileOrder order;
  order.node.resize(mesh.n_nodes());
  order.element.resize(mesh.n_elements());
  std::iota(order.node.begin(), order.node.end(), 0);
  std::iota(order.element.begin(), order.element.end(), 0);
  random.shuffle(order.node);
  random.shuffle(order.element);
  auto const place = order.node;
  reorder(mesh, std::move(order));
  Case const other(mesh);
  auto const a = c.morph(motion), b = other.morph(motion);
  double largest = 0;
  for (std::size_t n = 0; n < place.size(); ++n)
    largest = std::max(largest, distance(b.x[Index(n)], a.x[Index(place[n])]));
  EXPECT_LT(largest, 1e-11);
}

// ---- bodies that stretch
// -------------------------------------------------------------------------------------------------------

/// An airfoil of which all places move by a function of them.
Motion by_places(std::string const& patch, std::function<Vec3(Vec3 const&)> const& moves) {
  return motion_of({rule_for({patch}, FunctionRule{"moves", [=](std::span<Vec3 const> x, std::span<Vec3> u) {
                                                     for (std::size_t n = 0; n < x.size(); ++n) u[n] = moves(x[n]);
                                                   }})});
}
double stretch_share(UnstructuredMorphed const& m) {
  auto const& limits = m.prepared.plan.turns_of_bodies.limits;
  return limits.empty() ? 0 : limits.front().share;
}

TEST(StretchedBody, TakesWhatIsAroundItAlongBeyondItsColumns) {
  auto const c = c_mesh();
  // Turned by 20 degrees, half as thick again, a fifth longer.
  auto const turn = rotation_about({0.4, 0, 0}, {0, 0, 1}, 20 * degrees);
  auto const whole = [&](Vec3 const& x) { return turn(Vec3{0.4 + 1.2 * (x.x - 0.4), 1.5 * x.y, x.z}); };
  auto const m = c.morph(by_places("airfoil", [&](Vec3 const& x) { return whole(x) - x; }), by_lattice());
  EXPECT_EQ(stretch_share(m), 1);
  EXPECT_EQ(c.largest_miss(m), 0);
  EXPECT_EQ(c.inverted(m.x), 0);
  auto const& plan = m.prepared.plan;
  double largest_end = 0, largest_start = 0;
  std::vector<double> longest(c.mesh.n_nodes(), 0);
  for (std::size_t k = 0; k < plan.columns.node.size(); ++k) {
    Index32 const n = plan.columns.node[k], w = plan.driving[plan.columns.root[k]];
    longest[w] = std::max(longest[w], distance(c.mesh.coordinates[n], c.mesh.coordinates[w]));
  }
  for (std::size_t k = 0; k < plan.columns.node.size(); ++k) {
    Index32 const n = plan.columns.node[k], w = plan.driving[plan.columns.root[k]];
    double const before = distance(c.mesh.coordinates[n], c.mesh.coordinates[w]), share = before / longest[w];
    if (share == 1) largest_end = std::max(largest_end, distance(m.x[n], whole(c.mesh.coordinates[n])) / before);
    if (share < 0.05) largest_start = std::max(largest_start, std::abs(distance(m.x[n], m.x[w]) / before - 1));
  }
  EXPECT_LT(largest_end, 1e-10) << "columns end where the stretch of the whole puts them";
  EXPECT_LT(largest_start, 0.02) << "first cells keep their heights";
}

TEST(StretchedBody, ThatIsRigidOrBendsMostlyIsNone) {
  auto const c = c_mesh();
  auto const turn = rotation_about({0.4, 0.3, 0}, {0, 0, 1}, 1.1);
  EXPECT_EQ(stretch_share(c.morph(by_places("airfoil", [&](Vec3 const& x) { return turn(x) - x; }))), 0);
  EXPECT_EQ(stretch_share(c.morph(by_places("airfoil",
                                            [&](Vec3 const& x) {
                                              double const s = (x.x - 0.4) / 0.2;
                                              return Vec3{0, x.y > 0 && std::abs(s) < 1 ? 0.02 * (1 - s * s) : 0, 0};
                                            }))),
            0);
}

/// Its rear half goes up.
Vec3 bent(Vec3 const& x, double size) {
  double const s = std::max(0.0, x.x - 0.5) / 0.5;
  return {0, size * s * s, 0};
}

TEST(TurningBody, HasShortColumnsWhereItBendsAndNotForNoise) {
  auto const c = c_mesh();
  auto const columns = [&](std::function<Vec3(Vec3 const&)> const& moves, PlanOptions const& options = by_lattice()) {
    return prepare(c.mesh, c.topology, c.face_patches, by_places("airfoil", moves), options).plan.columns.node;
  };
  auto const turn = rotation_about({0.4, 0.3, 0}, {0, 0, 1}, 0.4);
  auto const rigid = [&](Vec3 const& x) { return turn(x) - x; };
  auto const single = [&](Vec3 const& x) {
    Vec3 const u = rigid(x);
    return Vec3{double(float(u.x)), double(float(u.y)), 0};
  };
  auto const whole = columns(rigid);
  EXPECT_EQ(columns(single), whole);
  auto const at_once = columns([](Vec3 const& x) { return bent(x, 0.1); });
  EXPECT_LT(at_once.size(), whole.size());
  EXPECT_GT(at_once.size(), 100u);
  // Half as much bends them alike, and so does what is known of displacements to come.
  EXPECT_EQ(columns([](Vec3 const& x) { return bent(x, 0.05); }), at_once);
  auto const known = prepare(c.mesh, c.topology, c.face_patches, by_places("airfoil", rigid), {}).plan.known;
  PlanOptions options = by_lattice();
  options.elements.motion = 0.1;
  for (Index32 const n : known) options.elements.shape.push_back(bent(c.mesh.coordinates[n], 0.02));
  EXPECT_EQ(columns(rigid, options), at_once);
  options.elements.shape.pop_back();
  EXPECT_THROW(columns(rigid, options), PlanError);
}

TEST(StretchedBody, AlongAPlaneKeepsIt) {
  Case const c(
      box_around({16, 16, 8}, [](Vec3 const& p) { return std::abs(p.x - 8) < 3 && std::abs(p.y - 8) < 1 && p.z < 4; }));
  auto const m = c.morph(
      [&] {
        Motion motion = by_places("body", [](Vec3 const& x) { return Vec3{0.3 * (x.x - 8), 0.5 * (x.y - 8), 0}; });
        motion.rules.push_back(rule_for({"k_min"}, SlipRule{}));
        return motion;
      }(),
      by_lattice());
  EXPECT_EQ(stretch_share(m), 1);
  EXPECT_EQ(c.inverted(m.x), 0);
  double slid = 0;
  for (Index32 const n : c.nodes_of("k_min")) {
    EXPECT_NEAR(m.x[n].z, 0, 1e-13);
    slid = std::max(slid, distance(m.x[n], c.mesh.coordinates[n]));
  }
  EXPECT_GT(slid, 0.9);
}

TEST(StretchedBody, ASphereGrowsToTwiceItsSize) {
  SphereOptions options;
  options.elements = 12'000;
  options.distance = 10;
  Case const c(make_sphere(options));
  double const before = c.quality(c.mesh.coordinates)[Measure::minimum_angle_deg].min;
  for (double const more : {-0.5, 1.0}) {
    auto const m = c.morph(by_places("sphere", [&](Vec3 const& x) { return more * x; }));
    EXPECT_EQ(c.inverted(m.x), 0) << more;
    EXPECT_GT(c.quality(m.x)[Measure::minimum_angle_deg].min, 0.5 * before) << more;
  }
}

TEST(StretchedBody, HasTheVelocityOfItsDifferences) {
  auto const c = c_mesh();
  auto const places = [](double t) {
    auto const turn = rotation_about({0.25, 0.1, 0}, {0, 0, 1}, 0.6 + t);
    return [=](Vec3 const& x) {
      return turn(x + Vec3{0.2 * (1 + t) * (x.x - 0.4), (0.5 - t) * x.y, 0} + 0.02 * t * Vec3{0, x.x * x.x, 0}) - x;
    };
  };
  auto const prepared = prepare(c.mesh, c.topology, c.face_patches, by_places("airfoil", places(0)), by_lattice());
  EXPECT_GT(prepared.plan.turns_of_bodies.limits.front().share, 0.9);
  auto const at = [&](double t) {
    std::vector<Vec3> out;
    auto const moves = places(t);
    for (Index32 const n : prepared.plan.known) {
      bool const drives = std::binary_search(prepared.plan.driving.begin(), prepared.plan.driving.end(), n);
      out.push_back(drives ? moves(c.mesh.coordinates[n]) : Vec3{});
    }
    return out;
  };
  auto const [error, largest] = rate_error(c, prepared.plan, at);
  EXPECT_GT(largest, 0.2);
  EXPECT_LT(error, 1e-8 * largest);
}

TEST(TurningBody, HasTheVelocityOfItsDifferences) {
  auto const c = c_mesh();
  auto const prepared = prepare(c.mesh, c.topology, c.face_patches, pitch(1), {});
  auto const at = [&](double t) {
    std::vector<Vec3> out;
    auto const turn = rotation_about({0.25, 0.1, 0}, {0, 0, 1}, 2.6 + t);
    for (Index32 const n : prepared.plan.known) {
      Vec3 const x = c.mesh.coordinates[n];
      bool const moves = std::binary_search(prepared.plan.driving.begin(), prepared.plan.driving.end(), n);
      out.push_back(moves ? turn(x + Vec3{0.1 * t, 0.2 * (1 + t) * x.x * x.x, 0}) - x : Vec3{});
    }
    return out;
  };
  auto const [error, largest] = rate_error(c, prepared.plan, at);
  EXPECT_GT(largest, 0.5);
  EXPECT_LT(error, 1e-8 * largest);
}

}  // namespace
}  // namespace gridmorph::test
