// How walls turn and what stands on them, against matrices of rotation and differences.
#include "kernels/tables.hpp"
#include "support/random.hpp"

#include <gridmorph/geometry/rigid_transform.hpp>
#include <gridmorph/kernels/column_motion.hpp>
#include <gridmorph/kernels/transposed_wall_turn.hpp>
#include <gridmorph/kernels/wall_turn.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace gridmorph::test {
namespace {

using kernels::Dual;
using kernels::DualVec3;
using kernels::Index;

/// exp([turn]x) by its series: knows no sines.
Mat3 matrix_of(Vec3 const& turn) {
  Mat3 const skew{{{0, -turn.z, turn.y}, {turn.z, 0, -turn.x}, {-turn.y, turn.x, 0}}};
  Mat3 sum, term;
  for (int n = 1; n < 40; ++n) {
    term = term * skew;
    for (auto& row : term.m)
      for (double& v : row) v /= n;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) sum.m[i][j] += term.m[i][j];
  }
  return sum;
}

/// What kernels call the rotation about `turn` by its length, and back.
Vec3 rotation(Vec3 const& turn) {
  double const angle = norm(turn);
  return angle > 0 ? (std::tan(angle / 4) / angle) * turn : Vec3{};
}
Vec3 axis_times_angle(Vec3 const& r) {
  double const size = norm(r);
  return size > 0 ? (4 * std::atan(size) / size) * r : Vec3{};
}

TEST(Rotations, TurnAsTheMatrixExponential) {
  Random random(1);
  for (int n = 0; n < 200; ++n) {
    Vec3 const turn = random.vector(1.7), v = random.vector(1);
    EXPECT_LT(distance(v + kernels::turned_by(rotation(turn), v), matrix_of(turn) * v), 1e-14);
    EXPECT_LT(distance(kernels::quaternion_of(rotation(turn)).turned(v), matrix_of(turn) * v - v), 1e-14);
  }
  EXPECT_EQ(kernels::turned_by(Vec3{}, Vec3{1, 2, 3}), Vec3{});
  EXPECT_EQ(kernels::quaternion_of(Vec3{}).turned({1, 2, 3}), Vec3{});
}

TEST(Rotations, SharesAreCloseToThoseOfTheAngle) {
  for (auto const& [angle, degrees] : {std::pair{1.0, 0.5}, {std::numbers::pi / 2, 2.0}, {std::numbers::pi, 16.5}})
    for (double f = 0; f <= 1; f += 0.01)
      EXPECT_NEAR(norm(axis_times_angle(f * rotation({0, angle, 0}))), f * angle, degrees * std::numbers::pi / 180);
}

TEST(Rotations, BetweenTwoDirectionsAreTheSmallest) {
  Random random(2);
  for (int n = 0; n < 200; ++n) {
    Vec3 const before = random.vector(2), after = n % 4 != 0 ? random.vector(3) : -2 * before + random.vector(1e-5);
    Vec3 const turn = axis_times_angle(kernels::turn_between(before, after));
    Vec3 const there = matrix_of(turn) * before;
    EXPECT_LT(distance((1 / norm(there)) * there, (1 / norm(after)) * after), n % 4 != 0 ? 1e-13 : 1e-8);
    EXPECT_NEAR(dot(turn, before), 0, n % 4 != 0 ? 1e-13 : 1e-8);
    EXPECT_LE(norm(turn), std::numbers::pi);
  }
  Vec3 const x{1, 0, 0};
  EXPECT_EQ(kernels::turn_between(x, 2 * x), Vec3{});
  EXPECT_NEAR(norm(kernels::turn_between(x, -x)), 1, 1e-15) << "half a turn";
  EXPECT_EQ(dot(kernels::turn_between(x, -x), x), 0) << "about any axis across";
  Vec3 const axis{0, 0.6, 0.8};
  EXPECT_EQ(kernels::turn_between(x, -x, axis), axis);
  EXPECT_EQ(kernels::turn_between(Vec3{}, x), Vec3{});
  EXPECT_EQ(kernels::turn_between(x, Vec3{}), Vec3{});
}

TEST(Rotations, OneAfterTheOtherMultiplyAsMatricesDo) {
  Random random(3);
  for (int n = 0; n < 200; ++n) {
    Vec3 const first = random.vector(1.8), next = random.vector(1.8), v = random.vector(1);
    Vec3 const both = kernels::turn_then(rotation(first), rotation(next));
    EXPECT_LT(distance(v + kernels::turned_by(both, v), matrix_of(next) * (matrix_of(first) * v)), 1e-13);
    EXPECT_LE(norm(both), 1 + 1e-14);
  }
  EXPECT_EQ(kernels::turn_then(Vec3{}, Vec3{}), Vec3{});
}

TEST(Rotations, OfHalfATurnHaveOneDirection) {
  Random random(9);
  for (int n = 0; n < 100; ++n) {
    Vec3 const v = random.vector(1), axis = (1 / norm(v)) * v, round_off = random.vector(1e-9);
    Vec3 const one = kernels::canonical(axis + round_off), other = kernels::canonical(-axis + round_off);
    EXPECT_LT(distance(one, other), 1e-8) << n;
    Vec3 const w = random.vector(1);
    EXPECT_LT(distance(w + kernels::turned_by(one, w), matrix_of(-std::numbers::pi * axis) * w), 1e-8) << n;
    EXPECT_EQ(kernels::canonical(0.99 * axis), 0.99 * axis);
  }
}

TEST(Rotations, QuarterTangentsAreThoseOfTheAngle) {
  for (double angle = -3.14; angle < 3.14; angle += 0.01)
    EXPECT_NEAR(kernels::quarter_tangent(3 * std::sin(angle), 3 * std::cos(angle)), std::tan(angle / 4), 1e-15);
  EXPECT_EQ(kernels::quarter_tangent(0.0, -1.0), 1) << "half a turn";
  EXPECT_EQ(kernels::quarter_tangent(0.0, 0.0), 0);
  double const tiny = 1e-12;
  EXPECT_NEAR(kernels::quarter_tangent(tiny, -1.0), 1, 1e-11);
}

/// f(a + h a', b + h b') by differences, against duals.
template <class F>
void expect_rates(F const& f, Vec3 const& a, Vec3 const& a_rate, Vec3 const& b, Vec3 const& b_rate) {
  double const h = 1e-5;
  DualVec3 const found = f(DualVec3{a, a_rate}, DualVec3{b, b_rate});
  Vec3 const difference = (0.5 / h) * (f(a + h * a_rate, b + h * b_rate) - f(a - h * a_rate, b - h * b_rate));
  EXPECT_LT(distance(found.rate, difference), 1e-8 * (1 + norm(difference)));
  EXPECT_LT(distance(found.value, f(a, b)), 1e-14 * (1 + norm(found.value)));
}

TEST(Rotations, HaveRatesAlsoWhereNothingTurnsYet) {
  auto const between = [](auto const& a, auto const& b) { return kernels::turn_between(a, b); };
  auto const then = [](auto const& a, auto const& b) { return kernels::turn_then(a, b); };
  auto const by = [](auto const& a, auto const& b) { return kernels::turned_by(a, b); };
  Random random(4);
  for (int n = 0; n < 100; ++n) {
    Vec3 const a = random.vector(0.8), b = random.vector(0.8);
    if (norm(a) < 0.3 || norm(b) < 0.3) continue;  // differences are no measure there
    Vec3 const p = random.vector(1), q = random.vector(1);
    if (norm(axis_times_angle(kernels::turn_between(a, b))) < 2.5) expect_rates(between, a, p, b, q);
    expect_rates(between, a, p, 2 * a, q);
    Vec3 const r = 0.3 * a, s = 0.3 * b;  // far from half a turn in all
    expect_rates(then, r, p, s, q);
    expect_rates(then, Vec3{}, p, s, q);
    expect_rates(then, r, p, Vec3{}, q);
    expect_rates(then, Vec3{}, p, Vec3{}, q);
    expect_rates(by, a, p, b, q);
    expect_rates(by, Vec3{}, p, b, q);
  }
}

TEST(Rotations, OtherWaysRoundAreTheSameRotation) {
  Random random(10);
  for (int n = 0; n < 100; ++n) {
    Vec3 const r = rotation(random.vector(1.8)), other = kernels::other_way(r), v = random.vector(1);
    if (!(norm(r) > 0.01)) continue;
    EXPECT_LT(distance(kernels::turned_by(other, v), kernels::turned_by(r, v)), 1e-13);
    EXPECT_LT(distance(kernels::quaternion_of(other).turned(v), kernels::turned_by(r, v)), 1e-13);
    EXPECT_NEAR(norm(axis_times_angle(r)) + norm(axis_times_angle(other)), 2 * std::numbers::pi, 1e-13);
    EXPECT_LT(distance(kernels::other_way(other), r), 1e-14);
  }
}

TEST(Rotations, GoTheWayThatIsNearer) {
  Random random(11);
  for (int n = 0; n < 100; ++n) {
    Vec3 const v = random.vector(1), axis = (1 / norm(v)) * v;
    for (double angle = 2.2; angle < 4; angle += 0.1) {
      Vec3 const whole = rotation(angle * axis), shorter = norm(whole) > 1 ? kernels::other_way(whole) : whole;
      for (double const mean : {angle - 0.8, angle - 0.1})
        EXPECT_LT(distance(kernels::way_near(shorter, rotation(mean * axis + random.vector(0.2))), whole), 1e-13)
            << angle << " " << mean;
    }
    Vec3 const little = rotation(2 * axis);
    EXPECT_EQ(kernels::way_near(little, rotation(-3 * axis)), little) << "up to 120 degrees they stay as they are";
    Vec3 const half = kernels::canonical(axis);
    EXPECT_EQ(kernels::way_near(half, Vec3{}), half) << "and where there is none that is nearer";
  }
}

TEST(Rotations, KeepTheirWayWhereTheyAreCorrected) {
  Random random(12);
  for (int n = 0; n < 200; ++n) {
    Vec3 const v = random.vector(1), axis = (1 / norm(v)) * v, w = random.vector(1);
    Vec3 const turn = random.between(2.2, 3.8) * axis, correction = random.vector(0.3);
    Vec3 const both = kernels::turn_on(rotation(turn), rotation(correction));
    EXPECT_LT(distance(w + kernels::turned_by(both, w), matrix_of(correction) * (matrix_of(turn) * w)), 1e-12);
    EXPECT_LT(distance(both, rotation(turn)), 0.6);
    EXPECT_LT(distance(kernels::turn_on(rotation(turn), Vec3{}), rotation(turn)), 1e-14);
    Vec3 const less = rotation(0.5 * turn);
    EXPECT_EQ(kernels::turn_on(less, rotation(correction)), kernels::turn_then(less, rotation(correction)));
  }
}

TEST(Rotations, ThatGoTheLongerWayHaveRatesAndTransposes) {
  Random random(13);
  for (int n = 0; n < 100; ++n) {
    Vec3 const v = random.vector(1), axis = (1 / norm(v)) * v, p = random.vector(1), q = random.vector(1);
    Vec3 const r = rotation(random.between(2.2, 4.1) * axis), shorter = norm(r) > 1 ? kernels::other_way(r) : r;
    Vec3 const mean = rotation(3 * axis), correction = rotation(random.vector(0.3)), g = random.vector(1);
    auto const near = [&](auto const& a, auto const&) { return kernels::way_near(a, mean); };
    auto const on = [](auto const& a, auto const& b) { return kernels::turn_on(a, b); };
    expect_rates(near, shorter, p, correction, q);
    expect_rates(on, r, p, correction, q);
    expect_rates(on, r, p, Vec3{}, q);
    EXPECT_NEAR(dot(g, near(DualVec3{shorter, p}, q).rate), dot(kernels::way_near_gradient(shorter, mean, g), p),
                1e-13);
    Vec3 of_first, of_correction;
    kernels::add_turn_on(r, correction, g, of_first, of_correction);
    EXPECT_NEAR(dot(g, on(DualVec3{r, p}, DualVec3{correction, q}).rate), dot(of_first, p) + dot(of_correction, q),
                1e-13);
  }
}

/// A wall node (number 0) in a ring of six, all off any plane; numbers 7 and 8 stand above it.
struct Wall {
  Arrays x{9};
  kernels::WallTable<Host> table;
  std::vector<Vec3> u{9}, rate{9};

  explicit Wall(bool flat) {
    Random random(5);
    for (int n = 0; n < 9; ++n) {
      double const angle = (n - 1) * std::numbers::pi / 3;
      bool const ring = n > 0 && n < 7;
      x.x[n] = (ring ? std::cos(angle) : 0) + random.between(-0.1, 0.1);
      x.y[n] = (ring ? std::sin(angle) : 0) + random.between(-0.1, 0.1);
      x.z[n] = flat ? 0 : (n > 6 ? 0.3 * (n - 6) : 0) + random.between(-0.1, 0.1);
    }
    std::vector<std::int32_t> const pairs =
        flat ? std::vector<std::int32_t>{4, 0, 0, 1} : std::vector<std::int32_t>{1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6, 1};
    table = {view<std::int32_t>({0}),
             view<Index>({0, Index(pairs.size())}),
             view(pairs),
             view<std::uint8_t>({1}),
             flat,
             {0, 0, 1},
             {},
             {}};
  }
  void turn(Vec3 const& by, Vec3 const& shift) {
    for (int n = 0; n < 9; ++n) u[n] = shift + matrix_of(by) * x.read()[n] - x.read()[n];
  }
  [[nodiscard]] Vec3 turn_found() {
    Vec3 found;
    kernels::WallTurn<Host, Vec3>{table, {x.read()}, {x.read(), u.data()}, &found}(0);
    return found;
  }
  [[nodiscard]] Vec3 rate_found() {
    Vec3 found;
    kernels::WallTurn<Host, DualVec3>{table, {x.read()}, {x.read(), u.data(), rate.data()}, &found}(0);
    return found;
  }
};

// The trailing edge of a section: both faces turn by one angle, and the lower one becomes a tenth longer.
TEST(WallTurn, OfASharpEdgeIsThatOfItsFacesHoweverTheyStretch) {
  for (double const wedge : {0.02, 0.1, 0.5})
    for (double const angle : {0.3, -0.7}) {
      Wall wall(true);
      auto const set = [&](std::size_t n, Vec3 const& at) {
        wall.x.x[n] = at.x;
        wall.x.y[n] = at.y;
      };
      Vec3 const above{-std::cos(wedge), std::sin(wedge), 0}, below{-std::cos(wedge), -std::sin(wedge), 0};
      set(0, {});
      set(1, above);
      set(4, below);
      auto const turn = matrix_of({0, 0, angle});
      wall.u[1] = turn * above - above;
      wall.u[4] = 1.1 * (turn * below) - below;
      EXPECT_LT(distance(wall.turn_found(), rotation({0, 0, angle})), 1e-13) << wedge << ' ' << angle;
    }
}

TEST(WallTurn, OfARigidWallIsItsRotation) {
  for (Vec3 const& turn : {Vec3{0.3, -0.2, 0.5}, Vec3{1.5, 1, -0.4}, Vec3{0, 0, 2.9}, Vec3{1e-7, 0, 0}, Vec3{}}) {
    Wall wall(false);
    wall.turn(turn, {3, -1, 2});
    EXPECT_LT(distance(wall.turn_found(), rotation(turn)), 1e-13);
  }
  for (double const angle : {0.4, -2.5}) {
    Wall wall(true);
    wall.turn({0, 0, angle}, {1, 1, 0});
    EXPECT_LT(distance(wall.turn_found(), rotation({0, 0, angle})), 1e-14);
  }
}

TEST(WallTurn, IsExactlyNothingWhereNothingMoves) {
  Random random(11);
  for (int n = 0; n < 200; ++n) {
    Vec3 const v = random.vector(1), axis = (1 / norm(v)) * v;
    std::vector<Vec3> arms;
    for (double const length : {1.0, 1e-3, 1.0, 2e-3}) arms.push_back(length * random.vector(1));
    auto const arm = [&](Index k) { return arms[k]; };
    EXPECT_EQ(kernels::twist_about(axis, Vec3{}, 4, arm, arm, kernels::ArmWeights(4, arm)), Vec3{});
  }
}

TEST(WallTurn, IsZeroWhereItIsNotFollowed) {
  Wall wall(false);
  wall.table.turns = view<std::uint8_t>({0});
  wall.turn({0.3, 0, 0}, {});
  EXPECT_EQ(wall.turn_found(), Vec3{});
  wall.rate.assign(9, {1, 2, 3});
  EXPECT_EQ(wall.rate_found(), Vec3{});
}

TEST(WallTurn, HasTheRateThatDifferencesHave) {
  Random random(6);
  for (bool const flat : {false, true})
    for (double const size : {0.0, 0.1}) {
      Wall wall(flat);
      auto const in_plane = [&](Vec3 v) { return flat ? Vec3{v.x, v.y, 0} : v; };
      if (size > 0) wall.turn({0, 0, 0.8}, {});
      for (int n = 0; n < 9; ++n) {
        wall.u[n] += in_plane(random.vector(size));
        wall.rate[n] = in_plane(random.vector(1));
      }
      Vec3 const rate = wall.rate_found();
      std::vector<Vec3> const u = wall.u;
      double const h = 1e-5;
      Vec3 sides[2];
      for (int s = 0; s < 2; ++s) {
        for (int n = 0; n < 9; ++n) wall.u[n] = u[n] + (s == 0 ? -h : h) * wall.rate[n];
        sides[s] = wall.turn_found();
      }
      EXPECT_LT(distance(rate, (0.5 / h) * (sides[1] - sides[0])), 1e-8) << flat << " " << size;
    }
}

// In the plane z = 0, cells of any aspect ratio: the polar rotation of F by its singular values' closed form in two
// dimensions.
TEST(WallTurn, OfAWallThatStretchesAndShearsIsThePolarRotation) {
  Random random(7);
  for (int n = 0; n < 50; ++n) {
    double const a = random.between(0.5, 2), b = random.between(-0.8, 0.8), c = random.between(-0.8, 0.8),
                 d = random.between(0.5, 2);
    if (a * d - b * c < 0.1) continue;
    double const aspect = std::pow(10, random.between(-3, 3)), skew = random.between(-0.5, 0.5);
    std::vector<Vec3> const arms{{1, 0, 0}, {skew, aspect, 0}, {-1.3, 0, 0}, {-skew, -0.7 * aspect, 0}};
    auto const before = [&](Index k) { return arms[k]; };
    auto const after = [&](Index k) {
      Vec3 const p = before(k);
      return Vec3{a * p.x + b * p.y, c * p.x + d * p.y, 0};
    };
    Vec3 const twist =
        axis_times_angle(kernels::twist_about(Vec3{0, 0, 1}, Vec3{}, 4, before, after, kernels::UnweighedArms{}));
    EXPECT_LT(distance(twist, {0, 0, std::atan2(c - b, a + d)}), 1e-9);
  }
}

// A spike of the wall with an edge along its normal: what round-off leaves of that edge across the normal must decide
// nothing.
TEST(WallTurn, IsThatOfTheOtherArmsWhereOneIsAlongTheNormal) {
  Random random(8);
  for (int n = 0; n < 50; ++n) {
    auto const unit = [](Vec3 const& v) { return (1 / norm(v)) * v; };
    Vec3 const axis = n == 0 ? Vec3{1, 0, 0} : unit(random.vector(1));
    double const angle = random.between(-1, 1);
    Vec3 const across = unit(cross(axis, random.vector(1)));
    std::vector<Vec3> const arms{axis + random.vector(1e-16), axis + across, axis + across + 0.8 * cross(axis, across)};
    auto const before = [&](Index k) { return arms[k]; };
    auto const after = [&](Index k) { return rotation_about({}, axis, angle)(arms[k]); };
    Vec3 const twist = axis_times_angle(kernels::twist_about(axis, Vec3{}, 3, before, after, kernels::UnweighedArms{}));
    EXPECT_LT(distance(twist, angle * axis), 1e-13) << n;
  }
}

// Nodes at one place to round-off, as at poles: what is between them must decide nothing.
TEST(WallTurn, IsNotThatOfArmsOfRoundOff) {
  Random random(10);
  for (int n = 0; n < 50; ++n) {
    double const angle = random.between(-1, 1);
    std::vector<Vec3> const arms{{1, 0.2, 0}, {0.1, 0.7, 0}, {-1, 0.3, 0}, 1e-14 * random.vector(1)};
    auto const before = [&](Index k) { return arms[k]; };
    auto const after = [&](Index k) { return k == 3 ? arms[3] : rotation_about({}, {0, 0, 1}, angle)(arms[k]); };
    Vec3 const twist =
        axis_times_angle(kernels::twist_about(Vec3{0, 0, 1}, Vec3{}, 4, before, after, kernels::ArmWeights(4, before)));
    EXPECT_LT(distance(twist, {0, 0, angle}), 1e-12) << n;
  }
}

TEST(WallFrames, AreTheMotionAroundTheWall) {
  Wall wall(false);
  Vec3 const by{0.3, -0.9, 0.5}, turn = rotation(by);
  wall.turn(by, {3, -1, 2});
  kernels::AffineMotion frame;
  kernels::WallFrames<Host, Vec3>{wall.table, &turn, nullptr, wall.u.data(), &frame}(0);
  Vec3 const x0 = wall.x.read()[0];
  for (int n = 0; n < 9; ++n) EXPECT_LT(distance(kernels::value_at(frame, x0, wall.x.read()[n]), wall.u[n]), 1e-14);
}

TEST(MoveColumns, TakeTheirShareOfTheWallsRotation) {
  Wall wall(false);
  Vec3 const by{0.3, -0.9, 0.5}, turn = rotation(by), x0 = wall.x.read()[0];
  wall.turn(by, {3, -1, 2});
  Vec3 const whole = wall.u[8], root = wall.u[0];
  for (float const share : {0.f, 0.5f, 1.f}) {
    kernels::MoveColumns<Host, Vec3> const kernel{
        {view<std::int32_t>({8}), view<std::int32_t>({0}), view<float>({share})},
        wall.table.node,
        &turn,
        nullptr,
        wall.x.read(),
        wall.u.data()};
    EXPECT_EQ(kernel.size(), 1);
    kernel(0);
    Vec3 const away = wall.x.read()[8] - x0;
    EXPECT_LT(distance(wall.u[8], root + matrix_of(axis_times_angle(double(share) * turn)) * away - away), 1e-14)
        << share;
  }
  EXPECT_LT(distance(wall.u[8], whole), 1e-14) << "as the wall itself";
}

}  // namespace
}  // namespace gridmorph::test
