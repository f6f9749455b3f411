// The rule `target` on unstructured meshes: what it says depends on faces and positions, not on numbers.
#include "support/made_bodies.hpp"
#include "support/random.hpp"
#include "support/unstructured_case.hpp"
#include "support/unstructured_meshes.hpp"

#include <generators/sphere.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/file_order.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

namespace gridmorph {
namespace {

using test::motion_of;
using test::rule_for;
using Case = test::UnstructuredCase;
constexpr double pi = std::numbers::pi;

/// position(s, t) over [0, 1] x [0, 1] as triangles, ni x nj cells.
TargetGeometry facets(int ni, int nj, std::function<Vec3(double s, double t)> const& position) {
  TargetGeometry out;
  for (int j = 0; j <= nj; ++j)
    for (int i = 0; i <= ni; ++i) out.points.push_back(position(double(i) / ni, double(j) / nj));
  for (int j = 0; j < nj; ++j)
    for (int i = 0; i < ni; ++i) {
      int const a = i + (ni + 1) * j;
      out.triangles.push_back({a, a + 1, a + ni + 2});
      out.triangles.push_back({a, a + ni + 2, a + ni + 1});
    }
  return out;
}

Rule onto(TargetGeometry target, TargetRule::Mapping mapping = TargetRule::Mapping::automatic) {
  TargetRule rule;
  rule.target = std::make_shared<TargetGeometry const>(std::move(target));
  rule.mapping = mapping;
  return rule;
}

/// Displacement of the nodes of one patch by its rule, by node.
struct Asked {
  std::vector<Index32> nodes;
  std::vector<Vec3> u;
};
Asked asked(Case const& c, std::string const& patch, Rule const& rule) {
  auto const prepared = prepare(c.mesh, c.topology, c.face_patches, motion_of({rule_for({patch}, rule)}), {});
  auto const all = prepared.boundary_displacement();
  Asked out;
  for (Index32 const n : c.nodes_of(patch)) {
    auto const at = std::lower_bound(prepared.plan.known.begin(), prepared.plan.known.end(), n);
    out.nodes.push_back(n);
    out.u.push_back(all[at - prepared.plan.known.begin()]);
  }
  return out;
}

TEST(UnstructuredTarget, ASphereThatGrowsMovesRadially) {
  for (auto const elements : {LayerElements::prisms, LayerElements::hexahedra}) {
    SphereOptions options;
    options.elements = 12'000;
    options.layer_elements = elements;
    Case const c(make_sphere(options));
    auto const grown = [](double s, double t) {
      return 0.55 *
             Vec3{std::sin(pi * t) * std::cos(2 * pi * s), std::sin(pi * t) * std::sin(2 * pi * s), std::cos(pi * t)};
    };
    auto const [nodes, u] = asked(c, "sphere", onto(facets(192, 96, grown)));
    double tilt = 0, least = 1, most = 0;
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      Vec3 const x = c.mesh.coordinates[nodes[k]];
      tilt = std::max(tilt, norm(cross(x, u[k])) / (norm(x) * norm(u[k])));
      least = std::min(least, norm(x + u[k]));
      most = std::max(most, norm(x + u[k]));
    }
    EXPECT_LT(std::asin(tilt) * 180 / pi, 1.0) << "degrees off the radius";
    EXPECT_GT(least, 0.55 * (1 - 0.5 * std::pow(2 * pi / 96, 2))) << "on the facets";
    EXPECT_LE(most, 0.55 * (1 + 1e-12));
  }
}

// A sphere as its own target: what nodes miss by is measured on the morphed mesh, against facets.
TEST(UnstructuredTarget, HowFarNodesEndedFromItIsMeasured) {
  SphereOptions options;
  options.elements = 12'000;
  Case const c(make_sphere(options));
  auto const grown = [](double s, double t) {
    return 0.55 *
           Vec3{std::sin(pi * t) * std::cos(2 * pi * s), std::sin(pi * t) * std::sin(2 * pi * s), std::cos(pi * t)};
  };
  auto const morphed = c.morph(motion_of({rule_for({"sphere"}, onto(facets(192, 96, grown)))}));
  BoundaryMotion const& motion = *morphed.prepared.boundary.motion;
  auto const reached = motion.target_reach(morphed.x);
  ASSERT_EQ(reached.size(), 1u);
  EXPECT_EQ(reached[0].nodes, Index(c.nodes_of("sphere").size()));
  EXPECT_LT(reached[0].max, 1e-12);
  auto const before = motion.target_reach(c.mesh.coordinates);
  EXPECT_NEAR(before[0].max, 0.05, 1e-3);
  EXPECT_NEAR(before[0].rms, 0.05, 1e-3);
}

TEST(UnstructuredTarget, AWallTakesTheShapeBetweenItsEdges) {
  auto const bump = [](double s, double t) {
    return Vec3{12 * s, 10 * t, std::pow(std::sin(pi * s) * std::sin(pi * t), 2)};
  };
  for (bool const triangles : {false, true}) {
    Mesh const box = test::unit_box({12, 10, 6});
    Case const c(triangles ? test::to_prisms_and_tetrahedra(box, 2) : test::to_hexahedra(box));
    auto const [nodes, u] = asked(c, "k_min", onto(facets(60, 50, bump)));
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      Vec3 const x = c.mesh.coordinates[nodes[k]], y = x + u[k];
      EXPECT_NEAR(y.z, bump(y.x / 12, y.y / 10).z, 0.01);
      EXPECT_LT(std::hypot(u[k].x, u[k].y), 0.12) << "up, hardly along the wall";
      bool const edge = x.x == 0 || x.x == 12 || x.y == 0 || x.y == 10;
      EXPECT_LT(norm(u[k]), edge ? 1e-12 : 2.0) << "edges stay on edges";
    }
  }
}

TEST(UnstructuredTarget, LinesOfA2DMeshGoToAProfileByArcLength) {
  Mesh mesh = test::airfoil(80, 4, 2e-3, 1.3, 5);
  reorder(mesh, order_by_position(mesh));
  Case const c(std::move(mesh));
  auto const nodes = c.nodes_of("airfoil");
  auto const grown = [](Vec3 const& x) { return Vec3{1.1 * x.x - 0.05, 1.1 * x.y, x.z}; };
  // The profile around: by angle about mid-chord.
  std::vector<Vec3> around;
  for (Index32 const n : nodes) around.push_back(grown(c.mesh.coordinates[n]));
  std::sort(around.begin(), around.end(),
            [](Vec3 const& a, Vec3 const& b) { return std::atan2(a.y, a.x - 0.5) > std::atan2(b.y, b.x - 0.5); });
  TargetGeometry section;
  section.sections.push_back({"profile", around});
  around.push_back(around.front());
  auto const strip = [&](double s, double t) {
    Vec3 p = around[std::lround(s * double(around.size() - 1))];
    p.z = 0.3 * t;
    return p;
  };
  for (TargetGeometry const& target : {section, facets(int(around.size()) - 1, 3, strip)}) {
    auto const moved = asked(c, "airfoil", onto(target));
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      Vec3 const x = c.mesh.coordinates[moved.nodes[k]];
      EXPECT_LT(distance(x + moved.u[k], grown(x)), 1e-6);
      EXPECT_EQ(moved.u[k].z, 0);
    }
  }
}

TEST(UnstructuredTarget, ARoundProfileThatTurnsTakesItsNodesAlong) {
  // An ellipse has no corner that could say where its nodes belong.
  constexpr int around = 48, layers = 6;
  Mesh mesh;
  mesh.dimension = 2;
  mesh.source = "ellipse";
  mesh.add_zone("plane", around * (layers + 1));
  mesh.coordinates = Coordinates(mesh.n_nodes());
  auto const ellipse = [](double angle) { return Vec3{std::cos(angle), 0.3 * std::sin(angle), 0}; };
  Patch body, outer;
  for (int j = 0; j <= layers; ++j)
    for (int i = 0; i < around; ++i) {
      Vec3 const x = ellipse(2 * pi * i / around), far = 4 * Vec3{x.x, x.y / 0.3, 0};
      mesh.coordinates.set(i + around * j, x + (double(j) / layers) * (far - x));
      Index32 const a = i + around * j, b = (i + 1) % around + around * j;
      if (j < layers) mesh.add_element(ElementType::quadrilateral, std::array{a, a + around, b + around, b});
      if (j == 0) body.faces.add(std::array{a, b});
      if (j == layers) outer.faces.add(std::array{a, b});
    }
  body.name = "body";
  body.kind = PatchKind::wall;
  outer.name = "outer";
  outer.kind = PatchKind::farfield;
  body.zone = outer.zone = 0;
  mesh.patches = {body, outer};
  RigidTransform const turn = rotation_about({0.2, 0.1, 0}, {0, 0, 1}, 0.1);
  TargetGeometry target;
  target.sections.push_back({"turned", {}});
  for (int k = 0; k < 400; ++k) target.sections[0].points.push_back(turn(1.05 * ellipse(1 - 2 * pi * k / 400)));
  Case const c(std::move(mesh));
  auto const [nodes, u] = asked(c, "body", onto(target));
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    Vec3 const x = c.mesh.coordinates[nodes[k]];
    EXPECT_LT(distance(x + u[k], turn(1.05 * x)), 5e-3) << nodes[k];
  }
}

TEST(UnstructuredTarget, AnOpenLineGoesFromEndToEnd) {
  Case const c(test::flat_box(20, 8, 3));
  TargetGeometry target;
  target.sections.push_back({"bump", {}});
  for (int k = 100; k >= 0; --k)
    target.sections[0].points.push_back({0.2 * k, 0.5 * std::pow(std::sin(pi * k / 100), 2), 0});
  auto const [nodes, u] = asked(c, "j_min", onto(target));
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    Vec3 const y = c.mesh.coordinates[nodes[k]] + u[k];
    EXPECT_NEAR(y.y, 0.5 * std::pow(std::sin(pi * y.x / 20), 2), 1e-3);
    EXPECT_LT(std::abs(u[k].x), 0.1);
  }
}

TEST(UnstructuredTarget, PointsForNodesAreInTheOrderOfTheFile) {
  Mesh mesh = test::box_around({7, 7, 7}, [](Vec3 const& p) { return norm(p - Vec3{3.5, 3.5, 3.5}) < 1.5; });
  TargetGeometry target;
  Case const before(mesh);
  for (Index32 const n : before.nodes_of("body")) target.nodes.push_back(1.1 * mesh.coordinates[n]);
  reorder(mesh, order_by_position(mesh));
  Case const c(std::move(mesh));
  auto const [nodes, u] = asked(c, "body", onto(target));
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    Vec3 const x = c.mesh.coordinates[nodes[k]];
    EXPECT_EQ(norm(x + u[k] - 1.1 * x) < 1e-14, true);
  }
}

TEST(UnstructuredTarget, WhatCannotBeMappedIsRefused) {
  Case const c(test::box_around({5, 5, 5}, [](Vec3 const& p) { return norm(p - Vec3{2.5, 2.5, 2.5}) < 1; }));
  TargetGeometry section;
  section.sections.push_back({"a", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0.5, 0}}});
  EXPECT_THROW((void)asked(c, "body", onto(section)), MotionError);
  EXPECT_THROW((void)asked(c, "body", onto(section, TargetRule::Mapping::nodes)), MotionError);
  Case const flat(test::flat_box(6, 4, 1));
  section.sections[0].points[2].z = 0.3;
  EXPECT_THROW((void)asked(flat, "j_min", onto(section)), MotionError);
  EXPECT_THROW((void)asked(flat, "j_min",
                           onto(facets(2, 2,
                                       [](double s, double t) {
                                         return Vec3{s, t * t, 1 + t};
                                       }))),
               MotionError)
      << "beside the plane";
}

}  // namespace
}  // namespace gridmorph
