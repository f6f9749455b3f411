// Rotations of walls at their edges, where faces turn differently, against heights above the faces and differences.
#include "kernels/tables.hpp"
#include "support/random.hpp"

#include <gridmorph/geometry/rotation.hpp>
#include <gridmorph/kernels/root_turn.hpp>
#include <gridmorph/kernels/turned_ends.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace gridmorph::test {
namespace {

using kernels::DualVec3;

/// Of the first root; its rate for V = DualVec3. mean: the rotation of its body.
template <class V>
Vec3 raw_turn(kernels::RootTable<Host> const& table, Arrays& u, Arrays& rate, Vec3 const& mean = {}) {
  Arrays free(1), free_rate(1), raw(1), of_body(1);
  of_body.field().set(0, mean);
  kernels::FreeRootTurn<Host, Vec3>{table, {u.read(), {}}, free.field()}(0);
  kernels::FreeRootTurn<Host, DualVec3>{table, {u.read(), rate.read()}, free_rate.field()}(0);
  kernels::RawRootTurn<Host, V>{
      table, {u.read(), rate.read()}, {free.read(), free_rate.read()}, of_body.read(), raw.field()}(0);
  return raw.read()[0];
}

/// Slot 0 at the corner of a body where three faces meet, its neighbours along the edges at slots 1 to 3, cells as flat
/// as those of boundary layers are; a line that leans to one face.
struct Corner {
  std::array<Vec3, 3> arm;
  Vec3 line;
  Arrays u{4}, rate{4};
  kernels::RootTable<Host> table;

  explicit Corner(Random& random, std::array<double, 3> const& length = {1, 0.05, 3}) {
    for (int k = 0; k < 3; ++k) {
      Vec3 direction{k == 0 ? -1.0 : 0, k == 1 ? -1.0 : 0, k == 2 ? -1.0 : 0};
      direction += random.vector(0.1);
      arm[k] = (length[k] / norm(direction)) * direction;
    }
    Vec3 const off = Vec3{random.between(0.2, 1), random.between(0.2, 1), random.between(0.2, 1)};
    line = (1 / norm(off)) * off;
    std::vector<kernels::RootNeighbour> neighbours;
    for (int k = 0; k < 3; ++k)
      for (int const m : {k, (k + 1) % 3}) {
        Vec3 const& a = arm[m];
        neighbours.push_back({Index(m + 1), -1, a});
      }
    table.roots = view<kernels::Root>({{0, 0, 0, 6, 1, 0, line, 0}});
    table.neighbours = view(neighbours);
  }
  /// Of the corner and its neighbours by a function of the place.
  template <class Motion>
  void move(Motion const& motion) {
    for (int n = 0; n < 4; ++n) {
      Vec3 const x = n == 0 ? Vec3{} : arm[n - 1];
      u.field().set(n, motion(x));
    }
  }
  [[nodiscard]] Vec3 found(Vec3 const& mean = {}) { return raw_turn<Vec3>(table, u, rate, mean); }
  [[nodiscard]] Vec3 rate_found(Vec3 const& mean = {}) { return raw_turn<DualVec3>(table, u, rate, mean); }
  /// By differences.
  [[nodiscard]] Vec3 difference_found(Vec3 const& mean = {}) {
    std::array<Vec3, 4> at;
    for (int k = 0; k < 4; ++k) at[k] = u.read()[k];
    double const h = 1e-6;
    auto const moved_on = [&](double step) {
      for (int k = 0; k < 4; ++k) u.field().set(k, at[k] + step * rate.read()[k]);
      return found(mean);
    };
    Vec3 const before = moved_on(-h), after = moved_on(h);
    moved_on(0);
    return (0.5 / h) * (after - before);
  }
  /// Sines of the angle between a line and the three faces; after: the faces as they are moved.
  [[nodiscard]] std::array<double, 3> sines(Vec3 const& along, bool after) {
    std::array<double, 3> out{};
    for (int k = 0; k < 3; ++k) {
      auto const arm_now = [&](int m) { return after ? arm[m] + (u.read()[m + 1] - u.read()[0]) : arm[m]; };
      Vec3 const normal = cross(arm_now(k), arm_now((k + 1) % 3));
      double const sign = dot(cross(arm[0], arm[1]), arm[2]) < 0 ? 1 : -1;
      out[k] = sign * dot(normal, along) / norm(normal);
    }
    return out;
  }
};

TEST(RootTurn, OfARigidBodyIsItsRotationAtItsEdgesToo) {
  Random random(1);
  for (int n = 0; n < 100; ++n) {
    Corner corner(random);
    Vec3 const turn = random.vector(1.7), v = random.vector(1), shift = random.vector(2);
    Mat3 const r = rotation_by(turn);
    corner.move([&](Vec3 const& x) { return shift + r * x - x; });
    EXPECT_LT(distance(v + kernels::turned_by(corner.found(), v), r * v), 1e-12) << n;
  }
}

/// A blade where it stands on the hub of an annulus that widens to both ends: x(a, h), a along the chord, h along the
/// span.
struct Section {
  double stagger, chord;
  [[nodiscard]] Vec3 at(double a, double h) const {
    double const axial = chord * a * std::cos(stagger), angle = chord * a * std::sin(stagger) / 0.44;
    double const radius = 0.44 + 0.35 * axial * axial + h;
    return {axial, radius * std::cos(angle), radius * std::sin(angle)};
  }
  /// Unit, at a = 0: along the chord, along the span, across both.
  [[nodiscard]] std::array<Vec3, 3> axes() const {
    return {Vec3{std::cos(stagger), 0, std::sin(stagger)}, {0, 1, 0}, {-std::sin(stagger), 0, std::cos(stagger)}};
  }
};

// The lines along the chord follow the annulus: beside the span's first cells they sag by more than these are high, to
// one side before and to the other one after.
TEST(RootTurn, IsThatOfShortArmsToo) {
  Section const before{0.6, 1}, after{0.2, 0.95};
  std::array<Vec3, 3> const from = before.axes(), to = after.axes();
  for (double const cell : {1e-3, 1e-5, 1e-6, 1e-7})
    for (bool const at_hub : {false, true}) {
      std::vector<std::pair<double, double>> const around{{6e-3, 0}, {0, 1.4 * cell}, {-2e-3, 0}, {0, -cell}};
      Arrays u(5);
      u.field().set(0, after.at(0, 0) - before.at(0, 0));
      std::vector<kernels::RootNeighbour> neighbours;
      for (int n = 0; n < (at_hub ? 2 : 4); ++n)
        for (int const m : {n, (n + 1) % 4}) {
          auto const [a, h] = around[m];
          neighbours.push_back({Index(m + 1), -1, before.at(a, h) - before.at(0, 0)});
          u.field().set(m + 1, after.at(a, h) - before.at(a, h));
        }
      kernels::RootTable<Host> table;
      table.roots = view<kernels::Root>({{0, 0, 0, std::int32_t(neighbours.size()), 1, 0, {}}});
      table.neighbours = view(neighbours);
      Arrays still(5);
      Vec3 const found = raw_turn<Vec3>(table, u, still);
      for (int k = 0; k < 3; ++k)
        EXPECT_LT(distance(from[k] + kernels::turned_by(found, from[k]), to[k]), 0.01)
            << cell << " " << at_hub << " " << k;
    }
}

// The normals of both faces of a thin trailing edge nearly cancel: how differently they stretch must not turn it.
TEST(RootTurn, OfASharpEdgeIsThatOfItsFaces) {
  for (double const wedge_deg : {2.0, 12.0, 60.0})
    for (double const turn_deg : {0.0, 22.0, -40.0}) {
      double const half = wedge_deg * std::numbers::pi / 360;
      std::array<Vec3, 4> const arm{Vec3{-std::cos(half), std::sin(half), 0}, Vec3{0, 0, 1},
                                    Vec3{-std::cos(half), -std::sin(half), 0}, Vec3{0, 0, -1}};
      std::array<double, 4> const stretch{1.3, 1, 0.8, 1};
      Vec3 const turn{0, 0, turn_deg * std::numbers::pi / 180};
      Arrays u(5), still(5);
      std::vector<kernels::RootNeighbour> neighbours;
      for (int n = 0; n < 4; ++n) {
        auto const k = std::size_t(n);
        u.field().set(n + 1, stretch[k] * (rotation_by(turn) * arm[k]) - arm[k]);
        for (int const m : {n, (n + 1) % 4}) neighbours.push_back({Index(m + 1), -1, arm[m]});
      }
      kernels::RootTable<Host> table;
      table.roots = view<kernels::Root>({{0, 0, 0, 8, 1, 0, {}}});
      table.neighbours = view(neighbours);
      Vec3 const found = raw_turn<Vec3>(table, u, still), x{1, 0, 0};
      EXPECT_LT(distance(x + kernels::turned_by(found, x), rotation_by(turn) * x), 1e-12)
          << wedge_deg << " " << turn_deg;
    }
}

TEST(RootTurn, KeepsLinesOffTheFacesOfAnEdgeAsWellAsNoTurnWould) {
  Random random(2);
  int limited = 0;
  for (int n = 0; n < 400; ++n) {
    Corner corner(random);
    std::array<Vec3, 3> const gradient{random.vector(0.7), random.vector(0.7), random.vector(0.7)};
    auto const sheared = [&](Vec3 const& x) {
      return Vec3{dot(gradient[0], x), dot(gradient[1], x), dot(gradient[2], x)};
    };
    corner.move(sheared);
    Vec3 const turned = corner.line + kernels::turned_by(corner.found(), corner.line);
    auto const before = corner.sines(corner.line, false), still = corner.sines(corner.line, true),
               after = corner.sines(turned, true);
    for (std::size_t k = 0; k < 3; ++k) {
      double const keep = std::min({0.99, 1.2 - 1.4 * before[k] * before[k], still[k] / before[k]});
      // The share of a turn is taken as linear in what it does to the line.
      EXPECT_GT(after[k] / before[k], keep - 0.25) << n << " face " << k;
      limited += after[k] / before[k] < keep + 0.01 ? 1 : 0;
    }
  }
  EXPECT_GT(limited, 20) << "there is something to keep";
}

// Where arms are of one length, as elements do not weigh them.
TEST(RootTurn, IsThatOfAWallOfElementsWithTheSameColumns) {
  Random random(5);
  int limited = 0;
  for (int n = 0; n < 200; ++n) {
    Corner corner(random, {1, 1, 1});
    Arrays x(4);
    std::vector<Vec3> u, rate;
    for (int k = 0; k < 4; ++k) {
      if (k > 0) x.field().set(k, corner.arm[k - 1]);
      u.push_back(0.3 * (k == 0 ? 1 : norm(corner.arm[k - 1])) * random.vector(1));
    }
    Vec3 const spin = random.vector(0.1), shift = random.vector(0.1);
    for (int k = 0; k < 4; ++k) {
      auto const n = std::size_t(k);
      rate.push_back(shift + cross(spin, (k > 0 ? corner.arm[n - 1] : Vec3{}) + u[n]));
      corner.u.field().set(k, u[n]);
      corner.rate.field().set(k, rate[n]);
    }
    Vec3 const up = (1 / std::sqrt(3.0)) * Vec3{1, 1, 1};
    kernels::WallTable<Host> table{view<std::int32_t>({0}),
                                   view<Index>({0, 6}),
                                   view<std::int32_t>({1, 2, 2, 3, 3, 1}),
                                   view<std::uint8_t>({1}),
                                   false,
                                   {0, 0, 1},
                                   view<Index>({0, 1}),
                                   view<Vec3>({corner.line})};
    Vec3 found, found_rate;
    kernels::WallTurn<Host, Vec3>{table, {x.read()}, {x.read(), u.data()}, &found}(0);
    kernels::WallTurn<Host, DualVec3>{table, {x.read()}, {x.read(), u.data(), rate.data()}, &found_rate}(0);
    EXPECT_LT(distance(found, corner.found()), 1e-12) << n;
    EXPECT_LT(distance(found_rate, corner.rate_found()), 1e-9 * (1 + norm(found_rate))) << n;
    // Of two columns the one that allows less decides.
    table.first_line = view<Index>({0, 2});
    table.lines = view<Vec3>({up, corner.line});
    Vec3 both;
    kernels::WallTurn<Host, Vec3>{table, {x.read()}, {x.read(), u.data()}, &both}(0);
    EXPECT_LE(norm(both), norm(found) + 1e-15) << n;
    table.first_line = view<Index>({0, 0});
    Vec3 free;
    kernels::WallTurn<Host, Vec3>{table, {x.read()}, {x.read(), u.data()}, &free}(0);
    limited += norm(found) < 0.999 * norm(free) ? 1 : 0;
  }
  EXPECT_GT(limited, 20);
}

TEST(RootTurn, HasTheRateThatDifferencesHaveAtEdges) {
  Random random(3);
  int far_off = 0;
  for (int n = 0; n < 60; ++n) {
    Corner corner(random);
    for (int k = 0; k < 4; ++k) {
      corner.u.field().set(k, 0.3 * (k == 0 ? 1 : norm(corner.arm[k - 1])) * random.vector(1));
      corner.rate.field().set(k, 0.1 * random.vector(1));
    }
    Vec3 const rate = corner.rate_found();
    far_off += distance(rate, corner.difference_found()) < 1e-5 * (1 + norm(rate)) ? 0 : 1;
  }
  EXPECT_LE(far_off, 1) << "but where another face begins to limit";
}

/// The rotation by an angle in degrees, whose mean the body has.
Vec3 about(Vec3 const& axis, double degrees) { return std::tan(degrees * std::numbers::pi / 720) * axis; }

// Half a turn of a body that is deformed besides: whatever a node turns by, it goes the way of the body, with its
// rates.
TEST(RootTurn, GoesTheWayOfItsBody) {
  Random random(7);
  for (double const degrees : {100.0, 125.0, 150.0, 178.0, 180.0, 182.0, 200.0})
    for (int n = 0; n < 20; ++n) {
      Corner corner(random, {1, 1, 1});
      Vec3 const v = random.vector(1), axis = (1 / norm(v)) * v, mean = about(axis, std::min(degrees, 179.9));
      Mat3 const r = rotation_by(degrees * std::numbers::pi / 180 * axis);
      corner.move([&](Vec3 const& x) { return r * x - x; });
      EXPECT_LT(distance(corner.found(mean), about(axis, degrees)), 1e-12) << degrees;
      corner.move([&](Vec3 const& x) { return r * (x + Vec3{0, 0.02 * x.x, -0.03 * x.y}) - x; });
      EXPECT_LT(distance(corner.found(mean), about(axis, degrees)), 0.1) << degrees;
      for (int k = 0; k < 4; ++k) corner.rate.field().set(k, random.vector(0.1));
      Vec3 const rate = corner.rate_found(mean);
      EXPECT_LT(distance(rate, corner.difference_found(mean)), 1e-7 * (1 + norm(rate))) << degrees;
    }
}

TEST(RootTurn, StaysTheShorterWayWithoutABody) {
  Random random(8);
  Corner corner(random, {1, 1, 1});
  corner.table.roots = view<kernels::Root>({{0, 0, 0, 6, 1, 0, corner.line}});
  Vec3 const axis{0.48, -0.6, 0.64};
  Mat3 const r = rotation_by(200 * std::numbers::pi / 180 * axis);
  corner.move([&](Vec3 const& x) { return r * x - x; });
  EXPECT_LT(distance(corner.found(about(axis, 170)), about(axis, -160)), 1e-12);
}

// What is between a wall that goes the longer way round and an outer edge that hands on none or a part of its turn goes
// that way too.
TEST(NearFieldLines, GoTheWayOfTheirWall) {
  Vec3 const axis{0.48, -0.6, 0.64}, y{1, 2, -0.5};
  kernels::RootTable<Host> table;
  table.roots = view<kernels::Root>({{0, 0, 0, 0, 1, 0, {}}});
  Arrays inner(1), outer(1), position(2), turn(2);
  kernels::TurnNearField<Host, Vec3> lines{{}, table, {}, {}, {}, position.read(), turn.field(), {}};
  for (double const degrees : {130.0, 170.0, 190.0, 230.0})
    for (double const share : {0.0, 0.25}) {
      inner.field().set(0, about(axis, degrees));
      outer.field().set(0, share * about(axis, degrees));
      auto const found = lines.at({0, 1, 0, -1, axis, {}, 0.5}, inner.read(), inner.read(), outer.read());
      double const edge = 4 * std::atan(share * std::tan(degrees * std::numbers::pi / 720)) * 180 / std::numbers::pi;
      auto const middle = kernels::Quaternion<Vec3>::between(found.upper.q, found.lower.q, 0.5);
      Vec3 const half = kernels::turned_by(about(axis, (degrees + edge) / 2), y);
      EXPECT_LT(distance(middle.turned(y), half), 1e-12) << degrees << " " << share;
    }
}

}  // namespace
}  // namespace gridmorph::test
