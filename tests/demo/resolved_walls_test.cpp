// Near fields that turn in passages whose blade and end walls are resolved: first cells of micrometres beside lines
// along the chord whose nodes are millimetres apart.
#include "support/morph_run.hpp"
#include "support/motions.hpp"

#include <generators/passage.hpp>
#include <generators/passage_geometry.hpp>
#include <generators/passage_motion.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

namespace gridmorph::test {
namespace {

constexpr double degree = std::numbers::pi / 180;

/// What a section does in its developed surface: turns about mid chord, stretches along the chord, shifts.
struct SectionMotion {
  double turn = 0, chord = 1, axial = 0, across = 0;
};
using BySpan = std::function<SectionMotion(double span)>;

struct ResolvedPassage {
  std::string name;
  PassageOptions options;
};

/// Grown as fast as it takes for few nodes: what matters is how thin the cells at the walls are.
ResolvedPassage resolved(std::string name, PassageOptions options) {
  options.nodes = 10'000;
  options.end_wall_first_cell = 2e-6;
  options.end_wall_max_growth = 10;
  options.first_cell = 2e-5;
  options.max_growth = 3;
  return {std::move(name), options};
}

std::vector<ResolvedPassage> passages() {
  PassageOptions curved, flat, twisted, turbine;
  flat.hub = {0.5, 0.5, 0, 0};
  flat.casing = {0.65, 0.65, 0, 0};
  flat.sections = {{{0.12, 30, 30, 0.07}, {0.12, 30, 30, 0.07}, {0.12, 30, 30, 0.07}}};
  twisted.sections = {{{0.115, 22, 0, 0.085}, {0.12, 40, 22, 0.07}, {0.125, 58, 46, 0.055}}};
  turbine.blades = 34;
  turbine.hub = {0.44, 0.44, 1, 0};
  turbine.casing = {0.60, 0.66, 1, 0};
  turbine.sections = {
      {{0.105, 25, -50, 0.14, 0.02, 0.008}, {0.11, 20, -48, 0.13, 0.02, 0.008}, {0.115, 12, -46, 0.12, 0.02, 0.008}}};
  return {resolved("flat", flat), resolved("curved", curved), resolved("twisted", twisted),
          resolved("turbine", turbine)};
}

std::vector<std::pair<std::string, BySpan>> motions() {
  return {{"rotation",
           [](double) {
             return SectionMotion{-10 * degree, 0.95};
           }},
          {"chord",
           [](double s) {
             return SectionMotion{0, chord_factor(chord_redesign(), s)};
           }},
          {"flutter",
           [](double s) {
             return SectionMotion{3 * degree * s * s, 1, 0, 0.02 * s * s};
           }},
          {"hot to cold", [](double s) {
             return SectionMotion{-4 * degree * s, 1.005, 0.003 * s, 0.006 * (s * s + 0.3 * s)};
           }}};
}

class Passage {
 public:
  explicit Passage(ResolvedPassage const& passage, bool single = false)
      : options_(passage.options), annulus_(options_), mesh_(make_passage(options_)) {
    if (!single) return;
    mesh_.coordinates = rounded(mesh_.coordinates);
    for (Zone& zone : mesh_.zones) zone.single_precision = true;
  }
  /// To single precision.
  static Coordinates rounded(Coordinates const& x) {
    Coordinates out(x.size());
    for (Index n = 0; n < x.size(); ++n) out.set(n, {float(x.x(n)), float(x.y(n)), float(x.z(n))});
    return out;
  }

  [[nodiscard]] Mesh const& mesh() const { return mesh_; }
  [[nodiscard]] Coordinates morphed(BySpan const& motion, PlanOptions const& plan) const {
    Motion m = test::motion({rule({"blade"}, function_rule([&](Vec3 const& p) { return displacement(motion, p); })),
                             rule({"inlet", "outlet"}, CircumferentialSlideRule{{"blade"}}),
                             rule({"type:periodic"}, FollowRule{{"blade"}}),
                             rule({"hub", "case"}, SlipRule{SlipRule::Surface::revolution})});
    m.axis = {{0, 0, 0}, {1, 0, 0}};
    return morph(mesh_, m, plan).morphed.position;
  }

  /// How far nodes of hub and case are off their walls.
  [[nodiscard]] double off_end_walls(Coordinates const& x) const {
    double largest = 0;
    for (Patch const& patch : mesh_.patches) {
      bool const hub = patch.families == std::vector<std::string>{"hub"},
                 casing = patch.families == std::vector<std::string>{"case"};
      if (!hub && !casing) continue;
      Zone const& zone = mesh_.zones[patch.zone];
      for (int k = patch.range.begin[2]; k < patch.range.end[2]; ++k)
        for (int j = patch.range.begin[1]; j < patch.range.end[1]; ++j)
          for (int i = patch.range.begin[0]; i < patch.range.end[0]; ++i) {
            Vec3 const p = x[zone.node({i, j, k})];
            largest =
                std::max(largest, std::abs(std::hypot(p.y, p.z) - (hub ? annulus_.hub(p.x) : annulus_.casing(p.x))));
          }
    }
    return largest;
  }

  /// How far nodes of the end walls move apart from those beside them, over their distance.
  [[nodiscard]] double shear_at_end_walls(Coordinates const& x) const {
    double largest = 0;
    for (Zone const& zone : mesh_.zones)
      for (int k = 0; k < zone.extent[2]; ++k)
        for (int i = 0; i < zone.extent[0]; ++i)
          for (auto const& [on, off] : {std::pair{0, 1}, std::pair{zone.extent[1] - 1, zone.extent[1] - 2}}) {
            Index const a = zone.node({i, on, k}), b = zone.node({i, off, k});
            Vec3 const before = mesh_.coordinates[b] - mesh_.coordinates[a];
            largest = std::max(largest, distance(x[b] - x[a], before) / norm(before));
          }
    return largest;
  }

  [[nodiscard]] Index inverted(Coordinates const& x) const {
    Index count = 0;
    for (Zone const& zone : mesh_.zones) {
      double const hand = corner_volume(zone, {0, 0, 0}, 0, mesh_.coordinates) < 0 ? -1 : 1;
      Index3 c{};
      for (c[2] = 0; c[2] + 1 < zone.extent[2]; ++c[2])
        for (c[1] = 0; c[1] + 1 < zone.extent[1]; ++c[1])
          for (c[0] = 0; c[0] + 1 < zone.extent[0]; ++c[0]) {
            bool sound = true;
            for (int k = 0; k < 8; ++k) sound = sound && hand * corner_volume(zone, c, k, x) > 0;
            count += sound ? 0 : 1;
          }
    }
    return count;
  }

  /// Largest changes over the nodes of the blade.
  struct WallChange {
    double angle_deg = 0;          ///< between wall and line, out of reach of the end walls
    double angle_in_band_deg = 0;  ///< within it
    double forced_deg = 0;         ///< of the angle between blade and end walls, which no mesh can avoid
    double height = 0;             ///< of first heights, relative
  };
  [[nodiscard]] WallChange change_at_wall(Coordinates const& x) const {
    WallChange change;
    auto const keep = [](double& largest, double value) { largest = std::max(largest, std::abs(value)); };
    for (Patch const& patch : mesh_.patches) {
      if (patch.name != "blade") continue;
      Zone const& zone = mesh_.zones[patch.zone];
      int const k = patch.range.begin[2], last = zone.extent[1] - 1;
      for (int j = 0; j <= last; ++j)
        for (int i = std::max(1, patch.range.begin[0]); i < std::min(patch.range.end[0], zone.extent[0] - 1); ++i) {
          Index3 const node{i, j, k};
          Vec3 const p = mesh_.coordinates[zone.node(node)];
          double const span = annulus_.span_fraction(p.x, std::hypot(p.y, p.z));
          Lean const before = lean(zone, node, mesh_.coordinates), after = lean(zone, node, x);
          bool const free = std::min(span, 1 - span) > band();
          keep(free ? change.angle_deg : change.angle_in_band_deg, after.angle_deg - before.angle_deg);
          keep(change.height, after.height / before.height - 1);
          if (j == 0 || j == last)
            keep(change.forced_deg,
                 corner_deg(x[zone.node(node)], after.normal, j > 0) - corner_deg(p, before.normal, j > 0));
        }
    }
    return change;
  }

 private:
  [[nodiscard]] Vec3 displacement(BySpan const& motion, Vec3 const& p) const {
    double const span = annulus_.span_fraction(p.x, std::hypot(p.y, p.z)), radius = annulus_.section_radius(span);
    passage::Point2 const flat{p.x, radius * std::atan2(p.z, p.y)};
    SectionMotion const by = motion(span);
    double const stagger = passage::Airfoil(options_, span).stagger();
    passage::Point2 const along = passage::direction(stagger), to = passage::direction(stagger + by.turn);
    double const u = by.chord * (flat.x * along.x + flat.y * along.y), v = flat.y * along.x - flat.x * along.y;
    passage::Point2 const moved{u * to.x - v * to.y + by.axial, u * to.y + v * to.x + by.across};
    return annulus_.unroll(moved, span, radius) - annulus_.unroll(flat, span, radius);
  }
  /// Two thicknesses of the near field in span, and what lines that lean have more.
  [[nodiscard]] double band() const {
    return 2.4 * options_.ring_thickness * options_.sections[1].chord / (annulus_.casing(0) - annulus_.hub(0));
  }
  /// Of the three edges that leave corner k of a cell, positive or negative alike for all corners.
  static double corner_volume(Zone const& zone, Index3 const& cell, int k, Coordinates const& x) {
    int const a = k & 1, b = k >> 1 & 1, c = k >> 2;
    auto const at = [&](int p, int q, int r) { return x[zone.node({cell[0] + p, cell[1] + q, cell[2] + r})]; };
    Vec3 const corner = at(a, b, c);
    return ((a + b + c) % 2 == 0 ? 1 : -1) *
           dot(cross(at(1 - a, b, c) - corner, at(a, 1 - b, c) - corner), at(a, b, 1 - c) - corner);
  }

  struct Lean {
    Vec3 normal;
    double angle_deg, height;
  };
  static Lean lean(Zone const& zone, Index3 const& node, Coordinates const& x) {
    auto const at = [&](int i, int j, int k) { return x[zone.node({node[0] + i, node[1] + j, node[2] + k})]; };
    int const down = node[1] > 0 ? -1 : 0, up = node[1] + 1 < zone.extent[1] ? 1 : 0;
    Vec3 const normal = cross(at(1, 0, 0) - at(-1, 0, 0), at(0, up, 0) - at(0, down, 0));
    Vec3 const line = at(0, 0, node[2] == 0 ? 1 : -1) - at(0, 0, 0);
    double const height = std::abs(dot(normal, line)) / norm(normal);
    return {normal, std::acos(std::min(1.0, height / norm(line))) / degree, height};
  }
  /// Between the blade's normal and that of the end wall at p.
  [[nodiscard]] double corner_deg(Vec3 const& p, Vec3 const& normal, bool at_case) const {
    auto const radius = [&](double axial) { return at_case ? annulus_.casing(axial) : annulus_.hub(axial); };
    constexpr double step = 1e-5;
    double const slope = (radius(p.x + step) - radius(p.x - step)) / (2 * step), r = std::hypot(p.y, p.z);
    Vec3 const end_wall{-slope, p.y / r, p.z / r};
    return std::acos(dot(normal, end_wall) / (norm(normal) * norm(end_wall))) / degree;
  }

  PassageOptions options_;
  passage::Annulus annulus_;
  Mesh mesh_;
};

TEST(ResolvedWalls, KeepAnglesAndHeightsOfNearFieldsThatTurn) {
  for (ResolvedPassage const& resolved : passages()) {
    Passage const passage(resolved);
    ASSERT_EQ(passage.inverted(passage.mesh().coordinates), 0) << resolved.name;
    for (auto const& [name, motion] : motions()) {
      SCOPED_TRACE(resolved.name + ", " + name);
      Coordinates const x = passage.morphed(motion, {});
      EXPECT_EQ(passage.inverted(x), 0);
      auto const change = passage.change_at_wall(x);
      EXPECT_LT(change.angle_deg, 0.01);
      EXPECT_LT(change.angle_in_band_deg, change.forced_deg + 0.5);
      EXPECT_LT(change.height, 1e-4);
    }
  }
}

// First cells of the end walls are three times what single precision resolves there.
TEST(ResolvedWalls, InSinglePrecisionAreSoundToo) {
  for (ResolvedPassage resolved : passages()) {
    resolved.options.end_wall_first_cell = 1e-6;
    Passage const passage(resolved, true);
    ASSERT_EQ(passage.inverted(passage.mesh().coordinates), 0) << resolved.name;
    for (auto const& [name, motion] : motions()) {
      SCOPED_TRACE(resolved.name + ", " + name);
      Coordinates const x = passage.morphed(motion, {}), written = Passage::rounded(x);
      EXPECT_EQ(passage.inverted(x), 0);
      EXPECT_EQ(passage.inverted(written), 0);
      EXPECT_LT(passage.change_at_wall(x).angle_deg, 0.1);
      EXPECT_LT(passage.shear_at_end_walls(x), 4) << "some roundings over the height of first cells";
      EXPECT_LT(passage.off_end_walls(written), 6e-7) << "ten times what single precision resolves there";
    }
  }
}

}  // namespace
}  // namespace gridmorph::test
