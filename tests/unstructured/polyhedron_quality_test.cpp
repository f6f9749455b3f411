// Polyhedra measured: one by one against known solids, as meshes against the same elements by their types, and faces
// against what is known of sheared and stepped boxes. The guard on them.
#include "quality/test_meshes.hpp"
#include "support/made_bodies.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/geometry/rigid_transform.hpp>
#include <gridmorph/kernels/polyhedron_quality.hpp>
#include <gridmorph/quality/unstructured_quality.hpp>
#include <gridmorph/quality/validity.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gridmorph::test {
namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;
using Input = UnstructuredQualityInput<Kokkos::HostSpace>;
using kernels::CellMeasures;

struct Solid {
  std::vector<Vec3> point;
  std::vector<std::vector<int>> face;

  [[nodiscard]] int n_faces() const { return int(face.size()); }
  [[nodiscard]] int n_corners(int f) const { return int(face[f].size()); }
  [[nodiscard]] Vec3 at(int f, int k) const { return point[face[f][k]]; }

  /// Adds the face through all points of a plane, in order around its outward normal.
  void add_face(Vec3 const& normal, double height) {
    std::vector<int> on;
    Vec3 middle;
    for (int p = 0; p < int(point.size()); ++p)
      if (std::abs(dot(point[p], normal) - height) < 1e-12) {
        on.push_back(p);
        middle += point[p];
      }
    middle = (1.0 / double(on.size())) * middle;
    Vec3 const u = point[on[0]] - middle, v = cross(normal, u);
    auto const angle = [&](int p) {
      Vec3 const d = point[p] - middle;
      return std::atan2(dot(d, v) / norm(v), dot(d, u) / norm(u));
    };
    std::sort(on.begin(), on.end(), [&](int a, int b) { return angle(a) < angle(b); });
    face.push_back(on);
  }
};

/// Eight hexagons and six squares; edges of sqrt(2), volume 32.
Solid truncated_octahedron() {
  Solid s;
  for (int zero = 0; zero < 3; ++zero)
    for (int longest = 1; longest <= 2; ++longest)
      for (int sign = 0; sign < 4; ++sign) {
        double x[3] = {0, 0, 0};
        int const a = (zero + 1) % 3, b = (zero + 2) % 3;
        x[a] = (sign & 1 ? -1 : 1) * (longest == 1 ? 2 : 1);
        x[b] = (sign & 2 ? -1 : 1) * (longest == 1 ? 1 : 2);
        s.point.push_back({x[0], x[1], x[2]});
      }
  for (int axis = 0; axis < 3; ++axis)
    for (double const side : {-1.0, 1.0}) {
      double n[3] = {0, 0, 0};
      n[axis] = side;
      s.add_face({n[0], n[1], n[2]}, 2);
    }
  for (int octant = 0; octant < 8; ++octant)
    s.add_face({octant & 1 ? -1.0 : 1.0, octant & 2 ? -1.0 : 1.0, octant & 4 ? -1.0 : 1.0}, 3);
  return s;
}

TEST(PolyhedronQuality, OfARegularSolid) {
  for (double const scale : {1e-6, 1.0, 1e5}) {
    Solid s = truncated_octahedron();
    for (Vec3& p : s.point) p = scale * p + Vec3{3, -2, 1};
    CellMeasures const m = kernels::polyhedron_measures(s, 1);
    double const tolerance = scale < 1 ? 1e-6 : 1e-12;
    EXPECT_NEAR(m.volume / (32 * scale * scale * scale), 1, tolerance);
    EXPECT_NEAR(m.determinant_3x3x3, 1, tolerance);
    EXPECT_NEAR(m.minimum_angle_deg, 90, 1e4 * tolerance);
    EXPECT_NEAR(m.equiangle_skewness, 0, 1e4 * tolerance);
    EXPECT_NEAR(m.aspect_ratio, 1, 100 * tolerance);
    EXPECT_FALSE(m.collapsed);
    EXPECT_EQ(kernels::polyhedron_sign(s, 1), kernels::JacobianSign::positive);
    EXPECT_EQ(kernels::polyhedron_sign(s, -1), kernels::JacobianSign::negative);
    Solid inside_out = s;
    for (auto& face : inside_out.face) std::reverse(face.begin(), face.end());
    EXPECT_NEAR(kernels::polyhedron_measures(inside_out, -1).determinant_3x3x3, m.determinant_3x3x3, 1e-15);
    EXPECT_NEAR(kernels::polyhedron_measures(inside_out, 1).determinant_3x3x3, -1, tolerance);
  }
}

TEST(PolyhedronQuality, TurnedAndStretched) {
  Solid const s = truncated_octahedron();
  Solid moved = s;
  Mat3 const turn = rotation_matrix((1 / std::sqrt(6.0)) * Vec3{1, 2, -1}, 1.1);
  for (Vec3& p : moved.point) p = turn * p;
  CellMeasures const a = kernels::polyhedron_measures(s, 1), b = kernels::polyhedron_measures(moved, 1);
  EXPECT_NEAR(a.volume, b.volume, 1e-12);
  EXPECT_NEAR(a.determinant_3x3x3, b.determinant_3x3x3, 1e-12);
  EXPECT_NEAR(a.minimum_angle_deg, b.minimum_angle_deg, 1e-9);
  // A turn by 1.1 about the origin, largest where points are farthest from the axis: |u_p - u_q| = |(R - I)(p - q)|.
  double largest = 0;
  for (std::size_t f = 0; f < s.face.size(); ++f)
    for (int k = 0; k < s.n_corners(int(f)); ++k) {
      Vec3 const e = s.at(int(f), (k + 1) % s.n_corners(int(f))) - s.at(int(f), k);
      largest = std::max(largest, norm(turn * e - e));
    }
  EXPECT_NEAR(kernels::polyhedron_relative_displacement(s, moved), largest / std::sqrt(2.0), 1e-12);
  for (Vec3& p : moved.point) p = {10 * p.x, 10 * p.y, 0.001 * p.z};
  EXPECT_GT(kernels::polyhedron_measures(moved, 1).determinant_3x3x3, 0);
}

TEST(PolyhedronQuality, APointPulledThroughTheOppositeFaceInverts) {
  Solid s = truncated_octahedron();
  s.point[0] = -3.0 * s.point[0];
  CellMeasures const m = kernels::polyhedron_measures(s, 1);
  EXPECT_LT(m.smallest_corner_jacobian, 0);
  EXPECT_LT(m.determinant_3x3x3, 0);
  EXPECT_EQ(kernels::polyhedron_sign(s, 1), kernels::JacobianSign::negative);
  s.point[0].x = std::nan("");
  EXPECT_EQ(kernels::polyhedron_measures(s, 1).minimum_angle_deg, 0);
  EXPECT_EQ(kernels::polyhedron_determinant(s, 1), -1);
  EXPECT_EQ(kernels::polyhedron_sign(s, 1), kernels::JacobianSign::negative);
}

TEST(PolyhedronQuality, ADentInAFaceIsMoreThanHalfATurn) {
  Solid prism;  // an arrow head: corners of 30, 300, 30 and 0 < 30 degrees
  double const h = std::tan(std::numbers::pi / 12);
  for (double const z : {0.0, 1.0})
    for (Vec3 const& p : {Vec3{-1, 0, 0}, Vec3{0, h, 0}, Vec3{1, 0, 0}, Vec3{0, 2, 0}})
      prism.point.push_back({p.x, p.y, z});
  prism.face = {{3, 2, 1, 0}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  for (auto& face : prism.face) std::reverse(face.begin(), face.end());
  CellMeasures m = kernels::polyhedron_measures(prism, 1);
  if (m.volume < 0) m = kernels::polyhedron_measures(prism, -1);
  EXPECT_NEAR(m.volume, 2 - h, 1e-12);
  EXPECT_EQ(m.equiangle_skewness, 1);  // 210 degrees against 90
}

/// The same elements, once by type and once by faces.
struct Twice {
  explicit Twice(Mesh m) : mesh(std::move(m)), polyhedra(as_polyhedra(mesh)) {
    topology = make_topology(mesh);
    of_polyhedra = make_topology(polyhedra);
  }
  [[nodiscard]] QualityReport measure(bool as_polyhedra, Input const& input) const {
    Mesh const& m = as_polyhedra ? polyhedra : mesh;
    auto const& t = as_polyhedra ? of_polyhedra : topology;
    return measure_quality(Exec(), m, t, find_face_patches(m, t), input);
  }
  Mesh mesh, polyhedra;
  UnstructuredTopology topology, of_polyhedra;
};

Coordinates moved_by(Mesh const& mesh, std::function<Vec3(Vec3 const&)> const& to) {
  Coordinates x(mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) x.set(n, to(mesh.coordinates[n]));
  return x;
}

TEST(PolyhedronQuality, OfPlaneFacedHexahedraIsThatOfHexahedra) {
  Twice const both(to_hexahedra(one_zone({6, 5, 4}, [](Index3 const& p) {
    return Vec3{0.3 * p[0] + 0.1 * p[1], 0.2 * p[1], 0.01 * p[2] * (1 + 0.3 * p[2])};
  })));
  auto const x = moved_by(both.mesh, [](Vec3 const& p) { return Vec3{p.x + 0.2 * p.y, p.y, 1.5 * p.z}; });
  Input input;
  input.coordinates = views(x);
  input.baseline = views(both.mesh.coordinates);
  input.faces = true;
  auto const a = both.measure(false, input).far_field, b = both.measure(true, input).far_field;
  EXPECT_EQ(a.cells, b.cells);
  EXPECT_EQ(b.inverted, 0);
  for (Measure const m : {Measure::volume, Measure::volume_ratio, Measure::aspect_ratio, Measure::minimum_angle_deg,
                          Measure::equiangle_skewness, Measure::non_orthogonality_deg, Measure::face_skewness}) {
    SCOPED_TRACE(to_string(m));
    EXPECT_NEAR(a[m].min, b[m].min, 1e-11 * (1 + a[m].min));
    EXPECT_NEAR(a[m].mean, b[m].mean, 1e-11 * (1 + a[m].mean));
    EXPECT_NEAR(a[m].max, b[m].max, 1e-11 * (1 + a[m].max));
  }
}

TEST(PolyhedronQuality, TheSameElementsAreInverted) {
  Twice const both(to_prisms_and_tetrahedra(unit_box({5, 5, 5}), 2));
  auto const x = moved_by(both.mesh, [](Vec3 const& p) {
    return p + Vec3{1.6 * std::sin(5 * p.y), 0, 1.9 * std::sin(3 * p.x) * std::sin(4 * p.z)};
  });
  Input input;
  input.coordinates = views(x);
  input.baseline = views(both.mesh.coordinates);
  auto const a = both.measure(false, input).far_field, b = both.measure(true, input).far_field;
  ASSERT_GT(a.inverted, 0);
  // Tetrahedra are inverted or not whatever they are taken for; prisms are looked at in other points.
  EXPECT_GT(b.newly_inverted, a.inverted / 2);
  EXPECT_LT(b.newly_inverted, 2 * a.inverted);
  auto const certificate = certify(Exec(), both.polyhedra, both.of_polyhedra, {views(x), input.baseline, {}, {}});
  EXPECT_EQ(certificate.broken.cells, b.newly_inverted);
  ValidityCheck<Exec> const check(Exec(), both.polyhedra, both.of_polyhedra);
  auto const valid = check(Exec(), ConstVectorView<Kokkos::HostSpace>(x.x, x.y, x.z));
  Kokkos::fence();
  EXPECT_EQ(valid().inverted, b.inverted);
  EXPECT_EQ(valid().smallest_determinant, b[Measure::determinant_3x3x3].min);
}

TEST(PolyhedronQuality, ConcaveElementsBesidePolyhedraAreWhatTheirPyramidsAre) {
  Mesh const hexahedra = to_hexahedra(unit_box({3, 3, 3})), mixed = with_joined_elements(hexahedra, 1);
  ASSERT_FALSE(mixed.polyhedra.element.empty());
  // A corner of the box whose element is a hexahedron, and goes inwards along its diagonal.
  Index element = -1;
  Vec3 corner, inwards;
  for (Index e = 0; e < mixed.n_elements() && element < 0; ++e) {
    if (mixed.elements.type[e] != ElementType::hexahedron) continue;
    Vec3 middle;
    for (Index32 const n : mixed.elements.corners(e)) middle += 0.125 * mixed.coordinates[n];
    Vec3 const out{middle.x < 1 ? -0.5 : 0.5, middle.y < 1 ? -0.5 : 0.5, middle.z < 1 ? -0.5 : 0.5}, at = middle + out;
    auto const is_end = [](double v) { return std::abs(v) < 1e-12 || std::abs(v - 3) < 1e-12; };
    if (!is_end(at.x) || !is_end(at.y) || !is_end(at.z)) continue;
    element = e;
    corner = at;
    inwards = -2.0 * out;
  }
  ASSERT_GE(element, 0);
  auto const dented = [&](Mesh const& mesh, double by) {
    return moved_by(mesh, [&](Vec3 const& p) { return distance(p, corner) < 1e-12 ? p + by * inwards : p; });
  };
  // Three faces of a unit cube stop to be convex there at a third of the diagonal; the pyramids lose their volume
  // beyond the opposite corner.
  struct {
    double by;
    Index of_types, of_faces;
  } const steps[] = {{0.3, 0, 0}, {0.37, 1, 0}, {0.6, 1, 0}, {1.2, 1, 1}};
  for (auto const& [by, of_types, of_faces] : steps)
    for (Mesh const* mesh : {&hexahedra, &mixed}) {
      SCOPED_TRACE(by);
      auto const topology = make_topology(*mesh);
      auto const x = dented(*mesh, by), before = dented(*mesh, 0.2);
      Index const expected = mesh == &mixed ? of_faces : of_types;
      Input input;
      input.coordinates = views(x);
      input.baseline = views(before);
      auto const report = measure_quality(Exec(), *mesh, topology, find_face_patches(*mesh, topology), input).far_field;
      EXPECT_EQ(report.inverted, expected);
      EXPECT_EQ(report.newly_inverted, expected);
      EXPECT_EQ(certify(Exec(), *mesh, topology, {views(x), views(before), {}, {}}).broken.cells, expected);
      ValidityCheck<Exec> const check(Exec(), *mesh, topology);
      auto const valid = check(Exec(), ConstVectorView<Kokkos::HostSpace>(x.x, x.y, x.z));
      Kokkos::fence();
      EXPECT_EQ(valid().inverted, expected);
    }
}

TEST(FaceQuality, OfAShearedBoxIsItsShear) {
  // Lattice cells have their centres in line: no skewness inside, and angles of the shear between lines and faces.
  Mesh const mesh = to_hexahedra(one_zone({6, 6, 6}, [](Index3 const& p) {
    return Vec3{p[0] + 0.5 * p[1], double(p[1]), double(p[2])};
  }));
  auto const topology = make_topology(mesh);
  Input input;
  input.coordinates = views(mesh.coordinates);
  input.faces = true;
  auto const r = measure_quality(Exec(), mesh, topology, find_face_patches(mesh, topology), input).far_field;
  double const shear = std::atan(0.5) * 180 / std::numbers::pi;
  EXPECT_NEAR(r[Measure::non_orthogonality_deg].min, shear, 1e-10);
  EXPECT_NEAR(r[Measure::non_orthogonality_deg].max, shear, 1e-10);
  // On the boundary the line goes straight: it misses the middle of the face by half a step of the shear, 0.25, where
  // the face reaches 0.5.
  EXPECT_NEAR(r[Measure::face_skewness].max, 0.5, 1e-10);
  EXPECT_NEAR(r[Measure::face_skewness].min, 0, 1e-10);
}

TEST(FaceQuality, OfATrapezoidMeetsThePlainFormula) {
  // Two quadrilaterals side by side in 2-D, one of them a trapezoid.
  Mesh const mesh = flat_box(2, 1, 1);
  ASSERT_EQ(mesh.dimension, 2);
  Coordinates x(mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    Vec3 const p = mesh.coordinates[n];
    x.set(n, {p.x, p.y * (1 + p.x), p.z});
  }
  auto const topology = make_topology(mesh);
  Input input;
  input.coordinates = views(x);
  input.faces = true;
  auto const found =
      cell_fields(Exec(), mesh, topology, input, std::array{Measure::non_orthogonality_deg, Measure::face_skewness});
  auto const polygon = [&](Index e) {
    std::vector<Vec3> corners;
    for (Index32 const n : mesh.elements.corners(e)) corners.push_back(x[n]);
    return corners;
  };
  auto const centroid = [&](Index e) {  // the shoelace formula
    auto const c = polygon(e);
    double area = 0;
    Vec3 sum;
    for (std::size_t k = 0; k < c.size(); ++k) {
      Vec3 const &p = c[k], &q = c[(k + 1) % c.size()];
      double const w = p.x * q.y - q.x * p.y;
      area += w;
      sum += w * (p + q);
    }
    return (1 / (3 * area)) * sum;
  };
  for (Index e = 0; e < mesh.n_elements(); ++e) {
    auto const c = polygon(e);
    auto const neighbours = topology.sides.of(e);
    double angle = 0, skewness = 0;
    for (std::size_t k = 0; k < c.size(); ++k) {
      Vec3 const &p = c[k], &q = c[(k + 1) % c.size()];
      Vec3 const f = 0.5 * (p + q), s{q.y - p.y, p.x - q.x, 0}, own = centroid(e);
      bool const inside = neighbours[k] >= 0;
      Vec3 const d = inside ? centroid(neighbours[k]) - own : (dot(f - own, s) / dot(s, s)) * s;
      Vec3 const miss = (f - own) - (dot(s, f - own) / dot(s, d)) * d;
      if (inside) angle = std::max(angle, std::acos(dot(s, d) / norm(s) / norm(d)) * 180 / std::numbers::pi);
      if (norm(miss) < 1e-12) continue;
      double const reach = std::max((inside ? 0.2 : 0.4) * norm(d), std::abs(dot(miss, p - f)) / norm(miss));
      skewness = std::max(skewness, norm(miss) / reach);
    }
    EXPECT_NEAR(found[0](std::size_t(e)), angle, 1e-10);
    EXPECT_NEAR(found[1](std::size_t(e)), skewness, 1e-10);
  }
}

std::vector<double> faces_of(Mesh const& mesh, Coordinates const& x, Measure measure) {
  Input input;
  input.coordinates = views(x);
  auto const field = cell_fields(Exec(), mesh, make_topology(mesh), input, std::array{measure})[0];
  return {field.data(), field.data() + field.extent(0)};
}

constexpr int per_period = 4, n_periods = 3;

/// A disturbed sector of a ring or length of a channel, `periods` of them one after the other along k.
Mesh periods(int periods, RigidTransform const& to_next) {
  std::vector<RigidTransform> to(1, RigidTransform{});
  for (int p = 0; p < periods; ++p) to.push_back(to.back().then(to_next));
  return one_zone({5, 4, periods * per_period + 1}, [&](Index3 const& p) {
    double const share = double(p[2] % per_period) / per_period, i = p[0], j = p[1];
    Vec3 const here{0.1 * i + 0.01 * std::sin(7 * share + 5 * j), 1 + 0.2 * j + 0.02 * std::cos(3 * i + 4 * share),
                    0.03 * std::sin(2 * i + 3 * j)};
    Vec3 const next = to_next(here);
    Vec3 const within = to_next.rotation.m[1][1] < 1
                            ? rotation_about({0, 0, 0}, {1, 0, 0}, share * std::numbers::pi / 6)(here)
                            : here + share * (next - here);
    return to[p[2] / per_period](within);
  });
}

/// One of them, its sides paired; `from_donors`: the connection starts at the far one.
void close_around(Mesh& mesh, RigidTransform const& to_next, bool from_donors) {
  Connection c;
  c.name = "sides";
  c.zone = c.donor_zone = 0;
  c.periodic = Periodic{};
  c.periodic->declared = from_donors ? to_next.inverse() : to_next;
  Index const layer = mesh.n_nodes() / (per_period + 1);
  for (Index n = 0; n < layer; ++n) {
    c.nodes.push_back(Index32(n));
    c.donor_nodes.push_back(Index32(per_period * layer + n));
  }
  if (from_donors) std::swap(c.nodes, c.donor_nodes);
  mesh.connections.push_back(std::move(c));
}

TEST(FaceQuality, BehindPeriodicSidesIsTheNextPeriod) {
  RigidTransform const along{Mat3{}, {0.03, 0.02, 0.7}},
      around = rotation_about({0, 0, 0}, {1, 0, 0}, std::numbers::pi / 6);
  for (auto const& to_next : {along, around})
    for (bool const from_donors : {false, true})
      for (int const form : {0, 1, 2}) {
        SCOPED_TRACE(form);
        auto const of_form = [&](Mesh const& blocks) {
          Mesh const elements = form == 1 ? to_prisms_and_tetrahedra(blocks, 0) : to_hexahedra(blocks);
          return form == 2 ? as_polyhedra(elements) : elements;
        };
        Mesh const many = of_form(periods(n_periods, to_next));
        Mesh one = of_form(periods(1, to_next));
        Index const n = one.n_elements();
        ASSERT_EQ(many.n_elements(), n_periods * n);
        auto const open = faces_of(one, one.coordinates, Measure::non_orthogonality_deg);
        close_around(one, to_next, from_donors);
        for (Measure const measure : {Measure::non_orthogonality_deg, Measure::face_skewness}) {
          auto const all = faces_of(many, many.coordinates, measure), found = faces_of(one, one.coordinates, measure);
          for (Index e = 0; e < n; ++e) ASSERT_NEAR(found[e], all[n + e], 1e-9) << e;
          // Wherever the mesh as a whole has gone.
          auto const shifted = faces_of(one, moved_by(one, [](Vec3 const& p) { return p + Vec3{1, -2, 3}; }), measure);
          for (Index e = 0; e < n; ++e) ASSERT_NEAR(found[e], shifted[e], 1e-9) << e;
        }
        EXPECT_NE(open, faces_of(one, one.coordinates, Measure::non_orthogonality_deg));
      }
}

TEST(FaceQuality, OfTwoZonesIsThatOfOne) {
  Mesh const zones = to_hexahedra(two_zones({}, true));
  Mesh const whole = to_hexahedra(one_zone({9, 6, 5}, [](Index3 const& p) {
    return wavy({0.1 * p[0] * (1 + 0.15 * p[0]), 0.2 * p[1], 0.15 * p[2] * (1 + 0.1 * p[2])}, 0.04);
  }));
  for (Measure const measure : {Measure::non_orthogonality_deg, Measure::face_skewness}) {
    auto const parts = faces_of(zones, zones.coordinates, measure), all = faces_of(whole, whole.coordinates, measure);
    ASSERT_EQ(parts.size(), all.size());
    for (std::size_t e = 0; e < all.size(); ++e) {
      int const i = int(e % 8), row = int(e / 8);  // the first three of each row are the first zone's
      std::size_t const there = i < 3 ? std::size_t(3 * row + i) : std::size_t(3 * 20 + 5 * row + (i - 3));
      EXPECT_NEAR(parts[there], all[e], 1e-10) << e;
    }
  }
}

}  // namespace
}  // namespace gridmorph::test
