// Elements of second order: their Jacobian against maps whose derivative is known, its sign against dense samples, and
// meshes of them morphed: nodes amid edges on walls, on surfaces they slide on, and inside.
#include "support/made_bodies.hpp"
#include "support/random.hpp"
#include "support/unstructured_case.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/kernels/curved_element.hpp>
#include <gridmorph/quality/validity.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace gridmorph::test {
namespace {

using kernels::CurvedElement;
using kernels::ElementCorners;
using kernels::JacobianSign;
using Exec = Kokkos::DefaultHostExecutionSpace;

Vec3 const up{0, 0, 1};

constexpr ElementType all_types[] = {ElementType::triangle, ElementType::quadrilateral, ElementType::tetrahedron,
                                     ElementType::pyramid,  ElementType::prism,         ElementType::hexahedron};

/// Corners where the element's own coordinates are 0 or 1.
std::vector<Vec3> reference_corners(ElementType type) {
  switch (type) {
    case ElementType::triangle: return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    case ElementType::quadrilateral: return {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    case ElementType::tetrahedron: return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    case ElementType::pyramid: return {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.3, 0.4, 1}};
    case ElementType::prism: return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
    default: return {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  }
}

/// The element with all corners at `corner` and the others amid them, moved by `to`.
CurvedElement element(ElementType type, std::vector<Vec3> const& corner, std::function<Vec3(Vec3 const&)> const& to) {
  CurvedElement c{type, {}};
  for (std::size_t k = 0; k < corner.size(); ++k) c.at[k] = to(corner[k]);
  for (int e = 0; e < n_edges(type); ++e)
    c.at[corner.size() + std::size_t(e)] =
        to(0.5 * (corner[kernels::edge_corner(type, e, 0)] + corner[kernels::edge_corner(type, e, 1)]));
  if (kernels::n_curved_nodes(type) > n_corners(type) + n_edges(type)) kernels::curved::complete(c);
  return c;
}

ElementCorners corners(CurvedElement const& c) {
  ElementCorners out;
  for (int k = 0; k < n_corners(c.type); ++k) out.at[k] = c.at[k];
  return out;
}

/// Where a point of the cube is in the reference element.
Vec3 reference(ElementType type, Vec3 const& p) {
  switch (type) {
    case ElementType::triangle: return {p.x * (1 - p.y), p.y, 0};
    case ElementType::tetrahedron: return {p.x * (1 - p.y) * (1 - p.z), p.y * (1 - p.z), p.z};
    case ElementType::prism: return {p.x * (1 - p.y), p.y, p.z};
    case ElementType::pyramid: return {(1 - p.z) * p.x + 0.3 * p.z, (1 - p.z) * p.y + 0.4 * p.z, p.z};
    default: return p;
  }
}

/// x + quadratics of it, with its exact derivative.
struct QuadraticMap {
  double a[3][6];
  explicit QuadraticMap(Random& random, double size) {
    for (auto& row : a)
      for (double& v : row) v = random.vector(size).x;
  }
  Vec3 operator()(Vec3 const& p) const {
    double const q[6] = {p.x * p.x, p.y * p.y, p.z * p.z, p.x * p.y, p.y * p.z, p.z * p.x};
    double x[3] = {p.x, p.y, p.z};
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 6; ++k) x[i] += a[i][k] * q[k];
    return {x[0], x[1], x[2]};
  }
  [[nodiscard]] double jacobian(Vec3 const& p, bool flat) const {
    Vec3 column[3];
    double const dq[3][6] = {{2 * p.x, 0, 0, p.y, 0, p.z}, {0, 2 * p.y, 0, p.x, p.z, 0}, {0, 0, 2 * p.z, 0, p.y, p.x}};
    for (int d = 0; d < 3; ++d) {
      double x[3] = {d == 0 ? 1.0 : 0.0, d == 1 ? 1.0 : 0.0, d == 2 ? 1.0 : 0.0};
      for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 6; ++k) x[i] += a[i][k] * dq[d][k];
      column[d] = {x[0], x[1], x[2]};
    }
    return dot(cross(column[0], column[1]), flat ? up : column[2]);
  }
};

TEST(CurvedElements, JacobianOfAQuadraticMapIsExact) {
  Random random(3);
  for (ElementType const type : all_types) {
    SCOPED_TRACE(to_string(type));
    bool const flat = is_surface(type);
    for (int trial = 0; trial < 20; ++trial) {
      QuadraticMap const map(random, 0.2);
      CurvedElement const c = element(type, reference_corners(type), [&](Vec3 const& p) { return map(p); });
      for (int sample = 0; sample < 20; ++sample) {
        Vec3 p = 0.5 * (random.vector(1) + Vec3{1, 1, 1});
        if (flat) p.z = 0;
        double const factor = type == ElementType::pyramid ? (1 - p.z) * (1 - p.z) : 1;
        EXPECT_NEAR(kernels::curved::jacobian(c, p, up), factor * map.jacobian(reference(type, p), flat), 1e-12);
      }
    }
  }
}

TEST(CurvedElements, StraightOnesAreMeasuredAsFirstOrder) {
  Random random(5);
  for (ElementType const type : all_types)
    for (int trial = 0; trial < 30; ++trial) {
      SCOPED_TRACE(to_string(type));
      auto corner = reference_corners(type);
      for (Vec3& p : corner) {
        p += random.vector(0.25);
        if (is_surface(type)) p.z = 0;
      }
      CurvedElement const c = element(type, corner, [](Vec3 const& p) { return p; });
      auto const curved = kernels::curved_measures(c, corners(c), 1, up);
      auto const straight = element_measures(type, corners(c), 1, up);
      EXPECT_NEAR(curved.volume, straight.volume, 1e-12);
      EXPECT_NEAR(curved.determinant_2x2x2, straight.determinant_2x2x2, 1e-10);
      EXPECT_NEAR(curved.determinant_3x3x3, straight.determinant_3x3x3, 1e-10);
      EXPECT_EQ(curved.minimum_angle_deg, straight.minimum_angle_deg);
      auto const sign = kernels::jacobian_sign(type, corners(c), 1, up);
      EXPECT_EQ(kernels::curved_sign(c, corners(c), 1, up), sign);
      EXPECT_EQ(kernels::curved_sign(c, corners(c), -1, up), JacobianSign::negative);
    }
}

TEST(CurvedElements, SignAgreesWithDenseSamples) {
  Random random(7);
  int between = 0;  // negative between nodes alone: why samples do not do
  for (ElementType const type : all_types) {
    SCOPED_TRACE(to_string(type));
    int positive = 0, negative = 0;
    for (int trial = 0; trial < 120; ++trial) {
      double const amplitude = 0.02 + 0.002 * trial;
      CurvedElement const c = element(type, reference_corners(type), [&](Vec3 const& p) {
        Vec3 q = p + random.vector(amplitude);
        if (is_surface(type)) q.z = 0;
        return q;
      });
      int const n = is_surface(type) ? 40 : 14;
      double least = HUGE_VAL, at_nodes = HUGE_VAL;
      for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j)
          for (int k = 0; k <= (is_surface(type) ? 0 : n); ++k) {
            Vec3 const p{double(i) / n, double(j) / n, double(k) / n};
            if (type == ElementType::pyramid && k == n) continue;
            double const factor = type == ElementType::pyramid ? (1 - p.z) * (1 - p.z) : 1;
            double const value = kernels::curved::jacobian(c, p, up) / factor;
            least = std::min(least, value);
            if (2 * i % n == 0 && 2 * j % n == 0 && 2 * k % n == 0) at_nodes = std::min(at_nodes, value);
          }
      JacobianSign const sign = kernels::curved_sign(c, corners(c), 1, up);
      if (sign == JacobianSign::positive) {
        EXPECT_GT(least, 0) << trial;
        ++positive;
      } else {
        EXPECT_EQ(sign, JacobianSign::negative) << trial;
        EXPECT_LT(least, 0.1) << trial;  // samples may miss where it is
        ++negative;
        between += at_nodes > 0 ? 1 : 0;
      }
    }
    EXPECT_GT(positive, 20);
    EXPECT_GT(negative, 20);
  }
  EXPECT_GT(between, 0);
}

TEST(CurvedElements, VolumeIsThatOfTheMap) {
  // A quarter of a ring as one hexahedron: x = r cos, y = r sin by quadratics of the angle is no circle, but its volume
  // is known: half of the cross products summed around, exact for parabolas.
  CurvedElement const c =
      element(ElementType::hexahedron, reference_corners(ElementType::hexahedron), [](Vec3 const& p) {
        double const angle = p.y * std::numbers::pi / 2, r = 1 + p.x;
        return Vec3{r * std::cos(angle), r * std::sin(angle), p.z};
      });
  auto const m = kernels::curved_measures(c, corners(c), 1, up);
  double const per_square = [] {  // integral of (x dy - y dx) / 2 along the parabola of the unit arc
    double sum = 0;
    int const n = 2000;
    auto const at = [](double t) {
      double const w[3] = {(1 - t) * (1 - 2 * t), 4 * t * (1 - t), t * (2 * t - 1)}, s = std::sqrt(0.5);
      return Vec3{w[0] + s * w[1], s * w[1] + w[2], 0};
    };
    for (int k = 0; k < n; ++k) sum += 0.5 * cross(at(double(k) / n), at(double(k + 1) / n)).z;
    return sum;
  }();
  EXPECT_NEAR(m.volume, 3 * per_square, 1e-6);
}

/// Half a ring: cells of 8 x 12 (x 3), radii 1 to 3; patch "i_min" the inner wall, "i_max" the outer one.
Vec3 to_ring(Vec3 const& p) {
  double const r = 1 + p.x / 4, angle = p.y * std::numbers::pi / 12;
  return {r * std::cos(angle), r * std::sin(angle), p.z / 3};
}

struct Ring {
  std::string name;
  Mesh mesh;
};
std::vector<Ring> rings() {
  Mesh const box = to_hexahedra(unit_box({8, 12, 3}));
  return {{"hexahedra of 20 nodes", second_order(box, false, to_ring)},
          {"hexahedra of 27 nodes", second_order(box, true, to_ring)},
          {"prisms and tetrahedra", second_order(to_prisms_and_tetrahedra(unit_box({8, 12, 3}), 2), true, to_ring)},
          {"quadrilaterals and triangles", second_order(flat_box(8, 12, 5), true, to_ring)}};
}

TEST(CurvedMeshes, ATurnOfAllTurnsMiddlesToo) {
  Mat3 const turn = rotation_matrix(up, 1.0);
  for (Ring const& ring : rings()) {
    SCOPED_TRACE(ring.name);
    UnstructuredCase const c(ring.mesh);
    ASSERT_EQ(c.inverted(c.mesh.coordinates), 0);
    Motion motion;
    for (Patch const& patch : c.mesh.patches) motion.rules.push_back({{patch.name}, RigidRule{turn, {}}, 0, "test"});
    auto const m = c.morph(motion);
    EXPECT_EQ(c.largest_miss(m), 0);
    for (Index n = 0; n < c.mesh.n_nodes(); ++n) ASSERT_LT(distance(m.x[n], turn * c.mesh.coordinates[n]), 2e-6) << n;
  }
}

TEST(CurvedMeshes, NodesAmidEdgesOfWallsDoWhatTheirRuleSays) {
  auto const bend = [](std::span<Vec3 const> x, std::span<Vec3> u) {
    for (std::size_t n = 0; n < x.size(); ++n) {
      double const angle = std::atan2(x[n].y, x[n].x);
      u[n] = 0.15 * std::sin(3 * angle) * std::sin(3 * angle) * Vec3{std::cos(angle), std::sin(angle), 0};
    }
  };
  for (Ring const& ring : rings()) {
    SCOPED_TRACE(ring.name);
    UnstructuredCase const c(ring.mesh);
    Motion motion;
    motion.rules.push_back({{"i_min"}, FunctionRule{"bend", bend}, 0, "test"});
    SlipRule along_it;
    along_it.surface = SlipRule::Surface::baseline;
    if (c.mesh.dimension == 3)
      motion.rules.push_back({{"i_max"}, along_it, 0, "test"});
    else
      motion.rules.push_back({{"i_max"}, FixedRule{}, 0, "test"});
    for (auto const* name : {"j_min", "j_max", "k_min", "k_max"})
      if (c.patch(name) >= 0) motion.rules.push_back({{name}, SlipRule{}, 0, "test"});
    auto const m = c.morph(motion);
    EXPECT_EQ(c.largest_miss(m), 0);
    Index on_wall = 0;
    for (Index n = 0; n < c.mesh.n_nodes(); ++n) {
      Vec3 const p = c.mesh.coordinates[n];
      double const r = std::hypot(p.x, p.y);
      if (std::abs(r - 1) < 1e-9) {
        Vec3 u;
        bend({&p, 1}, {&u, 1});
        ASSERT_EQ(m.x[n], p + u) << n;
        ++on_wall;
      }
      if (std::abs(r - 3) < 1e-9) {  // slides on facets of the outer wall
        EXPECT_NEAR(std::hypot(m.x[n].x, m.x[n].y), 3, 0.01) << n;
      }
      if (std::abs(p.y) < 1e-12 && r > 1.1) {
        EXPECT_NEAR(m.x[n].y, 0, 1e-12) << n;  // a plane
      }
    }
    EXPECT_GE(on_wall, c.mesh.dimension == 2 ? 17 : 17 * 4);
    EXPECT_EQ(c.inverted(m.x), 0);
    EXPECT_TRUE(certify(Exec(), c.mesh, c.topology, {views(m.x), views(c.mesh.coordinates), {}, {}}).holds());
  }
}

TEST(CurvedMeshes, WhatIsNegativeBetweenNodesIsSeen) {
  Mesh const mesh = second_order(flat_box(3, 3, 3), true);
  UnstructuredCase const c(mesh);
  Coordinates x(mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) x.set(n, mesh.coordinates[n]);
  // A node amid an edge pulled three quarters of the way to the next one: corners do not see it.
  Index32 const middle = mesh.elements.nodes[4][4];
  x.set(middle, mesh.coordinates[middle] + Vec3{0.4, 0, 0});
  EXPECT_GT(c.inverted(x), 0);
  auto const certificate = certify(Exec(), mesh, c.topology, {views(x), views(mesh.coordinates), {}, {}});
  EXPECT_EQ(certificate.broken.cells, 2);
}

TEST(CurvedMeshes, TheGuardTakesMiddlesAlong) {
  Mesh const mesh = second_order(to_hexahedra(unit_box({6, 6, 6})), true, [](Vec3 const& p) {
    return p + 0.1 * Vec3{std::sin(p.y), std::sin(p.z), std::sin(p.x)};
  });
  UnstructuredCase const c(mesh);
  Motion motion;
  motion.rules.push_back({{"k_min"}, RigidRule{{}, {0, 0, 0.05}}, 0, "test"});
  for (auto const* name : {"i_min", "i_max", "j_min", "j_max", "k_max"})
    motion.rules.push_back({{name}, FixedRule{}, 1, "test"});
  auto m = c.morph(motion);
  ASSERT_EQ(c.inverted(m.x), 0);
  // An inner corner goes astray, and the nodes amid the edges around it follow it.
  auto const& rows = m.prepared.plan.middle;
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    Vec3 const p = mesh.coordinates[n];
    bool const inner = !m.prepared.graph.neighbours[n].empty() && norm(p - Vec3{3, 3, 3}) < 0.6;
    if (inner) m.x.set(n, m.x[n] + Vec3{1.3, 0.9, 0.4});
  }
  for (Index r = 0; r < rows.size(); ++r) {
    Index32 const n = rows.target[r];
    Vec3 u;
    double sum = 0;
    for (Index k = rows.first[r]; k < rows.first[r + 1]; ++k) {
      Index32 const item = rows.item[k];
      u += double(rows.weight[k]) * (m.x[item] - mesh.coordinates[item]);
      sum += double(rows.weight[k]);
    }
    ASSERT_NEAR(sum, 1, 1e-5);
    if (m.prepared.plan.middle_boundary.node.end() ==
        std::find(m.prepared.plan.middle_boundary.node.begin(), m.prepared.plan.middle_boundary.node.end(), n))
      m.x.set(n, mesh.coordinates[n] + u);
  }
  ASSERT_GT(c.inverted(m.x), 0);
  auto const report = relax_bad_elements(mesh, c.topology, m.prepared, m.x);
  EXPECT_EQ(report.inverted_after, 0);
  EXPECT_EQ(c.inverted(m.x), 0);
  EXPECT_TRUE(certify(Exec(), mesh, c.topology, {views(m.x), views(mesh.coordinates), {}, {}}).holds());
}

}  // namespace
}  // namespace gridmorph::test
