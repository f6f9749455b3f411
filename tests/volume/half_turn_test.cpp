// Bodies that turn by about half a turn and are deformed besides, so that some of their nodes turn by less and some by
// more.
#include "support/mesh_builders.hpp"
#include "support/morph_run.hpp"
#include "support/motions.hpp"
#include "support/transpose_check.hpp"

#include <gridmorph/boundary/find_interfaces.hpp>
#include <gridmorph/core/built_for.hpp>
#include <gridmorph/geometry/rigid_transform.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace gridmorph::test {
namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;

constexpr double least_shape = 0.25;  ///< scaled Jacobian
constexpr int cells_of_edge = 12, cells_off_wing = 20;

/// A tapered wing in a ball, six zones round it: the faces of a cube, blown up to confocal ellipsoids from the wing's
/// on. mirror: 1, or -1 for its image in the plane x = 0.
Mesh wing_in_ball(double mirror = 1) {
  constexpr std::array<double, 3> half_axis{0.5, 0.15, 1.5};
  MeshBuilder b("wing in a ball");
  for (int face = 0; face < 6; ++face) {
    int const axis = face / 2, side = face % 2 == 0 ? -1 : 1;
    auto const position = [=](Index3 const& p) {
      std::array<double, 3> q{};
      auto const along = [](int k) { return std::tan(std::numbers::pi / 4 * (2.0 * k / cells_of_edge - 1)); };
      q[axis] = side;
      q[(axis + 1) % 3] = along(p[0]);
      q[(axis + 2) % 3] = along(p[2]);
      double const size = std::hypot(q[0], q[1], q[2]), growth = 1.4;
      double const h = 60 * (std::pow(growth, p[1]) - 1) / (std::pow(growth, cells_off_wing) - 1);
      double const lambda = h * (h + 2 * half_axis[1]);
      for (std::size_t d = 0; d < 3; ++d) q[d] *= std::sqrt(half_axis[d] * half_axis[d] + lambda) / size;
      double const taper = 1 - 0.25 * q[2] / (half_axis[2] + h);
      return Vec3{mirror * (taper * q[0] + 0.05 * q[2] / (1 + h)), taper * q[1], q[2]};
    };
    int const zone =
        b.zone("zone " + std::to_string(face), {cells_of_edge + 1, cells_off_wing + 1, cells_of_edge + 1}, position);
    b.patch("wing", PatchKind::wall, zone, 1, 0);
    b.patch("far", PatchKind::farfield, zone, 1, 1);
  }
  Mesh mesh = b.finish();
  mesh.interfaces = find_interfaces(mesh).interfaces;
  return mesh;
}

/// Turns the wing about a skew axis, after its span has become 5 % less.
VectorField turned_and_shorter(double degrees, double mirror = 1) {
  Vec3 const axis{0.3 * mirror, 0.5, 0.8};
  RigidTransform const turn =
      rotation_about({0.05 * mirror, 0.02, -0.1}, (1 / norm(axis)) * axis, mirror * degrees * std::numbers::pi / 180);
  return [=](Vec3 const& p) { return turn({p.x, p.y, 0.95 * p.z}) - p; };
}

PreparedMorph prepared(Mesh const& mesh, VectorField const& of_wing) {
  return prepare(mesh, motion({rule({"wing"}, function_rule(of_wing)), rule({"far"}, FixedRule{})}), {});
}

struct Corners {
  double smallest = 1;  ///< scaled Jacobian at a corner
  Index inverted = 0;   ///< corners
};
Corners corners_of(Mesh const& mesh, Coordinates const& x) {
  Corners out;
  for (Zone const& zone : mesh.zones) {
    auto const corner = [&](Coordinates const& at, Index3 const& p, Index3 const& to) {
      Vec3 edge[3];
      for (int d = 0; d < 3; ++d) {
        Index3 other = p;
        other[d] = to[d];
        edge[d] = at[zone.node(other)] - at[zone.node(p)];
      }
      return dot(cross(edge[0], edge[1]), edge[2]) / (norm(edge[0]) * norm(edge[1]) * norm(edge[2]));
    };
    for (int k = 0; k + 1 < zone.extent[2]; ++k)
      for (int j = 0; j + 1 < zone.extent[1]; ++j)
        for (int i = 0; i + 1 < zone.extent[0]; ++i)
          for (int c = 0; c < 8; ++c) {
            Index3 const p{i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)},
                to{i + 1 - (c & 1), j + 1 - (c >> 1 & 1), k + 1 - (c >> 2)};
            double const sign = corner(mesh.coordinates, p, to) < 0 ? -1 : 1, scaled = sign * corner(x, p, to);
            out.smallest = std::min(out.smallest, scaled);
            if (!(scaled > 0)) ++out.inverted;
          }
  }
  return out;
}
Coordinates moved(PreparedMorph const& plan) {
  return run_plan(Exec(), plan.mesh, plan.plan(), plan.boundary_displacement()).position;
}
Corners corners_after(Mesh const& mesh, VectorField const& of_wing) {
  return corners_of(mesh, moved(prepared(mesh, of_wing)));
}

constexpr std::array<double, 12> angles{60, 90, 120, 150, 170, 178, 179.9, 180, 180.1, 182, 190, 210};

TEST(HalfTurn, LeavesAWingSoundThatIsShorterBesides) {
  for (double const mirror : {1.0, -1.0}) {
    Mesh const mesh = wing_in_ball(mirror);
    for (double const way : {1.0, -1.0}) {
      double below = 0;
      for (double const degrees : angles) {
        Corners const found = corners_after(mesh, turned_and_shorter(way * degrees, mirror));
        EXPECT_EQ(found.inverted, 0) << degrees << " " << way << " " << mirror;
        EXPECT_GT(found.smallest, least_shape) << degrees << " " << way << " " << mirror;
        if (degrees == 179.9) below = found.smallest;
        if (degrees != 180.1) continue;
        EXPECT_NEAR(found.smallest, below, 0.1 * below) << way << " " << mirror;
      }
    }
  }
}

TEST(HalfTurn, OfTheMirrorImageIsTheMirrorImage) {
  Mesh const mesh = wing_in_ball(), image = wing_in_ball(-1);
  for (double const degrees : {170.0, 179.9, 182.0}) {
    PreparedMorph const one = prepared(mesh, turned_and_shorter(degrees)),
                        other = prepared(image, turned_and_shorter(degrees, -1));
    Coordinates const x = moved(one), y = moved(other);
    double worst = 0;
    for (Index n = 0; n < x.size(); ++n) worst = std::max(worst, distance(x[n], {-y[n].x, y[n].y, y[n].z}));
    EXPECT_LT(worst, 1e-9) << degrees;
  }
}

/// An O-grid round an ellipse, between two planes that its lines stand on and slip along.
Mesh section_between_planes() {
  Bricks b;
  b.name = "section";
  b.extent = {33, 17, 6};
  b.position = [](Vec3 const& q) {
    double const angle = 2 * std::numbers::pi * q.x, far = (std::pow(1.4, 16 * q.y) - 1) / (std::pow(1.4, 16) - 1);
    return Vec3{((1 - far) + 60 * far) * std::cos(angle), (0.3 * (1 - far) + 60 * far) * std::sin(angle),
                2 * q.z + 0.1 * std::sin(2 * std::numbers::pi * q.z) * (1 - far)};
  };
  b.ends[0].kind = Ends::Kind::closed;
  b.family = {"", "", "body", "far", "root", "tip"};
  b.kind = {PatchKind::other,    PatchKind::other,    PatchKind::wall,
            PatchKind::farfield, PatchKind::symmetry, PatchKind::symmetry};
  return make(b);
}
/// Turned, twisted by two degrees to either side of that, and bent away from the planes' normals.
VectorField turned_and_twisted(double degrees) {
  return [=](Vec3 const& p) {
    double const angle = (degrees + 2 * (p.z - 1)) * std::numbers::pi / 180;
    Vec3 const bent{0.95 * p.x + 0.05 * p.z * p.z, p.y - 0.04 * p.z, p.z};
    return rotation_about({0.1, 0.2, 0}, {0, 0, 1}, angle)(bent) - p;
  };
}
PreparedMorph prepared_section(double degrees) {
  return prepare(section_between_planes(),
                 motion({rule({"body"}, function_rule(turned_and_twisted(degrees))), rule({"far"}, FixedRule{}),
                         rule({"root", "tip"}, SlipRule{})}),
                 {});
}

TEST(HalfTurn, LeavesASectionSoundThatSlipsAlongPlanes) {
  for (double const degrees : angles)
    for (double const way : {1.0, -1.0}) {
      PreparedMorph const plan = prepared_section(way * degrees);
      Corners const found = corners_of(plan.mesh, moved(plan));
      EXPECT_EQ(found.inverted, 0) << degrees << " " << way;
      EXPECT_GT(found.smallest, least_shape) << degrees << " " << way;
    }
}

/// Largest difference between the rates of nodes and differences of their displacements, over the largest rate.
double rate_error(PreparedMorph const& plan, LinearisedMorph<Exec> const& at) {
  Coordinates rate = random_vectors(5, at.boundary.size());
  for (Index k = 0; k < rate.size(); ++k)
    rate.set(k, {rate[k].x, rate[k].y, 0});  // along the planes that nodes slip on
  Coordinates const v = at.forwards(rate);
  std::vector<Vec3> const given = plan.boundary_displacement();
  double const h = 1e-7;
  auto const after = [&](double step) {
    std::vector<Vec3> boundary = given;
    for (std::size_t k = 0; k < boundary.size(); ++k) boundary[k] += step * rate[Index(k)];
    return run_plan(Exec(), plan.mesh, plan.plan(), boundary).displacement;
  };
  Coordinates const ahead = after(h), behind = after(-h);
  double worst = 0, largest = 0;
  for (Index n = 0; n < v.size(); ++n) {
    worst = std::max(worst, distance(v[n], (0.5 / h) * (ahead[n] - behind[n])));
    largest = std::max(largest, norm(v[n]));
  }
  return worst / largest;
}

TEST(HalfTurn, HasExactRatesAndTransposes) {
  Mesh const mesh = wing_in_ball();
  for (double const degrees : {160.0, 179.5, 181.0, 200.0})
    for (bool const section : {false, true}) {
      PreparedMorph const plan = section ? prepared_section(degrees) : prepared(mesh, turned_and_shorter(degrees));
      LinearisedMorph<Exec> const at{plan.plan(), plan.mesh.coordinates, plan.boundary_displacement()};
      EXPECT_LE(product_error(at), 1e-13) << degrees << " " << section;
      EXPECT_LE(rate_error(plan, at), 1e-5) << degrees << " " << section;
    }
}

#ifdef GRIDMORPH_WITH_SERIAL
TEST(HalfTurn, HasOneMeanWhateverTheThreads) {
  Mesh const mesh = wing_in_ball();
  PreparedMorph const plan = prepared(mesh, turned_and_shorter(180));
  std::vector<Vec3> const boundary = plan.boundary_displacement();
  Coordinates const reference = run_plan(Kokkos::Serial(), plan.mesh, plan.plan(), boundary).position;
  EXPECT_EQ(different_bits(run_plan(Exec(), plan.mesh, plan.plan(), boundary).position, reference), 0);
}
#endif

}  // namespace
}  // namespace gridmorph::test
