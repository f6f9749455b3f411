// Targets that go on beyond the sides of the mesh: the part of them inside is the target, whatever is beyond.
#include "support/morph_run.hpp"
#include "support/unstructured_case.hpp"
#include "support/unstructured_meshes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <tuple>
#include <utility>

namespace gridmorph {
namespace {

using Case = test::UnstructuredCase;

/// A surface over two parameters, both from `low` to `high`, in triangles between n + 1 points along each.
TargetRule surface(double low, double high, int n, std::function<Vec3(double a, double b)> const& position) {
  TargetGeometry out;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) out.points.push_back(position(low + (high - low) * i / n, low + (high - low) * j / n));
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      int const a = i + (n + 1) * j;
      out.triangles.push_back({a, a + 1, a + n + 2});
      out.triangles.push_back({a, a + n + 2, a + n + 1});
    }
  TargetRule rule;
  rule.target = std::make_shared<TargetGeometry const>(std::move(out));
  rule.mapping = TargetRule::Mapping::projection;
  return rule;
}

/// The mesh after a motion, as blocks or as the hexahedra that it is.
Coordinates moved(Mesh const& mesh, Motion const& motion, bool blocks) {
  return blocks ? test::morph(mesh, motion).morphed.position : Case(test::to_hexahedra(mesh)).morph(motion).x;
}

TEST(TargetSides, ATargetThatGoesOnBeyondThemIsTheOneThatEndsThere) {
  auto const slope = [](double low, double high, int n) {
    return surface(low, high, n, [](double x, double y) { return Vec3{x, y, 0.1 * x + 0.05 * y}; });
  };
  Mesh const box = test::unit_box({6, 6, 5});
  for (bool const blocks : {true, false}) {
    SCOPED_TRACE(blocks ? "blocks" : "elements");
    auto const onto = [&](TargetRule rule) {
      return moved(box,
                   test::motion_of({test::rule_for({"k_min"}, std::move(rule)), test::rule_for({"k_max"}, FixedRule{}),
                                    test::rule_for({"i_*", "j_*"}, SlipRule{SlipRule::Surface::plane})}),
                   blocks);
    };
    Coordinates const cut = onto(slope(0, 6, 12));
    for (auto const& [low, high, n] : {std::tuple(-0.6, 6.6, 9), {-27.0, 33.0, 7}, {-1e-3, 6 + 1e-3, 5}}) {
      Coordinates const x = onto(slope(low, high, n));
      for (Index v = 0; v < box.n_nodes(); ++v) {
        ASSERT_LT(distance(x[v], cut[v]), 1e-10) << v << " of a target from " << low;
        Vec3 const before = box.coordinates[v];
        for (auto const& [was, is] : {std::pair(before.x, x.x(v)), {before.y, x.y(v)}})
          if (was == 0 || was == 6) {
            EXPECT_NEAR(is, was, 1e-10);
          }
        if (before.z == 0) {
          EXPECT_NEAR(x.z(v), 0.1 * x.x(v) + 0.05 * x.y(v), 1e-10);
        }
      }
    }
  }
}

TEST(TargetSides, StayWhereTheirRuleIsFixedAndTheTargetPassesThem) {
  // A hill amid the ground, which is flat where the box ends.
  auto const hill = [](double low, double high, int n) {
    return surface(low, high, n, [](double x, double y) {
      double const r = std::hypot(x - 3, y - 3) / 2.5;
      return Vec3{x, y, r < 1 ? 0.8 * (1 - r * r) * (1 - r * r) : 0};
    });
  };
  Mesh const box = test::unit_box({6, 6, 5});
  for (bool const blocks : {true, false})
    for (bool const one_rule : {true, false}) {
      SCOPED_TRACE(std::string(blocks ? "blocks" : "elements") + (one_rule ? ", all fixed" : ", two sides free"));
      auto const onto = [&](TargetRule rule) {
        Motion motion = test::motion_of(
            {test::rule_for({"k_min"}, std::move(rule)), test::rule_for({"k_max", "i_*"}, FixedRule{})});
        motion.rules.push_back(one_rule ? test::rule_for({"j_*"}, FixedRule{}) : test::rule_for({"j_*"}, FreeRule{}));
        return moved(box, motion, blocks);
      };
      Coordinates const cut = onto(hill(0, 6, 24)), beyond = onto(hill(-6, 12, 72));
      double highest = 0;
      for (Index v = 0; v < box.n_nodes(); ++v) {
        Vec3 const before = box.coordinates[v], x = beyond[v];
        ASSERT_LT(distance(x, cut[v]), 1e-10) << v;
        if (before.x == 0 || before.x == 6) {
          EXPECT_EQ(distance(x, before), 0) << v;
        }
        highest = before.z == 0 ? std::max(highest, x.z) : highest;
      }
      EXPECT_GT(highest, 0.75);
    }
}

TEST(TargetSides, AFixedGroundInThePlaneOfTheEdgeCutsNoHollow) {
  // The ground goes on beyond the box at a slant: no side, however far the target sinks below it.
  Mesh const box = test::unit_box({8, 4, 4});
  Mesh two = box;
  for (Index n = 0; n < two.n_nodes(); ++n) {
    Vec3 const x = two.coordinates[n];
    if (x.x > 4) two.coordinates.set(n, {x.x, x.y, x.z + 0.1 * (x.x - 4)});
  }
  // The floor's faces in two patches, moved and fixed.
  Case c(test::to_hexahedra(two));
  Mesh parted = c.mesh;
  Patch* floor = nullptr;
  for (Patch& p : parted.patches)
    if (p.name.find("k_min") != std::string::npos) floor = &p;
  ASSERT_NE(floor, nullptr);
  Patch ground = *floor;
  ground.name = "ground";
  ground.families.clear();
  CsrGraph keep, give;
  for (Index f = 0; f < floor->faces.size(); ++f) {
    double most = 0;
    for (Index32 const n : floor->faces[f]) most = std::max(most, parted.coordinates.x(n));
    (most > 4.5 ? give : keep).add(floor->faces[f]);
  }
  floor->faces = keep;
  ground.faces = give;
  parted.patches.push_back(ground);
  auto const rule = surface(-1, 5, 24, [](double x, double y) {
    double const r = std::hypot(x - 2, y - 2) / 1.8;
    return Vec3{x, y, r < 1 ? -0.5 * (1 - r * r) * (1 - r * r) : 0};
  });
  Motion const motion = test::motion_of({test::rule_for({"*k_min"}, rule), test::rule_for({"ground"}, FixedRule{}),
                                         test::rule_for({"*k_max"}, FixedRule{}),
                                         test::rule_for({"*i_*", "*j_*"}, SlipRule{SlipRule::Surface::plane})});
  auto const x = Case(parted).morph(motion).x;
  double lowest = 0;
  for (Index n = 0; n < parted.n_nodes(); ++n) lowest = std::min(lowest, x.z(n));
  EXPECT_LT(lowest, -0.45);
}

TEST(TargetSides, OfRevolutionCutAsPlanesDo) {
  // Between hub (radius 1) and case (radius 2): one side of a sector becomes a plane that leans, and goes on beyond.
  Mesh mesh = test::unit_box({6, 5, 6});
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    Vec3 const p = mesh.coordinates[n];
    double const theta = 0.1 * p.y, r = 1 + p.z / 6;
    mesh.coordinates.set(n, {p.x / 6, r * std::sin(theta), r * std::cos(theta)});
  }
  auto const lean = [](double x, double z) { return 0.05 + 0.03 * x + 0.08 * z; };
  Motion base;
  base.axis = {{0, 0, 0}, {1, 0, 0}};
  for (bool const blocks : {true, false}) {
    SCOPED_TRACE(blocks ? "blocks" : "elements");
    auto const onto = [&](double low, double high, int n) {
      Motion motion = base;
      motion.rules = {test::rule_for({"j_min"}, surface(low, high, n,
                                                        [&](double a, double b) {
                                                          return Vec3{a, lean(a, 1 + b), 1 + b};
                                                        })),
                      test::rule_for({"j_max"}, FixedRule{}),
                      test::rule_for({"k_*"}, SlipRule{SlipRule::Surface::revolution}),
                      test::rule_for({"i_*"}, SlipRule{SlipRule::Surface::plane})};
      return moved(mesh, motion, blocks);
    };
    Coordinates const reference = onto(-0.2, 1.2, 1);
    for (auto const& [low, high, n] : {std::tuple(-0.1, 1.1, 7), {-0.9, 4.0, 3}, {-0.3, 1.3, 40}}) {
      Coordinates const x = onto(low, high, n);
      for (Index v = 0; v < mesh.n_nodes(); ++v) {
        Vec3 const was = mesh.coordinates[v], is = x[v];
        ASSERT_LT(distance(is, reference[v]), 2e-7) << v << " of a target from " << low;
        double const r = std::hypot(was.y, was.z);
        if (std::abs(r - 1) < 1e-9 || std::abs(r - 2) < 1e-9) {
          EXPECT_NEAR(std::hypot(is.y, is.z), r, 1e-10) << v;
        }
        if (was.x == 0 || was.x == 1) {
          EXPECT_NEAR(is.x, was.x, 1e-10) << v;
        }
        if (std::abs(was.y) < 1e-12) {
          EXPECT_NEAR(is.y, lean(is.x, is.z), 1e-7) << v;
        }
      }
    }
  }
}

TEST(TargetSides, CutProfilesOfPlaneMeshes) {
  Mesh const box = test::flat_box(8, 6, 2);
  for (bool const fixed : {false, true}) {
    SCOPED_TRACE(fixed ? "sides that stay" : "sides that slide");
    auto const height = [&](double x) { return fixed ? 0.02 * x * (8 - x) : 0.1 * x + 0.01 * x * x; };
    auto const onto = [&](double low, double high, int n) {
      TargetGeometry target;
      TargetSection& section = target.sections.emplace_back();
      section.name = "ground";
      for (int k = 0; k <= n; ++k) {
        double const x = low + (high - low) * k / n;
        section.points.push_back({x, height(x), 0});
      }
      TargetRule rule;
      rule.target = std::make_shared<TargetGeometry const>(std::move(target));
      MotionRule sides =
          fixed ? test::rule_for({"i_*"}, FixedRule{}) : test::rule_for({"i_*"}, SlipRule{SlipRule::Surface::plane});
      return Case(box)
          .morph(test::motion_of({test::rule_for({"j_min"}, rule), test::rule_for({"j_max"}, FixedRule{}), sides}))
          .x;
    };
    Coordinates const cut = onto(0, 8, 8), beyond = onto(-24, 40, 64);
    for (Index v = 0; v < box.n_nodes(); ++v) {
      Vec3 const was = box.coordinates[v];
      ASSERT_LT(distance(beyond[v], cut[v]), 1e-10) << v;
      if (was.x == 0 || was.x == 8) {
        EXPECT_NEAR(beyond.x(v), was.x, 1e-10) << v;
      }
      if (was.y == 0 && (was.x == 0 || was.x == 8)) {
        EXPECT_NEAR(beyond.y(v), height(was.x), 1e-10) << v;
      }
    }
  }
}

}  // namespace
}  // namespace gridmorph
