// Wings whose tip has no face of its own: it is a point that a pole leaves from, or a line, beyond which the mesh meets
// itself.
#include "support/mesh_builders.hpp"
#include "support/morph_run.hpp"
#include "support/motions.hpp"

#include <gridmorph/geometry/rigid_transform.hpp>
#include <gridmorph/quality/quality.hpp>
#include <gridmorph/quality/validity.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ostream>
#include <string>

namespace gridmorph::test {
namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;
using Mode = BoundaryLayer::Mode;

constexpr double span = 4, chord = 1, thickness = 0.15;
constexpr int around = 48, away = 16, layers = 5;

/// From the wall out to a radius of 20: cells grow by 1.35.
Vec3 between(Vec3 const& wall, Vec3 const& far, int j) {
  double const f = (std::pow(1.35, j) - 1) / (std::pow(1.35, away) - 1);
  return wall + f * (far - wall);
}

/// Half an ellipsoid in half a ball, lines of longitude and latitude: those of longitude meet in the tip, and on the
/// pole beyond it.
Mesh pointed() {
  constexpr int along = 16;
  Bricks b;
  b.name = "pointed";
  b.extent = {around + 1, away + 1, along + 1};
  b.position = [](Vec3 const& q) {
    double const angle = 2 * std::numbers::pi * q.x, rise = std::numbers::pi / 2 * q.z;
    double const c = q.z == 1 ? 0 : std::cos(rise), s = q.z == 1 ? 1 : std::sin(rise);
    Vec3 const wall{chord / 2 * c * std::cos(angle), thickness / 2 * c * std::sin(angle), span * s};
    Vec3 const far{20 * c * std::cos(angle), 20 * c * std::sin(angle), 20 * s};
    return between(wall, far, int(std::lround(q.y * away)));
  };
  b.ends[0].kind = Ends::Kind::closed;
  b.family = {"", "", "wing", "far", "root", "pole"};
  b.kind = {PatchKind::other,    PatchKind::other,    PatchKind::wall,
            PatchKind::farfield, PatchKind::symmetry, PatchKind::degenerate};
  return make(b);
}

/// An ellipse for a section, thinner and thinner until its two sides meet in a line along the chord; the O-grid goes on
/// beyond the tip round that line, on which it is joined to itself.
Mesh flat() {
  constexpr int to_tip = 12, beyond = 8;
  Index3 const n{around + 1, away + 1, to_tip + beyond + 1};
  auto const position = [](Index3 const& p) {
    double const angle = 2 * std::numbers::pi * (p[0] % around) / around, q = double(p[2]) / to_tip;
    double const z =
        p[2] <= to_tip ? span * q * (1.5 - 0.5 * q) : span * (1 + 0.05 * (std::pow(1.6, p[2] - to_tip) - 1));
    double const half = p[2] < to_tip ? thickness / 2 * std::sqrt(1 - q * q) : 0;
    double const x = p[0] == around / 2 ? -1 : std::cos(angle), y = p[0] % (around / 2) == 0 ? 0 : std::sin(angle);
    // The same number for both sides of the line.
    double const c = p[0] <= around / 2 ? x : std::cos(2 * std::numbers::pi * (around - p[0]) / around);
    Vec3 const wall{chord / 2 * (half == 0 ? c : x), half * y, z};
    return between(wall, {20 * x, 20 * y, z}, p[1]);
  };
  MeshBuilder b("flat");
  int const zone = b.zone("flat", n, position);
  b.join(zone, {{0, 0, 0}, {1, n[1], n[2]}}, zone, {{around, 0, 0}, {n[0], n[1], n[2]}});
  b.join(zone, {{0, 0, to_tip}, {around / 2 + 1, 1, n[2]}}, zone, {{around / 2, 0, to_tip}, {n[0], 1, n[2]}},
         {{0, 1, 2}, {-1, 1, 1}});
  b.patch("wing", PatchKind::wall, zone, {{0, 0, 0}, {n[0], 1, to_tip + 1}});
  b.patch("far", PatchKind::farfield, zone, 1, 1);
  b.patch("root", PatchKind::symmetry, zone, 2, 0);
  b.patch("beyond", PatchKind::farfield, zone, 2, 1);
  return b.finish();
}

struct Tip {
  std::string name;
  Mesh (*mesh)();
  int last;  ///< node of the tip along the span
  bool pole;
  std::vector<std::string> rest;

  friend std::ostream& operator<<(std::ostream& out, Tip const& t) { return out << t.name; }
};

struct Found {
  Outcome run;
  Index inverted;
  double determinant;  ///< smallest 3x3x3
  double leaned;       ///< largest change of the angle between line and normal, degrees, over walls short of the tip
  double tip_leaned;   ///< the same in the last row before the tip
};

class CollapsedTip : public testing::TestWithParam<Tip> {
 protected:
  static Outcome morphed(Mesh const& mesh, VectorField const& field, Mode mode, std::optional<double> turn = {}) {
    PlanOptions options;
    options.boundary_layers = {{{"wing"}, BoundaryLayer::Extent::layers, layers, 0, mode}};
    options.volume.turn = turn;
    std::vector<std::string> free{"root"};
    for (std::string const& more : GetParam().rest) free.push_back(more);
    return morph(mesh,
                 motion({rule({"wing"}, function_rule(field)), rule({"far"}, FixedRule{}), rule(free, FreeRule{})}),
                 options);
  }

  static double angle(Mesh const& mesh, Coordinates const& x, int i, int k) {
    Zone const& zone = mesh.zones[0];
    auto const at = [&](int di, int j, int dk) { return x[zone.node({(i + di + around) % around, j, k + dk})]; };
    Vec3 const normal = cross(at(1, 0, 0) - at(-1, 0, 0), at(0, 0, 1) - at(0, 0, -1)), line = at(0, 1, 0) - at(0, 0, 0);
    return std::acos(std::min(1.0, std::abs(dot(normal, line)) / (norm(normal) * norm(line)))) * 180 / std::numbers::pi;
  }

  static Found found(Outcome run) {
    Found out{std::move(run), 0, 1, 0, 0};
    Mesh const& mesh = out.run.mesh;
    QualityInput<Kokkos::HostSpace> input;
    input.coordinates = views(out.run.morphed.position);
    input.baseline = views(mesh.coordinates);
    QualityReport const quality = measure_quality(Exec(), mesh, input);
    out.inverted = std::max(quality.far_field.newly_inverted + quality.near_field.newly_inverted,
                            certify(Exec(), mesh, {input.coordinates, input.baseline}).broken.cells);
    for (auto const* region : {&quality.near_field, &quality.far_field})
      if (region->cells > 0) out.determinant = std::min(out.determinant, (*region)[Measure::determinant_3x3x3].min);
    for (int k = 1; k < GetParam().last; ++k)
      for (int i = 0; i < around; ++i) {
        double const change =
            std::abs(angle(mesh, out.run.morphed.position, i, k) - angle(mesh, mesh.coordinates, i, k));
        double& largest = k + 1 < GetParam().last ? out.leaned : out.tip_leaned;
        largest = std::max(largest, change);
      }
    return out;
  }
};

// Rows of the wall that have no area, at the tip, turn as those beside them do.
TEST_P(CollapsedTip, IsRigidRoundABodyThatTurns) {
  Mesh const mesh = GetParam().mesh();
  RigidTransform const turn = rotation_about({0.2, 0.1, 0.3}, {0.3, -0.2, 1}, 0.5);
  Outcome const r = morphed(
      mesh, [&](Vec3 const& p) { return turn(p) - p; }, Mode::rotate, 1.0);
  Zone const& zone = r.mesh.zones[0];
  for (int k = 0; k <= GetParam().last; ++k)
    for (int j = 0; j <= layers; ++j)
      for (int i = 0; i <= around; ++i) {
        Vec3 const x = r.mesh.coordinates[zone.node({i, j, k})];
        double const arm = distance(x, r.mesh.coordinates[zone.node({i, 0, k})]);
        // The pole goes straight from the tip to the far boundary, and the lines beside it lean with it.
        double const allowed = !GetParam().pole ? 1e-11 : k < GetParam().last ? 0.05 * arm : 0.25 * arm;
        ASSERT_LE(distance(r.morphed.position[zone.node({i, j, k})], turn(x)), allowed + 1e-11)
            << i << " " << j << " " << k;
      }
}

TEST_P(CollapsedTip, KeepsItsLinesWhereTheWingBendsAndTwists) {
  Mesh const mesh = GetParam().mesh();
  struct Motions {
    char const* name;
    VectorField field;
  };
  auto const bend = [](Vec3 const& p) { return Vec3{0, 0.1 * span * (p.z / span) * (p.z / span), 0}; };
  auto const twist = [](Vec3 const& p) {
    double const a = 10 * std::numbers::pi / 180 * p.z / span;
    return Vec3{p.x * (std::cos(a) - 1) - p.y * std::sin(a), p.x * std::sin(a) + p.y * (std::cos(a) - 1), 0};
  };
  for (auto const& [name, field] : {Motions{"bend", bend}, Motions{"twist", twist}}) {
    Found const translated = found(morphed(mesh, field, Mode::translate)),
                turned = found(morphed(mesh, field, Mode::rotate));
    EXPECT_LE(turned.inverted, translated.inverted) << name;
    EXPECT_LT(turned.leaned, 0.4 * translated.leaned) << name;
    EXPECT_LT(turned.tip_leaned, 0.4 * translated.tip_leaned) << name;
    if (!GetParam().pole) continue;  // cells at the ends of the line are flat in the baseline
    EXPECT_EQ(turned.inverted, 0) << name;
    EXPECT_GT(turned.determinant, 0.5 * translated.determinant) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Tips, CollapsedTip,
                         testing::Values(Tip{"point", pointed, 16, true, {"pole"}},
                                         Tip{"line", flat, 12, false, {"beyond"}}),
                         [](auto const& info) { return info.param.name; });

}  // namespace
}  // namespace gridmorph::test
