// Walls that stand beside walls that move.
#include "support/made_bodies.hpp"
#include "support/unstructured_case.hpp"
#include "support/unstructured_meshes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <map>

namespace gridmorph {
namespace {

using test::motion_of;
using test::rule_for;
using test::translation;
using Case = test::UnstructuredCase;

/// Pins of radius 0.25 side by side in a channel of height 1, from x = -0.5 on, each amid an O-mesh of quadrilaterals
/// at the pin and triangles beyond. Patches "pin1", ..., "lower", "upper" (walls), "inlet", "outlet".
Mesh pins(int count) {
  constexpr int side = 8, around = 4 * side, layers = 9;
  std::vector<double> height{0};
  for (double h = 0.003; height.back() < 1; h = std::min(1.3 * h, 0.06)) height.push_back(height.back() + h / 0.25);
  double const last = height.back();
  for (double& h : height) h /= last;
  Mesh mesh;
  mesh.dimension = 2;
  mesh.source = "pins";
  std::map<std::pair<long, long>, Index32> number;
  std::vector<Vec3> points;
  auto const node = [&](double x, double y) {
    auto const [at, fresh] = number.try_emplace({std::lround(1e9 * x), std::lround(1e9 * y)}, Index32(points.size()));
    if (fresh) points.push_back({x, y, 0});
    return at->second;
  };
  std::vector<std::vector<std::array<Index32, around>>> grid;
  for (int pin = 0; pin < count; ++pin) {
    grid.emplace_back();
    for (double const t : height) {
      auto& row = grid.back().emplace_back();
      for (int i = 0; i < around; ++i) {
        double const s = -1 + 2.0 * (i % side) / side;
        std::array<std::array<double, 2>, 4> const square{{{s, -1}, {1, s}, {-s, 1}, {-1, -s}}};
        auto const [px, py] = square[i / side];
        double const r = std::hypot(px, py);
        row[i] = node(pin + (1 - t) * 0.25 * px / r + t * 0.5 * px, (1 - t) * 0.25 * py / r + t * 0.5 * py);
      }
    }
  }
  mesh.add_zone("channel", Index(points.size()));
  mesh.coordinates = Coordinates(mesh.n_nodes());
  for (std::size_t n = 0; n < points.size(); ++n) mesh.coordinates.set(Index(n), points[n]);
  std::map<std::string, CsrGraph> faces;
  for (int pin = 0; pin < count; ++pin) {
    auto const& g = grid[pin];
    for (std::size_t i = 0; i < around; ++i) {
      std::size_t const j = (i + 1) % around;
      for (std::size_t l = 0; l + 1 < g.size(); ++l) {
        std::array const q{g[l][i], g[l + 1][i], g[l + 1][j], g[l][j]};
        if (l < layers) {
          mesh.add_element(ElementType::quadrilateral, q);
        } else {
          mesh.add_element(ElementType::triangle, std::array{q[0], q[1], q[2]});
          mesh.add_element(ElementType::triangle, std::array{q[0], q[2], q[3]});
        }
      }
      faces["pin" + std::to_string(pin + 1)].add(std::array{g[0][i], g[0][j]});
      std::array const outer{g.back()[i], g.back()[j]};
      int const edge = int(i) / side;
      if (edge == 0 || edge == 2) faces[edge == 0 ? "lower" : "upper"].add(outer);
      if (edge == 1 && pin + 1 == count) faces["outlet"].add(outer);
      if (edge == 3 && pin == 0) faces["inlet"].add(outer);
    }
  }
  for (auto& [name, list] : faces) {
    Patch patch;
    patch.name = name;
    patch.kind = name == "inlet" ? PatchKind::inflow : name == "outlet" ? PatchKind::outflow : PatchKind::wall;
    patch.zone = 0;
    patch.faces = std::move(list);
    mesh.patches.push_back(std::move(patch));
  }
  return mesh;
}

Rule no_motion() {
  return FunctionRule{"zero", [](std::span<Vec3 const>, std::span<Vec3> u) { std::fill(u.begin(), u.end(), Vec3{}); }};
}

bool same_bits(Coordinates const& a, Coordinates const& b) {
  auto const same = [](Coordinates::View const& p, Coordinates::View const& q) {
    return std::memcmp(p.data(), q.data(), p.extent(0) * sizeof(double)) == 0;
  };
  return same(a.x, b.x) && same(a.y, b.y) && same(a.z, b.z);
}

/// The wall `moving` heaves, all others stand by `rule`.
Coordinates heaved(Case const& c, std::string const& moving, double by, std::vector<std::string> const& others,
                   Rule const& rule) {
  return c.guarded_morph(motion_of({rule_for({moving}, translation({0, by, 0})), rule_for(others, rule)})).x;
}

TEST(StandingWall, MovesTheMeshAlikeWhicheverRuleHoldsIt) {
  Mesh box = test::airfoil(60, 8, 2e-3, 1.3, 3);
  for (auto& patch : box.patches) patch.kind = PatchKind::wall;
  struct {
    Mesh mesh;
    std::string moving;
    double by;
    std::vector<std::string> others;
  } const cases[]{{pins(5), "pin3", 0.1, {"pin1", "pin2", "pin4", "pin5", "lower", "upper"}},
                  {std::move(box), "airfoil", 0.5, {"farfield"}},
                  {test::box_around({9, 9, 9},
                                    [](Vec3 const& p) {
                                      return norm(p - Vec3{4.5, 4.5, 4.5}) < 2;
                                    }),
                   "body",
                   0.5,
                   {"?_min", "?_max"}}};
  for (auto const& [mesh, moving, by, others] : cases) {
    Case const c(mesh);
    Coordinates const fixed = heaved(c, moving, by, others, FixedRule{});
    EXPECT_TRUE(same_bits(fixed, heaved(c, moving, by, others, translation({0, 0, 0})))) << mesh.source;
    EXPECT_TRUE(same_bits(fixed, heaved(c, moving, by, others, no_motion()))) << mesh.source;
    EXPECT_EQ(c.inverted(fixed), 0) << mesh.source;
  }
}

TEST(StandingWall, KeepsItsBoundaryLayerBesideAWallThatMoves) {
  Case const c(pins(3));
  Motion const motion = motion_of({rule_for({"pin2"}, translation({0, 0.1, 0}))});
  auto const m = c.guarded_morph(motion);
  EXPECT_EQ(c.inverted(m.x), 0);
  // The first layers of the pin beside stay; those of the pin that moves go along.
  Index stands = 0, moves = 0;
  for (Index n = 0; n < c.mesh.n_nodes(); ++n) {
    Vec3 const x = c.mesh.coordinates[n], u = m.x[n] - x;
    if (norm(x) < 0.26) {
      ++stands;
      EXPECT_EQ(norm(u), 0) << n;
    } else if (norm(x - Vec3{1, 0, 0}) < 0.26) {
      ++moves;
      EXPECT_NEAR(distance(u, {0, 0.1, 0}), 0, 1e-15) << n;
    }
  }
  EXPECT_GE(stands, 2 * 32);
  EXPECT_GE(moves, 2 * 32);
}

TEST(StandingWall, HoldsNodesThatSlipBesideIt) {
  // A body near the corner between a wall that stands and a plane to slide on; thin cells on the wall, or tetrahedra.
  for (bool const thin : {true, false}) {
    Mesh mesh = test::box_around(
        {12, 12, 12},
        [](Vec3 const& p) {
          return norm(p - Vec3{4, 3.5, 6}) < 1.8;
        },
        !thin);
    for (auto& patch : mesh.patches) patch.kind = patch.name == "i_min" ? PatchKind::wall : patch.kind;
    for (Index n = 0; n < mesh.n_nodes(); ++n) {
      double const x = mesh.coordinates.x(n);
      if (thin && x < 2) mesh.coordinates.x(n) = 2 * std::pow(x / 2, 6);  // first cell 1/32
    }
    Case const c(mesh);
    PlanOptions options;
    options.elements.offset = 2.5;
    auto const m =
        c.morph(motion_of({rule_for({"body"}, translation({0, 0, 0.6})), rule_for({"j_min"}, SlipRule{})}), options);
    double largest = 0, beside = 0;
    double const first = thin ? 1.0 / 32 : 1;
    for (Index32 const n : c.nodes_of("j_min")) {
      Vec3 const x = c.mesh.coordinates[n];
      double const u = distance(m.x[n], x);
      largest = std::max(largest, u);
      if (std::abs(x.x - first) < 1e-9) beside = std::max(beside, u / first);
      EXPECT_NEAR(m.x[n].y, 0, 1e-14);
    }
    EXPECT_GT(largest, 0.4) << "nodes slide where they are free to";
    EXPECT_LT(beside, 0.3) << "a cell off the wall they hardly do";
    EXPECT_EQ(c.inverted(m.x), 0);
  }
}

TEST(SlidingWall, TakesItsBoundaryLayerAlong) {
  Mesh mesh = test::box_around(
      {14, 12, 10}, [](Vec3 const& p) { return std::abs(p.x - 7) < 2 && std::abs(p.y - 6) < 2 && p.z > 4 && p.z < 7; });
  for (auto& patch : mesh.patches) patch.kind = patch.name == "k_min" ? PatchKind::wall : patch.kind;
  Case const c(mesh);
  Motion const motion = motion_of({rule_for({"body"}, translation({0.7, 0.3, 0})), rule_for({"k_min"}, SlipRule{})});
  PlanOptions options;
  options.boundary_layers.push_back({.walls = {"k_min"}, .extent = BoundaryLayer::Extent::layers, .layers = 2});
  auto const m = c.morph(motion, options);
  auto const displacement = [&](Index32 n) { return m.x[n] - c.mesh.coordinates[n]; };
  double slides = 0;
  std::map<std::pair<double, double>, Index32> wall;
  for (Index32 const n : c.nodes_of("k_min")) {
    Vec3 const x = c.mesh.coordinates[n];
    wall[{x.x, x.y}] = n;
    slides = std::max(slides, norm(displacement(n)));
    EXPECT_NEAR(m.x[n].z, 0, 1e-15) << n;
  }
  EXPECT_GT(slides, 0.1);
  auto const& plan = m.prepared.plan;
  // But for those on the other sides of the box.
  EXPECT_GT(plan.sliding.size(), 130u);
  for (std::size_t k = 0; k < plan.sliding.size(); ++k) {
    Vec3 const x = c.mesh.coordinates[plan.sliding[k]];
    ASSERT_EQ(plan.sliding_root[k], (wall.at({x.x, x.y})));
    EXPECT_LE(x.z, 2);
    EXPECT_LT(distance(displacement(plan.sliding[k]), displacement(plan.sliding_root[k])), 1e-14) << k;
  }
  EXPECT_EQ(c.inverted(m.x), 0);
}

}  // namespace
}  // namespace gridmorph
