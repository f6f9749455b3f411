// Charts, how they are chosen, and wraps and background meshes that end with the mesh.
#include <gridmorph/morph/apply_on_host.hpp>
#include <gridmorph/plan/elements/background.hpp>
#include <gridmorph/plan/elements/fit_domain.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "support/made_bodies.hpp"
#include "support/random.hpp"
#include "support/reduced.hpp"
#include "support/unstructured_case.hpp"
#include "support/unstructured_meshes.hpp"

namespace gridmorph::test {
namespace {

using Place = std::function<Vec3(Vec3 const&)>;
using Side = ChartedDomain::Side;

/// A box of 12 x 12 x 10 unit cells around a body in its middle, each node at to(node).
Mesh around_body(Place const& to, bool rooted = false) {
  Mesh mesh = box_around({12, 12, 10}, [&](Vec3 const& p) { return norm(p - Vec3{6, 6, rooted ? 0.0 : 5.0}) < 2.2; });
  for (Index n = 0; n < mesh.n_nodes(); ++n) mesh.coordinates.set(n, to(mesh.coordinates[n]));
  return mesh;
}

double bump(double x) { return 0.3 * std::sin(std::numbers::pi * x / 12); }

Vec3 in_channel(Vec3 const& p) { return {p.x, p.y * (1 + bump(p.x)) + 3 * bump(p.x), p.z}; }
Vec3 in_sector(Vec3 const& p) {
  double const r = 10 + 2 * bump(p.x) + p.y * (0.5 - 0.3 * bump(p.x)), angle = 0.06 * p.z + 0.3 * bump(p.x);
  return {p.x, r * std::cos(angle), r * std::sin(angle)};
}
Vec3 in_disc(double u, double v, double z) {
  return {8 * u * std::sqrt(1 - v * v / 2) + 1, 8 * v * std::sqrt(1 - u * u / 2) - 2, z};
}
Vec3 in_pipe(Vec3 const& p) { return in_disc(p.x / 6 - 1, p.y / 6 - 1, p.z); }
Vec3 in_half_pipe(Vec3 const& p) { return in_disc(p.x / 6 - 1, p.y / 12, p.z); }
Vec3 in_quarter_pipe(Vec3 const& p) { return in_disc(p.x / 12, p.y / 12 - 1, p.z); }
Vec3 in_ball(Vec3 const& p) {
  Vec3 const q{p.x - 6, p.y - 6, 1.2 * (p.z - 5)};
  double const largest = std::max({std::abs(q.x), std::abs(q.y), std::abs(q.z)}), r = norm(q);
  return r > 0 ? (largest / r) * q : q;
}
Vec3 same(Vec3 const& p) { return p; }

struct Shape {
  char const* name;
  Place to;
  char const* chart;
};
std::vector<Shape> shapes() {
  if (reduced()) return {{"sector", in_sector, "annular sector between surfaces"}, {"pipe", in_pipe, "disc"}};
  return {{"box", same, "box"},
          {"channel", in_channel, "box between surfaces"},
          {"sector", in_sector, "annular sector between surfaces"},
          {"pipe", in_pipe, "disc"},
          {"half pipe", in_half_pipe, "disc"},
          {"quarter pipe", in_quarter_pipe, "disc"},
          {"ball", in_ball, "box"}};
}

detail::FittedDomain fitted(UnstructuredCase const& c) {
  std::vector<std::uint8_t> moving;
  for (Index f = 0; f < c.topology.boundary.size(); ++f)
    moving.push_back(c.face_patches.patch[f] == c.patch("body") ? 1 : 0);
  std::vector<Axis> const axes(1);
  return detail::fit_domain({}, c.mesh, c.topology.boundary, moving, axes);
}

TEST(Domain, GetsTheChartThatItsBoundaryAsksFor) {
  for (Shape const& shape : shapes()) {
    SCOPED_TRACE(shape.name);
    UnstructuredCase const c(around_body(shape.to));
    auto const found = fitted(c);
    EXPECT_EQ(found.domain.chart.name(), shape.chart);
    bool const is_ball = std::string(shape.name) == "ball";
    if (!is_ball) {
      EXPECT_GT(found.share, 0.95);
    }
    for (auto const& sides : found.domain.side)
      for (Side const side : sides) EXPECT_EQ(side, is_ball ? Side::open : Side::stands);
  }
}

TEST(Domain, IsTheSameInAnotherUnitAndWithRoundOff) {
  for (Shape const& shape : shapes()) {
    SCOPED_TRACE(shape.name);
    Mesh const mesh = around_body(shape.to);
    auto const first = fitted(UnstructuredCase(mesh));
    Random random(3);
    for (double const scale : {0.1, 3.0, 1e3}) {
      Mesh other = mesh;
      other.coordinates = Coordinates(mesh.n_nodes());
      for (Index n = 0; n < mesh.n_nodes(); ++n) {
        Vec3 const r = random.vector(1e-14);
        Vec3 const p = mesh.coordinates[n];
        other.coordinates.set(n, scale * Vec3{p.x * (1 + r.x), p.y * (1 + r.y), p.z * (1 + r.z)});
      }
      auto const again = fitted(UnstructuredCase(other));
      EXPECT_EQ(again.domain.chart.name(), first.domain.chart.name());
      EXPECT_EQ(again.domain.chart.order, first.domain.chart.order);
      EXPECT_EQ(again.side_of_face, first.side_of_face);
      EXPECT_NEAR(again.domain.box.high[0], scale * first.domain.box.high[0], 1e-9 * scale);
    }
  }
}

// Means of ends that differ by round-off alone may be equal: knots that took them were filled again and again, without
// end.
TEST(Domain, OfAFoldedMeshIsFoundInTheEnd) {
  constexpr double ulp = 0x1p-52;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    Random random(seed);
    Mesh mesh = box_around({12, 12, 10}, [](Vec3 const& p) { return p.x > 7 && p.y > 5; });
    for (Index n = 0; n < mesh.n_nodes(); ++n) {
      Vec3 p = mesh.coordinates[n];
      double const thin = 1 + ulp * random.below(4);
      (seed % 3 == 0 ? p.x : seed % 3 == 1 ? p.y : p.z) = thin;
      if (seed % 2 == 0 && random.below(5) == 0) p = {1e-307 * random.below(9), 1e-307 * random.below(9), 0};
      mesh.coordinates.set(n, p);
    }
    UnstructuredTopology const topology = make_topology(mesh);
    std::vector<std::uint8_t> const moving(topology.boundary.size(), 0);
    detail::FittedDomain const found = detail::fit_domain({}, mesh, topology.boundary, moving, {});
    EXPECT_LE(found.share, 1) << seed;
  }
}

TEST(Chart, ComesBackToEveryPlace) {
  for (Shape const& shape : shapes()) {
    SCOPED_TRACE(shape.name);
    Mesh const mesh = around_body(shape.to);
    Chart const chart = fitted(UnstructuredCase(mesh)).domain.chart;
    for (Index n = 0; n < mesh.n_nodes(); ++n) {
      Vec3 const p = mesh.coordinates[n];
      // At the corners of the square around a disc angles vanish, and half of the digits with them.
      EXPECT_LT(distance(chart.place(chart(p)), p), shape.to(Vec3{}).x < -1 ? 1e-7 : 1e-12);
    }
  }
}

Rule twisted(Place const& to, double size) {
  return FunctionRule{"twists", [to, size](std::span<Vec3 const> x, std::span<Vec3> u) {
                        Vec3 const centre = to({6, 6, 5});
                        for (std::size_t n = 0; n < x.size(); ++n) {
                          Vec3 const d = x[n] - centre;
                          u[n] = {size * d.y * d.y, 0, size * d.x};
                        }
                      }};
}

TEST(FittedBackground, StaysInTheDomainAndLeavesNoNodeOfTheWrapOutside) {
  for (Shape const& shape : shapes()) {
    std::string const name = shape.name;
    if (name == "ball") continue;
    SCOPED_TRACE(name);
    UnstructuredCase const c(around_body(shape.to));
    Motion const motion =
        motion_of({rule_for({"body"}, twisted(shape.to, 0.02)), rule_for({"?_min", "?_max"}, FixedRule{})});
    auto const prepared = prepare(c.mesh, c.topology, c.face_patches, motion, by_lattice());
    EXPECT_EQ(prepared.report.wrap_outside, 0) << prepared.report.wrap_distance;
    ASSERT_TRUE(prepared.plan.background);
    Coordinates const& x = prepared.plan.background->mesh.coordinates;
    for (Index n = 0; n < x.size(); ++n) {
      Vec3 const p = x[n];
      double const slack = 0.05;  // of 10 or 12: tables are linear between their knots
      if (name == "channel") {
        double const y = (p.y - 3 * bump(p.x)) / (1 + bump(p.x));
        EXPECT_TRUE(y > -slack && y < 12 + slack) << y;
      }
      if (name == "sector") {
        double const r = std::hypot(p.y, p.z), y = (r - 10 - 2 * bump(p.x)) / (0.5 - 0.3 * bump(p.x));
        double const z = (std::atan2(p.z, p.y) - 0.3 * bump(p.x)) / 0.06;
        EXPECT_TRUE(y > -slack && y < 12 + slack) << y;
        EXPECT_TRUE(z > -slack && z < 10 + slack) << z;
      }
      if (name.ends_with("pipe")) {
        EXPECT_LT(std::hypot(p.x - 1, p.y + 2), 8 * (1 + 1e-9));
      }
      if (name == "half pipe") {
        EXPECT_GE(p.y, -2 - 1e-9);
      }
      if (name == "quarter pipe") {
        EXPECT_TRUE(p.x >= 1 - 1e-9 && p.y <= -2 + 1e-9) << p.x << ' ' << p.y;
      }
      if (name == "box") {
        EXPECT_TRUE(p.x >= 0 && p.x <= 12 && p.y >= 0 && p.y <= 12 && p.z >= 0 && p.z <= 10);
      }
    }
  }
}

TEST(FittedBackground, LeavesAllThatIsNearTheWallsToTheWrap) {
  for (Shape const& shape : shapes()) {
    SCOPED_TRACE(shape.name);
    UnstructuredCase const c(around_body(shape.to));
    std::vector<CsrGraph> walls(1);
    for (Index f = 0; f < c.topology.boundary.size(); ++f)
      if (c.face_patches.patch[f] == c.patch("body")) walls[0].add(c.topology.boundary.nodes[f]);
    WrapOptions options;
    options.offset = 0.8;
    options.domain = fitted(c).domain;
    gridmorph::Wrap const wrap = make_wrap({}, c.mesh, walls, options);
    Random random(7);
    Index32 const last = Index32(walls[0].item.size()) - 1;
    for (int k = 0; k <= last; ++k) {
      Vec3 const p = c.mesh.coordinates[walls[0].item[k]];
      Vec3 const r = random.vector(1);
      // Charts stretch lengths by what they are at the faces, a little differently elsewhere.
      EXPECT_TRUE(wrap.contains(p + (0.9 * options.offset / std::max(1.0, norm(r))) * r));
    }
    EXPECT_FALSE(wrap.contains(shape.to({0.1, 0.1, 0.1})));
  }
}

TEST(FittedBackground, MovesNothingForNothingAndAllForAll) {
  for (Shape const& shape : shapes()) {
    SCOPED_TRACE(shape.name);
    UnstructuredCase const c(around_body(shape.to, true));
    PlanOptions options;
    options.elements.motion = 0.1;
    for (Vec3 const& t : {Vec3{}, Vec3{0.1, 0.2, -0.3}}) {
      auto const m = c.morph(motion_of({rule_for({"body", "?_min", "?_max"}, translation(t))}), options);
      for (Index n = 0; n < m.x.size(); ++n)
        EXPECT_LE(distance(m.x[n], c.mesh.coordinates[n] + t), norm(t) == 0 ? 0 : 2e-12);
    }
  }
}

TEST(FittedBackground, NodesSlideOnSidesThatSlip) {
  // A body on the lower end; sides slip that the wrap does not reach.
  UnstructuredCase const c(around_body(same, true));
  FunctionRule const sheared{"shear", [](std::span<Vec3 const> x, std::span<Vec3> u) {
                               for (std::size_t n = 0; n < x.size(); ++n) u[n] = x[n].z * Vec3{0.2, 0.05, 0.1};
                             }};
  Motion const motion = motion_of(
      {rule_for({"body"}, sheared), rule_for({"k_min"}, FixedRule{}), rule_for({"k_max", "i_*", "j_*"}, SlipRule{})});
  auto const prepared = prepare(c.mesh, c.topology, c.face_patches, motion, {});
  ASSERT_TRUE(prepared.report.wrap && prepared.plan.background);
  EXPECT_TRUE(prepared.report.wrap->reaches[2][0]);
  EXPECT_EQ(prepared.report.wrap->domain.side[2][1], Side::slips);
  auto const& sides = prepared.plan.background->sides;
  EXPECT_EQ(sides.size(), 6u);
  EXPECT_EQ(
      std::count_if(sides.begin(), sides.end(), [](auto const& s) { return std::holds_alternative<SlipRule>(s.rule); }),
      5);
  // The background alone: its wrap moves, its outer patches stand.
  Background const& background = *prepared.plan.background;
  auto const nodes = wrap_nodes(background, *prepared.plan.background_morph);
  Plan const& plan = prepared.plan.background_morph->plan();
  std::vector<Vec3> boundary(plan.boundary_nodes.size());
  for (Index32 const b : nodes.boundary_node) boundary[b] = {0.4, 0.1, 0.2};
  using Host = UnstructuredCase::Host;
  Coordinates const& before = background.mesh.coordinates;
  Coordinates x(before.size());
  apply_on_host(MorpherAccess::of(Host(), plan, before), boundary, x);
  double along = 0;
  for (Index n = 0; n < x.size(); ++n) {
    Vec3 const p = before[n], q = x[n];
    if (p.z == 10) {
      EXPECT_NEAR(q.z, 10, 1e-12);
      along = std::max(along, q.x - p.x);
    }
    if (p.x == 0 || p.x == 12) {
      EXPECT_NEAR(q.x, p.x, 1e-12);
    }
    if (p.y == 0 || p.y == 12) {
      EXPECT_NEAR(q.y, p.y, 1e-12);
    }
  }
  EXPECT_GT(along, 0.05);
}

}  // namespace
}  // namespace gridmorph::test
