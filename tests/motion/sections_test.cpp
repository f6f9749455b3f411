// The sections rule on wings and blades made from formulas. The oracle builds the redesigned section anew from the same
// formulas: nothing of what the rule finds on the surface enters it.
#include "annulus.hpp"
#include "impeller.hpp"
#include "moved_nodes.hpp"
#include "support/expect_error.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/motion/boundary_motion.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gridmorph {
namespace {

using namespace test;
using test::expect_all_in;
using test::message_of;
using test::motion_on;

constexpr double pi = std::numbers::pi;

// ---------------------------------------------------------------------------------------------- sections as formulas

/// Half thickness over chord as a function of the chord angle phi, chord fraction (1 - cos phi) / 2.
enum class Shape { lens, round_nose, blunt_base };

struct Planform {
  Shape shape = Shape::lens;
  double camber = 0.05;  ///< of the parabolic camber line, in chords

  [[nodiscard]] double half_thickness(double phi) const {
    double const c = 0.5 * (1 - std::cos(phi));
    switch (shape) {
      case Shape::lens: return 0.2 * c * (1 - c);
      case Shape::round_nose: return 0.12 * std::sin(0.5 * phi) * (1 - c);
      case Shape::blunt_base: return 0.2 * c * (1 - c) + 0.01 * c;
    }
    return 0;
  }
  [[nodiscard]] double camber_line(double c) const { return 4 * camber * c * (1 - c); }
};

// Leading edge, chord and stagger angle along the span.
double edge_s(double h) { return -0.2 + 0.2 * h; }
double edge_t(double h) { return -0.1 + 0.15 * h; }
double chord_of(double h) { return 0.6 - 0.2 * h; }
double stagger_of(double h) { return 0.3 + 0.3 * h; }

struct Flat {
  double s, t;
};

/// What a rule whose parameters are linear in span makes of a point of the section.
Flat section_point(Planform const& plan, double phi, bool upper, double h, SectionsRule const& r = {}) {
  double const c = 0.5 * (1 - std::cos(phi)), length = chord_of(h);
  double const half = (upper ? 1 : -1) * plan.half_thickness(phi) * (1 + r.thickness.at(h));
  double const size = 1 + r.scale.at(h);
  double x = (c - r.pivot) * (1 + r.chord.at(h)) * size * length;
  double y = (plan.camber_line(c) + half) * size * length;
  double const turned = stagger_of(h) + r.twist_rad.at(h);
  double const along = std::cos(turned) * x - std::sin(turned) * y;
  double const across = std::sin(turned) * x + std::cos(turned) * y;
  double const sheared = across + along * (std::tan(turned + r.stagger_rad.at(h)) - std::tan(turned));
  double const reach = r.pivot * length + r.sweep.at(h);
  return {edge_s(h) + std::cos(stagger_of(h)) * reach + along,
          edge_t(h) + std::sin(stagger_of(h)) * reach + sheared + r.lean.at(h)};
}

SpanwiseTable linear(double at_root, double at_tip) {
  return {{{0, at_root}, {1, at_tip}}, SpanwiseTable::Interpolation::linear};
}

struct Redesign {
  std::string name;
  SectionsRule rule;
};
void PrintTo(Redesign const& r, std::ostream* out) { *out << r.name; }

std::vector<Redesign> redesigns() {
  std::vector<Redesign> all(8);
  for (Redesign& r : all) r.rule.pivot = 0.25;
  all[0].name = "chord";
  all[0].rule.chord = linear(-0.1, 0.2);
  all[0].rule.pivot = 0;
  all[1].name = "scale";
  all[1].rule.scale = linear(0.1, -0.3);
  all[2].name = "thickness";
  all[2].rule.thickness = linear(0.5, -0.4);
  all[3].name = "twist";
  all[3].rule.twist_rad = linear(0.1, -0.2);
  all[4].name = "stagger";
  all[4].rule.stagger_rad = linear(-0.2, 0.1);
  all[4].rule.pivot = 0.5;
  all[5].name = "sweep";
  all[5].rule.sweep = linear(0.1, 0.2);
  all[6].name = "lean";
  all[6].rule.lean = linear(-0.05, 0.1);
  all[7].name = "all_together";
  all[7].rule.chord = linear(-0.1, 0.2);
  all[7].rule.scale = linear(0.1, -0.2);
  all[7].rule.thickness = linear(0.3, -0.2);
  all[7].rule.twist_rad = linear(0.1, -0.1);
  all[7].rule.stagger_rad = linear(-0.1, 0.15);
  all[7].rule.sweep = linear(0.03, -0.02);
  all[7].rule.lean = linear(-0.05, 0.1);
  return all;
}

// ---------------------------------------------------------------------------------------------------- wings and blades

enum class Topology { o, o_cut, h, h_cut, c, c_cut };
void PrintTo(Topology t, std::ostream* out) {
  *out << std::array{"O", "O cut", "H", "H cut", "C", "C cut"}[std::size_t(t)];
}

/// Angle around the section and side of position s in [0, 1], as the topology runs; exact at the edges.
struct Around {
  double phi;
  bool upper;
};
Around around(double turn) {  // 0: leading edge, 1/2: trailing edge over the upper side
  turn -= std::floor(turn);
  return turn <= 0.5 ? Around{2 * pi * turn, true} : Around{2 * pi * (1 - turn), false};
}

using Place = std::function<Vec3(Around const& at, double h, bool image)>;

/// The surfaces of one wing or blade. In an H mesh the lower side is put at the place of the image.
void add_airfoil(RowMesh& mesh, Topology topology, Place const& place) {
  constexpr int n_around = 121, n_side = 61, n_span = 31;
  auto const surface = [](int n, auto at) { return Surface{"wing", PatchKind::wall, {n, n_span}, at, {}}; };
  switch (topology) {
    case Topology::o:
    case Topology::o_cut:
      mesh.add(surface(n_around, [=](double s, double h) { return place(around(0.3 + (s == 1 ? 0 : s)), h, false); }),
               topology == Topology::o ? Storage{} : Storage{{33, 80, 81}, {7, 20}, 3, 5});
      break;
    case Topology::c:
    case Topology::c_cut:
      mesh.add(
          surface(n_around,
                  [=](double s, double h) {
                    return place(s <= 0.5 ? Around{pi * (1 - 2 * s), false} : Around{pi * (2 * s - 1), true}, h, false);
                  }),
          topology == Topology::c ? Storage{} : Storage{{20, 90}, {11}, 6, 1});
      break;
    case Topology::h:
    case Topology::h_cut:
      mesh.add(surface(n_side,
                       [=](double s, double h) {
                         return place({pi * s, true}, h, false);
                       }),
               topology == Topology::h ? Storage{} : Storage{{40}, {20}, 1, 3});
      mesh.add(surface(n_side,
                       [=](double s, double h) {
                         return place({pi * s, false}, h, true);
                       }),
               topology == Topology::h ? Storage{} : Storage{{10, 11}, {5, 23}, 6, 1});
      break;
  }
}

Planform planform_of(Topology t) {
  return {t == Topology::c || t == Topology::c_cut ? Shape::blunt_base : Shape::lens, 0.05};
}

/// A placement in space, so that no direction is a coordinate direction.
RigidTransform const tilted{rotation_matrix({1 / 3.0, -2 / 3.0, 2 / 3.0}, 0.7), {3, -1, 2}};
constexpr double wing_span = 4;

Vec3 wing_point(Flat const& p, double h) { return tilted({p.s, p.t, wing_span * h}); }

struct Moved {
  Around at;
  double h;
  Vec3 before, after;
};

Mesh wing_mesh(Topology topology, Planform const& plan) {
  RowMesh row;
  add_airfoil(row, topology, [&](Around const& at, double h, bool) {
    return wing_point(section_point(plan, at.phi, at.upper, h), h);
  });
  return row.finish();
}

Motion wing_rules(SectionsRule rule) {
  rule.sections = SectionsRule::Sections::wing;
  rule.span = tilted.rotation * Vec3{0, 0, 1};
  rule.flow = tilted.rotation * Vec3{1, 0, 0.3};  // its part across the span counts
  Motion motion;
  motion.rules = {{{"wing"}, rule, 0, "case.toml:3"}};
  return motion;
}

Vec3 displacement(BoundaryMotion const& motion, Vec3 const& point, int rule = 0) {
  Vec3 u{7, 7, 7};
  motion.displacement(rule, {&point, 1}, {&u, 1});
  return u;
}

class WingRedesign : public ::testing::TestWithParam<std::tuple<Topology, Redesign>> {};
INSTANTIATE_TEST_SUITE_P(Sections, WingRedesign,
                         ::testing::Combine(::testing::Values(Topology::o, Topology::o_cut, Topology::h,
                                                              Topology::h_cut, Topology::c, Topology::c_cut),
                                            ::testing::ValuesIn(redesigns())));

TEST_P(WingRedesign, MovesEveryPointAsItsSectionIsRedesigned) {
  auto const& [topology, redesign] = GetParam();
  Planform const plan = planform_of(topology);
  Mesh const mesh = wing_mesh(topology, plan);
  BoundaryMotion const motion = motion_on(mesh, wing_rules(redesign.rule));
  double worst = 0, largest = 0;
  for (double h : {0.0, 0.013, 0.31, 0.5, 0.77, 1.0})
    for (double turn : {0.0, 0.01, 0.1, 0.25, 0.4, 0.5, 0.55, 0.75, 0.97}) {
      Around const at = around(turn);
      Vec3 const p = wing_point(section_point(plan, at.phi, at.upper, h), h);
      Vec3 const wanted = wing_point(section_point(plan, at.phi, at.upper, h, redesign.rule), h) - p;
      worst = std::max(worst, distance(displacement(motion, p), wanted));
      largest = std::max(largest, norm(wanted));
    }
  EXPECT_LT(worst, 1e-5 * largest);
  EXPECT_GT(largest, 0.01);
}

TEST(Sections, RoundNosesAreFoundBetweenTheGridLines) {
  Planform const plan{Shape::round_nose, 0};
  SectionsRule rule;
  rule.pivot = 0;
  rule.twist_rad = linear(0.2, 0.2);
  rule.chord = linear(0.1, 0.1);
  for (Topology topology : {Topology::o, Topology::o_cut}) {
    Mesh const mesh = wing_mesh(topology, plan);
    BoundaryMotion const motion = motion_on(mesh, wing_rules(rule));
    for (double h : {0.0, 0.4, 1.0})
      for (double turn : {0.0, 0.02, 0.2, 0.5, 0.8, 0.99}) {
        Around const at = around(turn);
        Vec3 const p = wing_point(section_point(plan, at.phi, at.upper, h), h);
        Vec3 const wanted = wing_point(section_point(plan, at.phi, at.upper, h, rule), h) - p;
        EXPECT_LT(distance(displacement(motion, p), wanted), 1e-4) << h << " " << turn;
      }
  }
}

TEST(Sections, BowLeansTheStackingLineByItsAngle) {
  Mesh const mesh = wing_mesh(Topology::o, planform_of(Topology::o));
  SectionsRule rule;
  rule.bow_rad = linear(0.3, -0.3);
  BoundaryMotion const motion = motion_on(mesh, wing_rules(rule));
  Vec3 const t = tilted.rotation * Vec3{0, 1, 0};
  for (double h : {0.0, 0.2, 0.5, 0.9, 1.0}) {
    Vec3 const p = wing_point(section_point(planform_of(Topology::o), 1, true, h), h);
    // Integral of tan(0.3 - 0.6 h) from 0 to h.
    double const wanted = wing_span * (std::log(std::cos(0.3 - 0.6 * h)) - std::log(std::cos(0.3))) / 0.6;
    EXPECT_LT(distance(displacement(motion, p), wanted * t), 1e-9);
  }
}

TEST(Sections, SpanIsFoundAcrossTheSymmetryPlaneAWingStandsOn) {
  // A swept wing: its longest extent is not its span direction.
  Planform const plan = planform_of(Topology::o);
  Mesh mesh = wing_mesh(Topology::o, plan);
  int const zone = mesh.patches.front().zone;
  Zone const& z = mesh.zones[zone];
  // The first spanwise layer of the zone, root nodes and those beside them, lies on the plane of the root.
  for (int i = 0; i < z.extent[0]; ++i) {
    Vec3 const p = mesh.coordinates[z.node({i, 0, 0})];
    mesh.coordinates.set(z.node({i, 0, 1}), p + tilted.rotation * Vec3{0.1 * std::cos(i), 0.1 * std::sin(i), 0});
  }
  mesh.patches.push_back({"sym", "BCSymmetryPlane", PatchKind::symmetry, {}, zone, {{0, 0, 0}, {z.extent[0], 1, 2}}});
  SectionsRule rule;
  rule.twist_rad = linear(0.1, -0.1);
  Motion motion = wing_rules(rule);
  BoundaryMotion const given = motion_on(mesh, motion);
  std::get<SectionsRule>(motion.rules[0].rule).span.reset();
  BoundaryMotion const found = motion_on(mesh, motion);
  for (double h : {0.0, 0.3, 1.0}) {
    Vec3 const p = wing_point(section_point(plan, 2, false, h), h);
    EXPECT_GT(norm(displacement(given, p)), 1e-3);
    EXPECT_LT(distance(displacement(found, p), displacement(given, p)), 1e-12);
  }
}

TEST(Sections, EdgesStayOnAnInclinedPlaneAndTheTrimFadesAlongTheSpan) {
  // A prism between the plane z = 0.2 x and a free tip at z = 2.
  constexpr double slope = 0.2, top = 2;
  int const n = 61, m = 11;
  Mesh mesh;
  int const zone = mesh.add_zone("zone", {n, m, 2});
  mesh.coordinates = Coordinates(mesh.n_nodes());
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j < m; ++j)
      for (int i = 0; i < n; ++i) {
        Around const at = around(double(i % (n - 1)) / (n - 1));
        Planform const lens{Shape::lens, 0};
        double const c = 0.5 * (1 - std::cos(at.phi)), y = (at.upper ? 1 : -1) * lens.half_thickness(at.phi);
        double const x = c + 0.3 * k * (c - 0.5), h = double(j) / (m - 1);
        mesh.coordinates.set(mesh.zones[0].node({i, j, k}), {x, y * (1 + k), slope * x + h * (top - slope * x)});
      }
  mesh.patches = {{"wing", "", PatchKind::wall, {}, zone, {{0, 0, 0}, {n, m, 1}}},
                  {"root", "", PatchKind::wall, {}, zone, {{0, 0, 0}, {n, 1, 2}}}};
  SectionsRule rule;
  rule.sections = SectionsRule::Sections::wing;
  rule.span = Vec3{0, 0, 1};
  rule.sweep = linear(0.3, 0.3);
  Motion motion;
  motion.rules = {{{"wing"}, rule, 0, ""}, {{"root"}, SlipRule{}, 0, ""}};
  BoundaryMotion const surface = motion_on(mesh, motion);
  double const length = std::sqrt(1 + slope * slope);
  Vec3 const normal{-slope / length, 0, 1 / length};
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i) {
      Vec3 const p = mesh.coordinates[mesh.zones[0].node({i, j, 0})], u = displacement(surface, p);
      double const d = dot(p, normal), to_tip = (1 - p.z / top) * top;
      Vec3 const wanted = Vec3{0.3, 0, 0} - (to_tip / (d + to_tip)) * 0.3 * normal.x * normal;
      EXPECT_LT(distance(u, wanted), 1e-12);
      EXPECT_TRUE(j > 0 || std::abs(dot(u, normal)) < 1e-15);
    }
}

// -------------------------------------------------------------------------------------------------------------- blades

/// Mean radius of leading and trailing edge: the section is developed with it.
double section_radius(double h) {
  double const s = edge_s(h);
  return 0.5 * (radius(s, h) + radius(s + std::cos(stagger_of(h)) * chord_of(h), h));
}
Vec3 blade_place(Flat const& p, double h) { return cylindrical(p.s, radius(p.s, h), p.t / section_radius(h)); }

Mesh blade_mesh(Topology topology) {
  Planform const plan = planform_of(topology);
  RowMesh row;
  add_airfoil(row, topology, [&](Around const& at, double h, bool image) {
    Flat p = section_point(plan, at.phi, at.upper, h);
    if (image) p.t += pitch * section_radius(h);
    return blade_place(p, h);
  });
  row.add(end_wall("hub", 0, 401, 5), {{200}, {}, 1, 1});
  row.add(end_wall("case", 1, 401, 5));
  row.add(inlet_plane(201, 5));
  row.add(outlet_plane(41, 5));
  return row.finish();
}

Motion blade_rules(SectionsRule const& rule) {
  Motion motion;
  motion.rules = {{{"wing"}, rule, 0, "case.toml:3"},
                  {{"hub", "case"}, SlipRule{.surface = SlipRule::Surface::revolution}, 0, ""},
                  {{"inlet", "outlet"}, CircumferentialSlideRule{{"wing"}}, 0, ""}};
  return motion;
}

class BladeRedesign : public ::testing::TestWithParam<std::tuple<Topology, Redesign>> {};
INSTANTIATE_TEST_SUITE_P(Sections, BladeRedesign,
                         ::testing::Combine(::testing::Values(Topology::o, Topology::o_cut, Topology::h,
                                                              Topology::h_cut, Topology::c, Topology::c_cut),
                                            ::testing::ValuesIn(redesigns())));

TEST_P(BladeRedesign, MovesEveryPointInTheDevelopedSurfaceAndKeepsItsSpanFraction) {
  auto const& [topology, redesign] = GetParam();
  Planform const plan = planform_of(topology);
  Mesh const mesh = blade_mesh(topology);
  BoundaryMotion const motion = motion_on(mesh, blade_rules(redesign.rule));
  bool const two_images = topology == Topology::h || topology == Topology::h_cut;
  double worst = 0, largest = 0;
  for (double h : {0.0, 0.02, 0.31, 0.5, 0.77, 1.0})
    for (double turn : {0.0, 0.01, 0.1, 0.25, 0.4, 0.5, 0.55, 0.75, 0.97}) {
      Around const at = around(turn);
      bool const image = two_images && !at.upper;
      auto const in_space = [&](Flat p) {
        if (image) p.t += pitch * section_radius(h);
        return blade_place(p, h);
      };
      Vec3 const p = in_space(section_point(plan, at.phi, at.upper, h));
      Vec3 const wanted = in_space(section_point(plan, at.phi, at.upper, h, redesign.rule)) - p;
      worst = std::max(worst, distance(displacement(motion, p), wanted));
      largest = std::max(largest, norm(wanted));
    }
  EXPECT_LT(worst, 2e-5 * largest);
  EXPECT_GT(largest, 0.01);
}

TEST(Sections, ZeroTablesMoveNothingBitForBit) {
  SectionsRule rule;
  for (auto SectionsRule::*table :
       {&SectionsRule::chord, &SectionsRule::scale, &SectionsRule::thickness, &SectionsRule::twist_rad,
        &SectionsRule::stagger_rad, &SectionsRule::sweep, &SectionsRule::lean, &SectionsRule::bow_rad})
    rule.*table = {{{0, 0}, {0.3, 0}, {1, 0}}};
  for (Topology topology : {Topology::o, Topology::h, Topology::c}) {
    for (bool wing : {true, false}) {
      Mesh const mesh = wing ? wing_mesh(topology, planform_of(topology)) : blade_mesh(topology);
      BoundaryMotion const motion = motion_on(mesh, wing ? wing_rules(rule) : blade_rules(rule));
      for (Index n = 0; n < mesh.n_nodes(); n += 7)
        EXPECT_TRUE((displacement(motion, mesh.coordinates[n]) == Vec3{0, 0, 0})) << n;
    }
  }
}

TEST(Sections, BladeEdgesStayOnHubAndCase) {
  SectionsRule const rule = redesigns()[7].rule;
  for (Topology topology : {Topology::o, Topology::h_cut}) {
    Mesh const mesh = blade_mesh(topology);
    BoundaryMotion const motion = motion_on(mesh, blade_rules(rule));
    for (double turn : {0.0, 0.1, 0.3, 0.5})
      for (double h : {0.0, 1.0}) {
        Around const at = around(turn);
        Vec3 const p = blade_place(section_point(planform_of(topology), at.phi, at.upper, h), h);
        Vec3 const q = p + displacement(motion, p);
        EXPECT_GT(distance(p, q), 1e-3);
        EXPECT_NEAR(radius_of(q), radius(q.x, h), 1e-10);
      }
  }
}

TEST(Sections, RadialBladesAreRedesignedAlongTheFlowPathBetweenHubAndCase) {
  SectionsRule rule;
  rule.chord = linear(-0.1, 0.1);
  rule.twist_rad = linear(0.05, -0.05);
  for (bool const h_mesh : {false, true}) {
    RowMesh row;
    if (h_mesh) {
      row.add(impeller::h_side("wing", impeller::main_blade, true, 81, 41));
      row.add(impeller::h_side("wing", impeller::main_blade, false, 81, 41), {{40}, {20}, 1, 3});
    } else {
      row.add(impeller::o_blade("wing", impeller::main_blade, 161, 41), {{33, 80, 120}, {7, 30}, 3, 5});
    }
    row.add(impeller::end_wall("hub", 0, 401, 5));
    row.add(impeller::end_wall("case", 1, 301, 5));
    row.add(impeller::end_plane("inlet", PatchKind::inflow, 0, 41, 5));
    row.add(impeller::end_plane("outlet", PatchKind::outflow, 1, 41, 5));
    Mesh const mesh = row.finish();
    BoundaryMotion const motion = motion_on(mesh, blade_rules(rule));
    for (double h : {0.0, 0.3, 0.7, 1.0})
      for (double phi : {0.1, 1.0, 2.0, 3.1}) {
        Vec3 const p = impeller::blade_point(impeller::main_blade, phi, h), q = p + displacement(motion, p);
        EXPECT_GT(distance(p, q), 1e-3);
        EXPECT_NEAR(impeller::place_of(q).h, h, h == 0 || h == 1 ? 1e-9 : 1e-6);
        // Mid chord stays, so the edges move apart or towards each other.
        double const moved = impeller::place_of(q).s - impeller::place_of(p).s;
        if (phi == 0.1 || phi == 3.1) {
          EXPECT_GT(moved * (phi < 1 ? -1 : 1) * (h - 0.5), 0) << h << " " << phi;
        }
      }
  }
}

TEST(Sections, InletAndExitSlideWithTheEdgesOfTheRedesign) {
  SectionsRule rule;
  rule.lean = linear(0.02, 0.05);
  Mesh const mesh = blade_mesh(Topology::o);
  BoundaryMotion const motion = motion_on(mesh, blade_rules(rule));
  for (double h : {0.1, 0.5, 0.9})
    for (double x : {inlet(h), outlet}) {
      Vec3 const p = cylindrical(x, radius(x, h), 0.1);
      double const angle = rule.lean.at(h) / section_radius(h);
      EXPECT_LT(distance(displacement(motion, p, 2), cylindrical(x, radius(x, h), 0.1 + angle) - p), 1e-5);
    }
}

TEST(Sections, CopiesOnePitchApartMoveAlike) {
  Mesh const mesh = blade_mesh(Topology::h);
  BoundaryMotion const motion = motion_on(mesh, blade_rules(redesigns()[7].rule));
  RigidTransform const turn = rotation_about({0, 0, 0}, {1, 0, 0}, pitch);
  for (double h : {0.0, 0.4, 1.0})
    for (double phi : {0.0, pi}) {
      Vec3 const p = blade_place(section_point(planform_of(Topology::h), phi, true, h), h);
      EXPECT_LT(distance(turn.rotation * displacement(motion, p), displacement(motion, turn(p))), 1e-12);
    }
}

// -------------------------------------------------------------------------------------------------------------- tables

TEST(SpanwiseTable, PassesThroughItsStationsWithoutOvershoot) {
  SpanwiseTable const table{{{0, 0}, {0.15, -0.1}, {0.5, 0.1}, {0.9, -0.1}, {1, 0}}};
  for (auto const& [h, value] : table.stations) EXPECT_EQ(table.at(h), value);
  for (int n = 0; n <= 1000; ++n) {
    EXPECT_LE(std::abs(table.at(0.001 * n)), 0.1 + 1e-15);
    EXPECT_TRUE(n <= 150 || n > 500 || table.at(0.001 * n) > table.at(0.001 * (n - 1))) << n;
  }
  // Level at the extremes.
  EXPECT_NEAR(table.at(0.5 + 1e-5), 0.1, 1e-9);
}

TEST(SpanwiseTable, ContinuesLevelBeyondTheStationsItHas) {
  SpanwiseTable const table{{{0.15, -0.1}, {0.5, 0.1}, {0.9, -0.1}}};
  EXPECT_EQ(table.at(0), -0.1);
  EXPECT_EQ(table.at(1), -0.1);
  EXPECT_NEAR(table.at(0.15 + 1e-5), -0.1, 1e-9);
  EXPECT_EQ((SpanwiseTable{{{0.3, 2}}}.at(0.9)), 2);
  EXPECT_EQ(SpanwiseTable{}.at(0.5), 0);
}

TEST(SpanwiseTable, ReproducesLines) {
  for (auto const kind : {SpanwiseTable::Interpolation::spline, SpanwiseTable::Interpolation::linear}) {
    SpanwiseTable const table{{{0, 1}, {0.2, 1.2}, {0.7, 1.7}, {1, 2}}, kind};
    for (double h : {0.05, 0.33, 0.9}) EXPECT_NEAR(table.at(h), 1 + h, 1e-14);
  }
}

// -------------------------------------------------------------------------------------------------------------- errors

std::string refusal(Mesh const& mesh, Motion const& motion) {
  return message_of<MotionError>([&] { (void)motion_on(mesh, motion); });
}

TEST(SectionsErrors, NameRuleAndValue) {
  Mesh const mesh = wing_mesh(Topology::o, planform_of(Topology::o));
  SectionsRule rule;
  rule.chord = {{{0.5, 0.1}, {0.2, 0}}};
  expect_all_in(refusal(mesh, wing_rules(rule)), {"case.toml:3", "sections", "chord", "0.2", "ascending"});
  rule.chord = {{{0, -1.5}}};
  expect_all_in(refusal(mesh, wing_rules(rule)), {"chord", "-1.5", "above -1"});
  rule.chord = {};
  rule.bow_rad = {{{0, 2}}};
  expect_all_in(refusal(mesh, wing_rules(rule)), {"bow", "2.0", "radians"});
  rule.bow_rad = {};
  Motion motion = wing_rules(rule);
  std::get<SectionsRule>(motion.rules[0].rule).flow = *std::get<SectionsRule>(motion.rules[0].rule).span;
  expect_all_in(refusal(mesh, motion), {"case.toml:3", "flow", "span"});
}

TEST(SectionsErrors, ThicknessOfASingleSide) {
  RowMesh row;
  row.add({"wing",
           PatchKind::wall,
           {61, 21},
           [](double s, double h) { return wing_point(section_point({}, pi * s, true, h), h); },
           {}});
  Mesh const mesh = row.finish();
  SectionsRule rule;
  rule.thickness = linear(0.1, 0.1);
  expect_all_in(refusal(mesh, wing_rules(rule)), {"thickness", "both sides"});
  rule.thickness = {};
  rule.chord = linear(0.1, 0.1);
  Vec3 const p = wing_point(section_point({}, 1, true, 0.4), 0.4);
  EXPECT_LT(distance(displacement(motion_on(mesh, wing_rules(rule)), p),
                     wing_point(section_point({}, 1, true, 0.4, rule), 0.4) - p),
            1e-6);
}

TEST(SectionsErrors, SidesThatBelongToDifferentBlades) {
  RowMesh row;
  auto const side = [&](bool upper, double twist) {
    return Surface{"wing",
                   PatchKind::wall,
                   {61, 21},
                   [=](double s, double h) {
                     Flat p = section_point({}, pi * s, upper, h);
                     p.t += (upper ? 0 : pitch) * section_radius(h) + twist * h;
                     return blade_place(p, h);
                   },
                   {}};
  };
  row.add(side(true, 0));
  row.add(side(false, 0.1));
  row.add(end_wall("hub", 0, 401, 5));
  row.add(end_wall("case", 1, 401, 5));
  row.add(inlet_plane(41, 5));
  row.add(outlet_plane(41, 5));
  SectionsRule rule;
  rule.chord = linear(0.1, 0.1);
  expect_all_in(refusal(row.finish(), blade_rules(rule)), {"two open sides", "pitch"});
}

}  // namespace
}  // namespace gridmorph
