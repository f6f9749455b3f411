// Slip, slide and follow on a radial impeller with splitter blades. The oracle is the formula of the impeller's motion.
#include "impeller.hpp"
#include "moved_nodes.hpp"
#include "support/expect_error.hpp"

#include <gridmorph/core/error.hpp>

#include <gridmorph/motion/boundary_motion.hpp>
#include <gridmorph/motion/turbomachinery/wall_curve.hpp>

#include <random>

namespace gridmorph {
namespace {

using kernels::MeridionalFrame;
using kernels::SlipSurfaceView;

using test::evaluate;
using test::expect_all_in;
using test::message_of;
using test::motion_on;
using test::points_of;

using test::angle_of;
using test::BladeMotion;
using test::radius_of;
using test::RowMesh;
namespace impeller = test::impeller;
using impeller::bend_of;
using impeller::Place;
using impeller::place_of;

enum RuleNumber { blade_number, splitter_number, slide_number, follow_number };

enum class Blade { o_mesh, o_cut, h_mesh };

Mesh impeller_mesh(Blade blade, bool with_splitter = true, RigidTransform const& placed = {}) {
  RowMesh row;
  for (auto const& [name, shape] : {std::pair{"main", impeller::main_blade}, {"splitter", impeller::splitter}}) {
    if (name == std::string("splitter") && !with_splitter) continue;
    switch (blade) {
      case Blade::o_mesh: row.add(impeller::o_blade(name, shape, 161, 41)); break;
      case Blade::o_cut: row.add(impeller::o_blade(name, shape, 161, 41), {{33, 80, 120}, {7, 30}, 3, 5}); break;
      case Blade::h_mesh:
        row.add(impeller::h_side(name, shape, true, 81, 41));
        row.add(impeller::h_side(name, shape, false, 81, 41));
        break;
    }
  }
  row.add(impeller::end_wall("hub", 0, 401, 5), {{150}, {}, 1, 1});
  row.add(impeller::end_wall("case", 1, 301, 5));
  row.add(impeller::end_plane("inlet", PatchKind::inflow, 0, 41, 5));
  row.add(impeller::end_plane("outlet", PatchKind::outflow, 1, 41, 5));
  row.add(impeller::periodic());
  return row.finish(placed);
}

BladeMotion redesign() {
  BladeMotion m;
  m.axial = [](double c, double h) { return 0.04 * (c - 0.5) * std::sin(3 * h + 0.5); };
  m.angle = [](double c, double h) { return 0.1 * (1 + h) * (c - 0.3) * (1 + 0.3 * c); };
  m.difference = 0.01;
  return m;
}

BladeMotion other_redesign() {
  BladeMotion m;
  m.angle = [](double c, double h) { return -0.05 * (1 + c) * (2 - h); };
  return m;
}

using Names = std::vector<std::string>;

Motion rules(Rule main, Rule splitter, Names const& of = {"main", "splitter"}) {
  Motion m;
  m.rules = {{{"main"}, std::move(main), 0, ""},
             {{"splitter"}, std::move(splitter), 0, ""},
             {{"inlet", "outlet"}, CircumferentialSlideRule{of}, 0, ""},
             {{"periodic"}, FollowRule{of}, 0, ""},
             {{"hub", "case"}, SlipRule{.surface = SlipRule::Surface::revolution}, 0, ""}};
  return m;
}

Motion redesigned(Names const& of = {"main", "splitter"}) {
  return rules(impeller::blade_rule(impeller::main_blade, redesign()),
               impeller::blade_rule(impeller::splitter, other_redesign()), of);
}

/// What follow has to give, from the formulas alone.
Vec3 expected_follow(impeller::BladeShape const& blade, BladeMotion const& m, Vec3 const& at) {
  Place const p = place_of(at);
  double const le = blade.leading(p.h), te = blade.trailing(p.h), c = std::clamp(blade.fraction(p), 0.0, 1.0);
  double const share = p.s < le ? p.s / le : p.s > te ? (1 - p.s) / (1 - te) : 1;
  return impeller::point({p.s + share * m.axial(c, p.h), p.h, p.theta + m.angle(c, p.h)}) - at;
}

class EveryImpeller : public ::testing::TestWithParam<Blade> {};
INSTANTIATE_TEST_SUITE_P(Meshes, EveryImpeller, ::testing::Values(Blade::o_mesh, Blade::o_cut, Blade::h_mesh));

TEST_P(EveryImpeller, FollowReplicatesTheMotionOfTheMainBladeAlongTheFlowPath) {
  Mesh const mesh = impeller_mesh(GetParam());
  BoundaryMotion const motion = motion_on(mesh, redesigned());
  auto const points = points_of(mesh, "periodic");
  auto const u = evaluate(motion, follow_number, points);
  double worst = 0, largest = 0;
  for (std::size_t n = 0; n < points.size(); ++n) {
    worst = std::max(worst, distance(u[n], expected_follow(impeller::main_blade, redesign(), points[n])));
    largest = std::max(largest, norm(u[n]));
  }
  EXPECT_GT(largest, 0.1);
  EXPECT_LT(worst, 2e-5 * largest);
}

TEST_P(EveryImpeller, ASplitterCanBeFollowedByItself) {
  Mesh const mesh = impeller_mesh(GetParam());
  BoundaryMotion const motion = motion_on(mesh, redesigned({"splitter"}));
  auto const points = points_of(mesh, "periodic");
  auto const u = evaluate(motion, follow_number, points);
  for (std::size_t n = 0; n < points.size(); ++n)
    EXPECT_LT(distance(u[n], expected_follow(impeller::splitter, other_redesign(), points[n])), 5e-6);
}

TEST_P(EveryImpeller, SlideTurnsAndKeepsAxialPositionAndRadiusAtAxialInletAndRadialExit) {
  Mesh const mesh = impeller_mesh(GetParam());
  BoundaryMotion const motion = motion_on(mesh, redesigned());
  for (char const* end : {"inlet", "outlet"}) {
    auto const points = points_of(mesh, end);
    auto const u = evaluate(motion, slide_number, points);
    double const c = std::string(end) == "inlet" ? 0 : 1;
    for (std::size_t n = 0; n < points.size(); ++n) {
      Vec3 const p = points[n], q = p + u[n];
      EXPECT_EQ(q.x, p.x);
      EXPECT_NEAR(radius_of(q), radius_of(p), 1e-15);
      EXPECT_NEAR(angle_of(q) - angle_of(p), redesign().angle(c, place_of(p).h), 2e-6);
    }
  }
}

TEST_P(EveryImpeller, FollowAgreesWithSlideOnInletAndExit) {
  Mesh const mesh = impeller_mesh(GetParam());
  BoundaryMotion const motion = motion_on(mesh, redesigned());
  for (char const* end : {"inlet", "outlet"}) {
    auto const points = points_of(mesh, end);
    auto const u = evaluate(motion, slide_number, points), v = evaluate(motion, follow_number, points);
    for (std::size_t n = 0; n < points.size(); ++n) EXPECT_LT(distance(u[n], v[n]), 1e-12);
  }
}

TEST_P(EveryImpeller, ATurnAboutTheAxisComesBackExactlyWhereverTheAxisIs) {
  RigidTransform const placed = rotation_about({1, 2, 3}, {1, -2, 0.5}, 0.8);
  Mesh const mesh = impeller_mesh(GetParam(), true, placed);
  Axis const axis{placed({0.3, 0, 0}), placed.rotation * Vec3{2, 0, 0}};
  RigidRule const turn = make_rigid({.angle_rad = 0.2, .axis = axis});
  Motion motion = rules(turn, turn);
  motion.axis = axis;
  BoundaryMotion const surface = motion_on(mesh, motion);
  for (auto const& [name, rule] :
       {std::pair{"inlet", slide_number}, {"outlet", slide_number}, {"periodic", follow_number}}) {
    auto const points = points_of(mesh, name);
    auto const u = evaluate(surface, rule, points);
    for (std::size_t n = 0; n < points.size(); ++n) EXPECT_LT(distance(u[n], displacement(turn, points[n])), 1e-13);
  }
}

TEST_P(EveryImpeller, ABladeThatDoesNotMoveMovesNothing) {
  Mesh const mesh = impeller_mesh(GetParam());
  BoundaryMotion const motion = motion_on(mesh, rules(FixedRule{}, FixedRule{}));
  for (auto const& [name, rule] : {std::pair{"inlet", slide_number}, {"periodic", follow_number}})
    for (Vec3 const& u : evaluate(motion, rule, points_of(mesh, name))) EXPECT_EQ(u, (Vec3{0, 0, 0}));
}

TEST_P(EveryImpeller, PeriodicCopiesMoveAlike) {
  Mesh const mesh = impeller_mesh(GetParam());
  BoundaryMotion const motion = motion_on(mesh, redesigned());
  auto const points = points_of(mesh, "periodic");
  auto const u = evaluate(motion, follow_number, points);
  for (double angle : {impeller::pitch, -2.0}) {
    Mat3 const turn = rotation_matrix({1, 0, 0}, angle);
    std::vector<Vec3> turned;
    for (Vec3 const& p : points) turned.push_back(turn * p);
    auto const v = evaluate(motion, follow_number, turned);
    for (std::size_t n = 0; n < points.size(); ++n) EXPECT_LT(distance(turn * u[n], v[n]), 1e-13);
  }
}

TEST_P(EveryImpeller, EdgesOfFollowStayOnHubAndCase) {
  Mesh const mesh = impeller_mesh(GetParam());
  BoundaryMotion const motion = motion_on(mesh, redesigned());
  for (auto const& [h, bend] : {std::pair{0.0, impeller::hub_bend}, {1.0, impeller::case_bend}}) {
    std::vector<Vec3> edge;
    for (double s = 0; s <= 1; s += 0.01) edge.push_back(impeller::point({s, h, 0.3}));
    auto const u = evaluate(motion, follow_number, edge);
    for (std::size_t n = 0; n < edge.size(); ++n) EXPECT_NEAR(bend_of(edge[n] + u[n]), bend, 1e-10);
  }
}

TEST(RadialRow, FollowAgreesWithAnHMeshWherePeriodicsMeetItAlsoWhereItLeavesItsEndWalls) {
  for (double grow : {0.0, 0.01}) {
    FunctionRule rule = impeller::blade_rule(impeller::main_blade, redesign());
    rule.function = [grow, inner = rule.function](std::span<Vec3 const> points, std::span<Vec3> out) {
      inner(points, out);
      for (std::size_t n = 0; n < points.size(); ++n)
        out[n] = out[n] + grow * (1 + points[n].x) * Vec3{1, points[n].y, points[n].z};
    };
    Mesh const mesh = impeller_mesh(Blade::h_mesh);
    BoundaryMotion const motion = motion_on(mesh, rules(rule, FixedRule{}));
    int checked = 0;
    for (Vec3 const& p : points_of(mesh, "main")) {
      double const c = impeller::main_blade.fraction(place_of(p));
      if (c > 1e-9 && c < 1 - 1e-9) continue;
      EXPECT_LT(distance(evaluate(motion, follow_number, {p})[0], evaluate(motion, blade_number, {p})[0]), 1e-11);
      ++checked;
    }
    EXPECT_GE(checked, 4 * 41);
  }
}

TEST(RadialRow, TheSplitterIsLeftOutWithANote) {
  Mesh const mesh = impeller_mesh(Blade::o_mesh);
  std::string notes;
  BoundaryMotion const motion = motion_on(mesh, redesigned());
  for (auto const& n : motion.notes()) notes += n + "\n";
  expect_all_in(notes, {"splitter", "left out", "1 closed and 0 open", "along the flow path"});
}

TEST(RadialRow, FollowAndSlideMayNameTheSplitterOrNot) {
  Mesh const mesh = impeller_mesh(Blade::o_mesh);
  Motion motion = redesigned();
  std::get<CircumferentialSlideRule>(motion.rules[slide_number].rule).of = {"main"};
  BoundaryMotion const surface = motion_on(mesh, motion);
  auto const points = points_of(mesh, "outlet");
  auto const u = evaluate(surface, slide_number, points), v = evaluate(surface, follow_number, points);
  for (std::size_t n = 0; n < points.size(); ++n) EXPECT_LT(distance(u[n], v[n]), 1e-12);
}

TEST_P(EveryImpeller, PeriodicsThroughTheSplitterGoFromItsEdgesToWhatTheMainBladeDoesToTheEnds) {
  Mesh const mesh = impeller_mesh(GetParam());
  for (Names const& ends : {Names{"main"}, Names{"main", "splitter"}}) {
    Motion motion = redesigned({"splitter"});
    std::get<CircumferentialSlideRule>(motion.rules[slide_number].rule).of = ends;
    BoundaryMotion const surface = motion_on(mesh, motion);
    for (char const* end : {"inlet", "outlet"}) {
      auto const points = points_of(mesh, end);
      auto const u = evaluate(surface, slide_number, points), v = evaluate(surface, follow_number, points);
      for (std::size_t n = 0; n < points.size(); ++n) EXPECT_LT(distance(u[n], v[n]), 1e-12) << end;
    }
    auto const points = points_of(mesh, "periodic");
    auto const u = evaluate(surface, follow_number, points);
    for (std::size_t n = 0; n < points.size(); ++n) {
      Place const p = place_of(points[n]);
      impeller::BladeShape const& b = impeller::splitter;
      double const le = b.leading(p.h), te = b.trailing(p.h), c = std::clamp(b.fraction(p), 0.0, 1.0);
      double const share = p.s < le ? p.s / le : p.s > te ? (1 - p.s) / (1 - te) : 1;
      double const angle =
          share * other_redesign().angle(c, p.h) + (share < 1 ? (1 - share) * redesign().angle(c, p.h) : 0);
      Vec3 const wanted = impeller::point({p.s, p.h, p.theta + angle}) - points[n];
      EXPECT_LT(distance(u[n], wanted), 5e-6) << p.s << " " << p.h;
    }
  }
}

TEST(RadialRow, ItsWallsMayBeOfSeveralFamiliesThatFollowOneAnother) {
  auto const build = [](bool split) {
    RowMesh row;
    row.add(impeller::o_blade("main", impeller::main_blade, 161, 41));
    if (split) {
      row.add(impeller::end_wall("hub2", 0, 301, 5, 0.7, 1));
      row.add(impeller::end_wall("hub0", 0, 301, 5, 0, 0.3));
      row.add(impeller::end_wall("hub1", 0, 301, 5, 0.3, 0.7));
      row.add(impeller::end_wall("case0", 1, 301, 5, 0, 0.5));
      row.add(impeller::end_wall("case1", 1, 301, 5, 0.5, 1));
    } else {
      row.add(impeller::end_wall("hub", 0, 401, 5));
      row.add(impeller::end_wall("case", 1, 401, 5));
    }
    row.add(impeller::end_plane("inlet", PatchKind::inflow, 0, 41, 5));
    row.add(impeller::end_plane("outlet", PatchKind::outflow, 1, 41, 5));
    row.add(impeller::periodic());
    return row.finish();
  };
  auto const follow = [](Mesh const& mesh, Names const& walls) {
    Motion m;
    m.rules = {{{"main"}, impeller::blade_rule(impeller::main_blade, redesign()), 0, ""},
               {{"inlet", "outlet"}, CircumferentialSlideRule{{"main"}}, 0, ""},
               {{"periodic"}, FollowRule{{"main"}}, 0, ""}};
    for (auto const& wall : walls)
      m.rules.push_back({{wall}, SlipRule{.surface = SlipRule::Surface::revolution}, 0, ""});
    return evaluate(motion_on(mesh, m), 2, points_of(mesh, "periodic"));
  };
  auto const u = follow(build(false), {"hub", "case"});
  auto const v = follow(build(true), {"hub0", "hub1", "hub2", "case0", "case1"});
  for (std::size_t n = 0; n < u.size(); ++n) EXPECT_LT(distance(u[n], v[n]), 1e-8);
}

/// A vaned diffuser between parallel straight walls that run outwards, across the axis or nearly so.
struct Diffuser {
  double slope_rad;
  [[nodiscard]] Vec3 point(double s, double h, double theta) const {
    double const c = std::cos(slope_rad), n = std::sin(slope_rad);
    return test::cylindrical(0.8 * s * c - 0.2 * h * n, 1 + 0.8 * s * n + 0.2 * h * c, theta);
  }
  [[nodiscard]] Place place_of(Vec3 const& p) const {
    double const c = std::cos(slope_rad), n = std::sin(slope_rad), x = p.x, r = radius_of(p) - 1;
    return {(x * c + r * n) / 0.8, (r * c - x * n) / 0.2, angle_of(p)};
  }
  static double fraction(double s) { return (s - 0.3) / 0.4; }
  static double angle(double c, double h) { return 0.1 * (1 + c) * (1 + h * h); }

  [[nodiscard]] Mesh mesh() const {
    auto const at = [d = *this](auto f) { return [=](double s, double t) { return f(d, s, t); }; };
    RowMesh row;
    row.add({"blade",
             PatchKind::wall,
             {121, 31},
             at([](Diffuser const& d, double s, double t) {
               double const phi = 2 * std::numbers::pi * (s == 1 ? 0 : s), c = 0.5 * (1 - std::cos(phi));
               return d.point(0.3 + 0.4 * c, t, 0.3 * c + 0.02 * std::sin(phi));
             }),
             {}});
    for (double h : {0.0, 1.0})
      row.add({h == 0 ? "hub" : "case",
               PatchKind::wall,
               {101, 5},
               at([h](Diffuser const& d, double s, double t) { return d.point(s, h, 0.5 * t); }),
               {}});
    for (double s : {0.0, 1.0})
      row.add({s == 0 ? "inlet" : "outlet",
               s == 0 ? PatchKind::inflow : PatchKind::outflow,
               {21, 5},
               at([s](Diffuser const& d, double h, double t) { return d.point(s, h, 0.5 * t); }),
               {}});
    row.add({"periodic",
             PatchKind::other,
             {41, 21},
             at([](Diffuser const& d, double s, double h) { return d.point(s, h, 0.1); }),
             {}});
    return row.finish();
  }
};

TEST(RadialRow, FlatAndSteepConicalWallsMakeARadialRow) {
  using Wall = SlipRule::Surface;
  double const right = 0.5 * std::numbers::pi;
  for (auto const& [slope, wall] :
       {std::pair{right, Wall::revolution}, {right, Wall::plane}, {0.8 * right, Wall::revolution}}) {
    Diffuser const d{slope};
    Mesh const mesh = d.mesh();
    Motion motion;
    motion.rules = {{{"blade"},
                     FunctionRule{"turn",
                                  [d](std::span<Vec3 const> points, std::span<Vec3> out) {
                                    for (std::size_t n = 0; n < points.size(); ++n) {
                                      Place const p = d.place_of(points[n]);
                                      out[n] = d.point(p.s, p.h, p.theta + d.angle(d.fraction(p.s), p.h)) - points[n];
                                    }
                                  }},
                     0,
                     ""},
                    {{"inlet", "outlet"}, CircumferentialSlideRule{{"blade"}}, 0, ""},
                    {{"periodic"}, FollowRule{{"blade"}}, 0, ""},
                    {{"hub", "case"}, SlipRule{wall}, 0, ""}};
    BoundaryMotion const surface = motion_on(mesh, motion);
    for (Vec3 const& x : points_of(mesh, "periodic")) {
      Place const p = d.place_of(x);
      Vec3 const wanted = d.point(p.s, p.h, p.theta + d.angle(std::clamp(d.fraction(p.s), 0.0, 1.0), p.h)) - x;
      EXPECT_LT(distance(evaluate(surface, 2, {x})[0], wanted), 2e-6);
    }
    for (Vec3 const& x : points_of(mesh, "outlet")) {
      Place const p = d.place_of(x);
      EXPECT_LT(distance(evaluate(surface, 1, {x})[0], d.point(p.s, p.h, p.theta + d.angle(1, p.h)) - x), 2e-6);
    }
  }
}

TEST(RadialRow, OneEndWallIsNotEnough) {
  Mesh const mesh = impeller_mesh(Blade::o_mesh);
  Motion motion = redesigned();
  motion.rules.back().patches = {"hub"};
  motion.rules.back().where = "case.toml:9";
  expect_all_in(message_of<MotionError>([&] { motion_on(mesh, motion); }), {"hub and case", "slip", "revolution"});
}

TEST(RadialRow, BladesOfTwoRowsInOneOfAreRefused) {
  RowMesh row;
  row.add(impeller::o_blade("main", {0.1, 0, 0.3, 0, 0}, 81, 21));
  row.add(impeller::o_blade("main", {0.6, 0, 0.2, 0, 0}, 81, 21));
  row.add(impeller::end_wall("hub", 0, 201, 5));
  row.add(impeller::end_wall("case", 1, 201, 5));
  row.add(impeller::periodic());
  Mesh const mesh = row.finish();
  Motion m;
  m.rules = {{{"main"}, FixedRule{}, 0, ""},
             {{"periodic"}, FollowRule{{"main"}}, 0, "case.toml:7"},
             {{"hub", "case"}, SlipRule{.surface = SlipRule::Surface::revolution}, 0, ""}};
  expect_all_in(message_of<MotionError>([&] { motion_on(mesh, m); }), {"case.toml:7", "two rows"});
}

// ---- flow coordinates --------------------------------------------------------------------------------------------

/// A wall of an elliptic bend, in a frame turned by 45 degrees.
WallPiece elliptic_wall(double a, double b) {
  std::vector<std::pair<double, double>> points;
  for (int n = 0; n <= 300; ++n) {
    double const t = 0.5 * std::numbers::pi * n / 300;
    points.emplace_back(a * std::sin(t), 2 - b * std::cos(t));
  }
  TurnedProfile const fit = TurnedProfile::from_points(points);
  return {fit.profile, fit.frame, fit.profile.knots.front().axial, fit.profile.knots.back().axial};
}

TEST(FlowCoordinates, PointAndPositionAreInverses) {
  std::vector<WallCurve> walls = chain_walls({elliptic_wall(0.6, 0.9), elliptic_wall(1.4, 1.5)});
  FlowCoordinates const flow(walls[0], walls[1]);
  std::mt19937 random(3);
  std::uniform_real_distribution<> s(-0.02, 1.02), h(-0.1, 1.1);
  for (int n = 0; n < 1000; ++n) {
    FlowPosition const f{s(random) * flow.length(), h(random)}, g = flow.position(flow.point(f));
    EXPECT_NEAR(g.m, f.m, 1e-13);
    EXPECT_NEAR(g.h, f.h, 1e-13);
  }
  // Hub and case themselves, and where they begin and end.
  for (double t : {0.0, 0.3, 1.0})
    for (auto const& [a, b, span] : {std::tuple{0.6, 0.9, 1.0}, {1.4, 1.5, 0.0}}) {
      double const angle = 0.5 * std::numbers::pi * t;
      FlowPosition const f = flow.position({a * std::sin(angle), 2 - b * std::cos(angle)});
      EXPECT_NEAR(f.h, span, 1e-9);
      if (t == 0) {
        EXPECT_NEAR(f.m, 0, 1e-9);
      }
      if (t == 1) {
        EXPECT_NEAR(f.m, flow.length(), 1e-9);
      }
    }
}

// ---- slip --------------------------------------------------------------------------------------------------------

SlipSurface surface_of(Mesh const& mesh, BoundaryMotion const& motion, std::string const& name) {
  for (std::size_t p = 0; p < mesh.patches.size(); ++p)
    if (mesh.patches[p].name == name) return *motion.slip_surface(int(p));
  return {};
}

TEST(TurningWall, NodesComeBackAlongTheNormalInTheMeridionalPlane) {
  Mesh const mesh = impeller_mesh(Blade::o_mesh);
  BoundaryMotion const motion = motion_on(mesh, redesigned());
  std::mt19937 random(1);
  std::uniform_real_distribution<> s(0.01, 0.99), h(-0.4, 0.4), d(-0.02, 0.02);
  for (auto const& [name, bend, at] :
       {std::tuple{"hub", impeller::hub_bend, 0.0}, {"case", impeller::case_bend, 1.0}}) {
    SlipSurface const surface = surface_of(mesh, motion, name);
    EXPECT_EQ(surface.kind, SlipSurface::Kind::meridional);
    EXPECT_LT(surface.baseline_deviation, 1e-14);
    SlipSurfaceView const view = surface.view();
    for (int n = 0; n < 1000; ++n) {
      Place const p{s(random), at + h(random), 6 * s(random)};
      EXPECT_LT(distance(view.project(impeller::point(p)), impeller::point({p.s, at, p.theta})), 1e-9);
      Vec3 const on = impeller::point({p.s, at, p.theta}), u{d(random), d(random), d(random)};
      Vec3 const v = view.constrain(on, u);
      if (place_of(on + v).s > 0 && place_of(on + v).s < 1) {
        EXPECT_NEAR(bend_of(on + v), bend, 1e-9);
      }
      EXPECT_LT(norm(view.constrain(on, v) - v), 1e-13);
      EXPECT_EQ(view.constrain(on, {0, 0, 0}), (Vec3{0, 0, 0}));
    }
    RigidRule const turn = make_rigid({.angle_rad = 0.1, .axis = {{0, 0, 0}, {1, 0, 0}}});
    for (Vec3 const& p : points_of(mesh, name))
      EXPECT_EQ(view.constrain(p, displacement(turn, p)), displacement(turn, p));
  }
}

/// Against differences of constrain() itself.
void expect_rate_is_derivative(SlipSurfaceView const& view, Vec3 const& baseline, Vec3 const& u, Vec3 const& rate) {
  double const own = view.own_offset(baseline), dt = 1e-5;
  Vec3 const difference =
      (0.5 / dt) * (view.constrain(baseline, own, u + dt * rate) - view.constrain(baseline, own, u - dt * rate));
  EXPECT_LT(distance(view.constrain_rate(baseline, own, u, rate), difference), 1e-7);
}

TEST(TurningWall, RatesAreDerivatives) {
  Mesh const mesh = impeller_mesh(Blade::o_mesh);
  BoundaryMotion const motion = motion_on(mesh, redesigned());
  SlipSurface const hub = surface_of(mesh, motion, "hub");
  SlipSurface disc = hub;  // a curved wall across the axis: axial position over radius
  std::vector<std::pair<double, double>> points;
  for (int n = 0; n <= 100; ++n) points.emplace_back(0.3 + 0.02 * std::sin(0.05 * n), 0.5 + 0.01 * n);
  TurnedProfile const across = TurnedProfile::from_points(points);
  disc.profile = across.profile;
  disc.frame = across.frame;
  std::mt19937 random(2);
  std::uniform_real_distribution<> s(0.1, 0.9), d(-0.02, 0.02);
  for (SlipSurface const* surface : {&hub, static_cast<SlipSurface const*>(&disc)})
    for (int n = 0; n < 100; ++n)
      expect_rate_is_derivative(surface->view(), impeller::point({s(random), 0.02, 1}),
                                {d(random), d(random), d(random)}, {50 * d(random), 50 * d(random), 50 * d(random)});
}

TEST(TurningWall, AWallAcrossTheAxisKeepsTheRadiusOfWhatSlidesOnIt) {
  RowMesh row;
  row.add({"disc", PatchKind::wall, {31, 7}, [](double s, double t) { return test::cylindrical(0.25, 1 + s, t); }, {}});
  Mesh const mesh = row.finish();
  Motion motion;
  motion.rules = {{{"disc"}, SlipRule{.surface = SlipRule::Surface::revolution}, 0, ""}};
  BoundaryMotion const surface = motion_on(mesh, motion);
  SlipSurface const disc = surface_of(mesh, surface, "disc");
  EXPECT_EQ(disc.kind, SlipSurface::Kind::meridional);
  EXPECT_EQ(disc.baseline_deviation, 0);
  for (Vec3 const& p : points_of(mesh, "disc")) {
    Vec3 const u{0.1, 0.02, -0.03}, q = p + disc.view().constrain(p, u);
    EXPECT_EQ(q.x, 0.25);
    EXPECT_NEAR(q.y, p.y + 0.02, 1e-15);
    EXPECT_NEAR(q.z, p.z - 0.03, 1e-15);
  }
}

TEST(TurnedProfile, AFunctionOfTheAxialPositionStaysOneBitForBit) {
  std::vector<std::pair<double, double>> points;
  for (int n = 0; n < 300; ++n) points.emplace_back(0.01 * n, 1 + 0.1 * std::sin(0.02 * n));
  TurnedProfile const turned = TurnedProfile::from_points(points);
  EXPECT_EQ(turned.frame, MeridionalFrame{});
  EXPECT_TRUE(turned.profile.knots == RevolutionProfile::from_points(points).knots);
}

TEST(TurnedProfile, FollowsAWallWithStraightPartsAlongAndAcrossTheAxis) {
  // A cylinder, a quarter circle, a disc.
  auto const wall = [](double s) {
    double const bend = 0.5 * std::numbers::pi;
    if (s < 1) return std::pair{s - 1, 0.5};
    if (s < 1 + bend) return std::pair{std::sin(s - 1), 1.5 - std::cos(s - 1)};
    return std::pair{1.0, 1.5 + s - 1 - bend};
  };
  std::vector<std::pair<double, double>> points;
  constexpr double spacing = 0.00889;
  for (int n = 0; n <= 400; ++n) points.push_back(wall(spacing * n));
  TurnedProfile const turned = TurnedProfile::from_points(points);
  EXPECT_TRUE(turned.frame.inclined());
  // At the ends of the circle the curvature jumps by 1.
  for (double s = 0.01; s < 3.5; s += 0.0137) {
    auto const [a, r] = wall(s);
    EXPECT_NEAR(turned.profile(turned.frame.abscissa(a, r)), turned.frame.ordinate(a, r), spacing * spacing / 16);
  }
}

TEST(TurnedProfile, RefusesWallsThatTurnBackAndTwoWalls) {
  std::vector<std::pair<double, double>> back, two, apart;
  for (int n = 0; n <= 200; ++n) {
    double const t = 0.02 * n;
    back.emplace_back(std::sin(t), 2 - std::cos(t));
    two.emplace_back(t, 1 + 0.01 * (n % 2));
    apart.emplace_back(t, 1 + 0.3 * (n % 2));
  }
  expect_all_in(message_of<MotionError>([&] { TurnedProfile::from_points(back); }), {"180 degrees"});
  EXPECT_THROW(TurnedProfile::from_points(two), MotionError);
  EXPECT_THROW(TurnedProfile::from_points(apart), MotionError);
}

}  // namespace
}  // namespace gridmorph
