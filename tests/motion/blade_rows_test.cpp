// Circumferential slide and follow on analytic blade rows. The oracle is the formula of the blade's motion.
#include "annulus.hpp"
#include "moved_nodes.hpp"
#include "support/expect_error.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/as_hexahedra.hpp>

#include <gridmorph/motion/boundary_motion.hpp>

#include <random>

namespace gridmorph {
namespace {

using test::evaluate;
using test::expect_all_in;
using test::message_of;
using test::motion_on;
using test::points_of;

using namespace test;  // the annulus and its formulas

enum RuleNumber { blade_rule_number, slide_number, follow_number, slip_number };

Motion row_rules(Rule blade, bool slides = true, bool walls = true) {
  Motion m;
  m.rules = {{{"blade"}, std::move(blade), 0, ""}};
  if (slides)
    m.rules.push_back({{"inlet", "outlet"}, CircumferentialSlideRule{{"blade"}}, 0, ""});
  else
    m.rules.push_back({{"inlet", "outlet"}, FixedRule{}, 0, ""});
  m.rules.push_back({{"periodic"}, FollowRule{{"blade"}}, 0, ""});
  if (walls) m.rules.push_back({{"hub", "case"}, SlipRule{.surface = SlipRule::Surface::revolution}, 0, ""});
  return m;
}

Surface periodic() {
  return {"periodic",
          PatchKind::other,
          {61, 31},
          [](double s, double h) {
            double const x = inlet(h) + s * (outlet - inlet(h));
            return cylindrical(x, radius(x, h), 0.2 * x);
          },
          {}};
}

enum class Blade { o_mesh, o_cut, h_mesh, h_cut };

Mesh row_mesh(Blade blade = Blade::o_mesh, bool tilted_inlet = true) {
  RowMesh row;
  switch (blade) {
    case Blade::o_mesh: row.add(o_blade(161, 41)); break;
    // Cut around and in span at places that differ from piece to piece, every piece turned otherwise.
    case Blade::o_cut: row.add(o_blade(161, 41, 1.3), {{33, 80, 81, 120}, {7, 30}, 3, 5}); break;
    case Blade::h_mesh:
      row.add(h_side(true, 81, 41));
      row.add(h_side(false, 81, 41));
      break;
    case Blade::h_cut:
      row.add(h_side(true, 81, 41), {{40}, {20}, 1, 3});
      row.add(h_side(false, 81, 41), {{10, 11}, {5, 33}, 6, 1});
      break;
  }
  row.add(end_wall("hub", 0, 401, 5), {{200}, {}, 1, 1});
  row.add(end_wall("case", 1, 401, 5));
  if (tilted_inlet) row.add(inlet_plane(201, 5));
  row.add(outlet_plane(41, 5));
  row.add(periodic());
  return row.finish();
}

/// The motion of the redesigns in the tests: restagger with twist, chord change, sides that differ.
BladeMotion redesign() {
  BladeMotion m;
  m.axial = [](double c, double h) { return 0.04 * (c - 0.5) * std::sin(3 * h); };
  m.angle = [](double c, double h) { return 0.1 * (1 + h) * (c - 0.3) * (1 + 0.3 * c); };
  m.difference = 0.01;
  return m;
}

/// What follow has to give, from the formulas alone.
Vec3 expected_follow(BladeMotion const& m, Vec3 const& p, bool slides) {
  double const h = span_of(p.x, radius_of(p)), le = leading(h), te = trailing(h);
  double c = (p.x - le) / (te - le), share = 1;
  if (p.x < le) share = (p.x - inlet(h)) / (le - inlet(h));
  if (p.x > te) share = (outlet - p.x) / (outlet - te);
  c = std::clamp(c, 0.0, 1.0);
  double const x = p.x + share * m.axial(c, h);
  double const theta = angle_of(p) + (slides ? 1 : share) * m.angle(c, h);
  return cylindrical(x, radius(x, h), theta) - p;
}

double largest_difference(std::vector<Vec3> const& a, std::vector<Vec3> const& b) {
  double worst = 0;
  for (std::size_t n = 0; n < a.size(); ++n) worst = std::max(worst, distance(a[n], b[n]));
  return worst;
}

class EveryBladeMesh : public ::testing::TestWithParam<Blade> {};
INSTANTIATE_TEST_SUITE_P(Meshes, EveryBladeMesh,
                         ::testing::Values(Blade::o_mesh, Blade::o_cut, Blade::h_mesh, Blade::h_cut));

TEST_P(EveryBladeMesh, FollowReplicatesMidCamberMotionAndTapersToSlidingEnds) {
  Mesh const mesh = row_mesh(GetParam());
  BoundaryMotion const motion = motion_on(mesh, row_rules(blade_rule(redesign())));
  auto const points = points_of(mesh, "periodic");
  auto const u = evaluate(motion, follow_number, points);
  double worst = 0, largest = 0;
  for (std::size_t n = 0; n < points.size(); ++n) {
    worst = std::max(worst, distance(u[n], expected_follow(redesign(), points[n], true)));
    largest = std::max(largest, norm(u[n]));
  }
  EXPECT_GT(largest, 0.1);
  EXPECT_LT(worst, 2e-5 * largest);
}

/// How far the periodic sides are, at most, from where they follow the redesign between ends that stand.
double error_to_fixed_ends(Mesh const& mesh, BoundaryMotion const& motion) {
  auto const points = points_of(mesh, "periodic");
  auto const u = evaluate(motion, follow_number, points);
  double worst = 0;
  for (std::size_t n = 0; n < points.size(); ++n)
    worst = std::max(worst, distance(u[n], expected_follow(redesign(), points[n], false)));
  return worst;
}

TEST_P(EveryBladeMesh, FollowTapersToFixedEnds) {
  Mesh const mesh = row_mesh(GetParam());
  BoundaryMotion const motion = motion_on(mesh, row_rules(blade_rule(redesign()), false));
  EXPECT_LT(error_to_fixed_ends(mesh, motion), 5e-6);
  for (char const* end : {"inlet", "outlet"})
    for (Vec3 const& v : evaluate(motion, follow_number, points_of(mesh, end))) EXPECT_LT(norm(v), 1e-12);
}

TEST(BladeRow, ARegionUpstreamIsNoEndOfTheRow) {
  Mesh mesh = row_mesh();
  auto const sides = std::find_if(mesh.patches.begin(), mesh.patches.end(), [](Patch const& p) {
    return p.name == "periodic" || (!p.families.empty() && p.families.front() == "periodic");
  });
  ASSERT_NE(sides, mesh.patches.end());
  // The part of a periodic side between the inlet, which is curved, and the leading edge.
  Patch part{"part", "", PatchKind::region, {}, sides->zone, sides->range, {}, {}};
  part.range.begin[0] = 6;
  part.range.end[0] = 12;
  Zone const& zone = mesh.zones[part.zone];
  for (Index3 const& corner : {part.range.begin, Index3{11, part.range.end[1] - 1, 0}})
    ASSERT_TRUE(mesh.coordinates.x(zone.node(corner)) > -0.5 && mesh.coordinates.x(zone.node(corner)) < -0.1);
  mesh.patches.push_back(part);
  BoundaryMotion const motion = motion_on(mesh, row_rules(blade_rule(redesign()), false));
  EXPECT_LT(error_to_fixed_ends(mesh, motion), 5e-6);
}

TEST_P(EveryBladeMesh, SlideTurnsByTheAngleOfTheNearerEdgeAndKeepsAxialPositionAndRadius) {
  Mesh const mesh = row_mesh(GetParam());
  BoundaryMotion const motion = motion_on(mesh, row_rules(blade_rule(redesign())));
  for (char const* end : {"inlet", "outlet"}) {
    auto const points = points_of(mesh, end);
    auto const u = evaluate(motion, slide_number, points);
    double const c = std::string(end) == "inlet" ? 0 : 1;
    for (std::size_t n = 0; n < points.size(); ++n) {
      Vec3 const p = points[n], q = p + u[n];
      EXPECT_EQ(q.x, p.x);
      EXPECT_NEAR(radius_of(q), radius_of(p), 1e-15);
      EXPECT_NEAR(angle_of(q) - angle_of(p), redesign().angle(c, span_of(p.x, radius_of(p))), 2e-6);
    }
  }
}

TEST_P(EveryBladeMesh, FollowAgreesWithSlideOnInletAndExit) {
  Mesh const mesh = row_mesh(GetParam());
  BoundaryMotion const motion = motion_on(mesh, row_rules(blade_rule(redesign())));
  for (char const* end : {"inlet", "outlet"}) {
    auto const points = points_of(mesh, end);
    EXPECT_LT(largest_difference(evaluate(motion, slide_number, points), evaluate(motion, follow_number, points)),
              1e-12);
  }
}

TEST_P(EveryBladeMesh, ARotationAboutTheAxisTurnsEverythingByTheSameAngle) {
  Mesh const mesh = row_mesh(GetParam());
  RigidRule const turn = make_rigid({.angle_rad = 0.2, .axis = {{0, 0, 0}, {1, 0, 0}}});
  BoundaryMotion const motion = motion_on(mesh, row_rules(turn));
  for (auto const& [name, rule] :
       {std::pair{"inlet", slide_number}, {"outlet", slide_number}, {"periodic", follow_number}}) {
    auto const points = points_of(mesh, name);
    auto const u = evaluate(motion, rule, points);
    for (std::size_t n = 0; n < points.size(); ++n) EXPECT_LT(distance(u[n], displacement(turn, points[n])), 1e-13);
  }
}

/// Whether the rules of a motion at another time give the points what they give where they are made for that time.
void expect_same_as_made_then(std::shared_ptr<Boundary const> const& boundary, Motion const& first, Motion const& then,
                              std::vector<std::pair<int, std::vector<Vec3>>> const& points_of_rules) {
  BoundaryMotion const later = BoundaryMotion(boundary, resolve(boundary->names(), first)).with(then);
  BoundaryMotion const made_then(boundary, resolve(boundary->names(), then));
  for (auto const& [rule, points] : points_of_rules)
    EXPECT_EQ(evaluate(later, rule, points), evaluate(made_then, rule, points)) << "rule " << rule;
}

TEST_P(EveryBladeMesh, AtAnotherTimeARowMovesAsOneThatIsMadeThen) {
  Mesh const blocks = row_mesh(GetParam());
  BladeMotion other = redesign();
  other.angle = [](double c, double h) { return 0.05 * (1 - h) * c; };
  for (Mesh const& mesh : {blocks, as_hexahedra(blocks)})
    expect_same_as_made_then(boundary_of(mesh), row_rules(blade_rule(redesign())), row_rules(blade_rule(other)),
                             {{slide_number, points_of(blocks, "inlet")},
                              {slide_number, points_of(blocks, "outlet")},
                              {follow_number, points_of(blocks, "periodic")}});
}

TEST_P(EveryBladeMesh, ABladeThatDoesNotMoveMovesNothingBitForBit) {
  Mesh const mesh = row_mesh(GetParam());
  for (Rule const& rule : {Rule{FixedRule{}}, Rule{RigidRule{}}}) {
    BoundaryMotion const motion = motion_on(mesh, row_rules(rule));
    for (auto const& [name, r] : {std::pair{"inlet", slide_number},
                                  {"outlet", slide_number},
                                  {"periodic", follow_number},
                                  {"blade", blade_rule_number}})
      for (Vec3 const& u : evaluate(motion, r, points_of(mesh, name))) EXPECT_EQ(u, (Vec3{0, 0, 0}));
  }
}

TEST_P(EveryBladeMesh, FollowKeepsEndWallEdgesOnHubAndCase) {
  Mesh const mesh = row_mesh(GetParam());
  BoundaryMotion const motion = motion_on(mesh, row_rules(blade_rule(redesign())));
  for (auto const& [name, profile] : {std::pair{"hub", &hub}, {"case", &shroud}}) {
    auto const points = points_of(mesh, name);
    auto const u = evaluate(motion, follow_number, points);
    for (std::size_t n = 0; n < points.size(); ++n) {
      Vec3 const q = points[n] + u[n];
      EXPECT_NEAR(radius_of(q), profile(q.x), 1e-10);
    }
  }
}

class HMesh : public ::testing::TestWithParam<Blade> {};
INSTANTIATE_TEST_SUITE_P(Meshes, HMesh, ::testing::Values(Blade::h_mesh, Blade::h_cut));

/// Follow against the blade on its leading and trailing edges, for a blade that scales its radius by 1 + grow(h) beyond
/// keeping its span fraction.
void expect_follow_agrees_with_the_blade(Blade blade, std::function<double(double h)> const& grow) {
  FunctionRule rule = blade_rule(redesign());
  rule.function = [grow, inner = rule.function](std::span<Vec3 const> points, std::span<Vec3> out) {
    inner(points, out);
    for (std::size_t n = 0; n < points.size(); ++n) {
      Vec3 const p = points[n], q = p + out[n];
      double const more = grow(span_of(p.x, radius_of(p)));
      if (more != 0) out[n] = Vec3{q.x, (1 + more) * q.y, (1 + more) * q.z} - p;
    }
  };
  Mesh const mesh = row_mesh(blade);
  BoundaryMotion const motion = motion_on(mesh, row_rules(rule));
  auto const points = points_of(mesh, "blade");
  int checked = 0;
  double worst = 0;
  for (Vec3 const& p : points) {
    double const h = span_of(p.x, radius_of(p)), c = (p.x - leading(h)) / chord(h);
    if (c > 1e-9 && c < 1 - 1e-9) continue;
    worst =
        std::max(worst, distance(evaluate(motion, follow_number, {p})[0], evaluate(motion, blade_rule_number, {p})[0]));
    ++checked;
  }
  EXPECT_GE(checked, 4 * 41);
  EXPECT_LT(worst, 1e-11);  // the profiles of hub and case are that near to the formulas
}

TEST_P(HMesh, FollowAgreesWithTheBladeInTheLinesWherePeriodicsMeetIt) {
  expect_follow_agrees_with_the_blade(
      GetParam(), [](double h) { return h > 1e-12 && h < 1 - 1e-12 ? 0.03 * std::sin(std::numbers::pi * h) : 0; });
}

// As blades do whose displacement is given at constant radius between conical walls.
TEST_P(HMesh, FollowAgreesWithABladeThatLeavesItsEndWalls) {
  expect_follow_agrees_with_the_blade(GetParam(), [](double h) { return 0.002 + 0.01 * h; });
}

TEST(BladeRow, DisplacementsTurnWithThePoint) {
  Mesh const mesh = row_mesh();
  BoundaryMotion const motion = motion_on(mesh, row_rules(blade_rule(redesign())));
  auto const points = points_of(mesh, "periodic");
  for (double angle : {pitch, -2.0, 0.01}) {
    Mat3 const turn = rotation_matrix({1, 0, 0}, angle);
    std::vector<Vec3> turned;
    for (Vec3 const& p : points) turned.push_back(turn * p);
    for (int rule : {slide_number, follow_number}) {
      auto const u = evaluate(motion, rule, points), v = evaluate(motion, rule, turned);
      for (std::size_t n = 0; n < points.size(); ++n) EXPECT_LT(distance(turn * u[n], v[n]), 1e-14);
    }
  }
}

TEST(BladeRow, HowTheBladeIsCutAndStoredChangesNothingBeyondRoundOff) {
  for (auto const& [whole, cut] : {std::pair{Blade::h_mesh, Blade::h_cut}}) {
    Mesh const a = row_mesh(whole), b = row_mesh(cut);
    auto const points = points_of(a, "periodic");
    EXPECT_LT(largest_difference(evaluate(motion_on(a, row_rules(blade_rule(redesign()))), follow_number, points),
                                 evaluate(motion_on(b, row_rules(blade_rule(redesign()))), follow_number, points)),
              1e-13);
  }
  // The O mesh: same nodes, cut and turned.
  for (Storage const& storage : {Storage{{33, 80, 81, 120}, {7, 30}, 3, 5}, Storage{{}, {20}, 7, 0}}) {
    RowMesh cut;
    cut.add(o_blade(161, 41), storage);
    cut.add(end_wall("hub", 0, 401, 5));
    cut.add(end_wall("case", 1, 401, 5), {{100, 300}, {2}, 2, 1});
    cut.add(inlet_plane(201, 5));
    cut.add(outlet_plane(41, 5));
    cut.add(periodic());
    Mesh const a = row_mesh(Blade::o_mesh), b = cut.finish();
    auto const points = points_of(a, "periodic");
    EXPECT_LT(largest_difference(evaluate(motion_on(a, row_rules(blade_rule(redesign()))), follow_number, points),
                                 evaluate(motion_on(b, row_rules(blade_rule(redesign()))), follow_number, points)),
              1e-13);
  }
}

TEST(BladeRow, AtAnotherTimeEndsSlideWithTheOtherBladeAsItMovesThen) {
  RowMesh row;
  row.add(o_blade(161, 41));
  Surface second = o_blade(161, 41);
  second.name = "second";
  second.at = [at = second.at](double s, double t) { return rotation_matrix({1, 0, 0}, pitch) * at(s, t); };
  row.add(second);
  row.add(end_wall("hub", 0, 401, 5));
  row.add(end_wall("case", 1, 401, 5));
  row.add(inlet_plane(201, 5));
  row.add(outlet_plane(41, 5));
  row.add(periodic());
  Mesh const mesh = row.finish();
  auto const rules = [](double angle_rad) {
    Motion motion = row_rules(FixedRule{});
    motion.rules[slide_number].rule = CircumferentialSlideRule{{"second"}};
    motion.rules.push_back({{"second"}, make_rigid({.angle_rad = angle_rad, .axis = {{0, 0, 0}, {1, 0, 0}}}), 0, ""});
    return motion;
  };
  auto const points = points_of(mesh, "periodic");
  BoundaryMotion const now = motion_on(mesh, rules(0.1));
  EXPECT_NE(evaluate(now.with(rules(0.2)), slide_number, points_of(mesh, "inlet")),
            evaluate(now, slide_number, points_of(mesh, "inlet")));
  expect_same_as_made_then(boundary_of(mesh), rules(0.1), rules(0.2),
                           {{slide_number, points_of(mesh, "inlet")}, {follow_number, points}});
}

TEST(BladeRow, BladesOfDifferentMotionsAreSaidToBeFollowedByTheirMean) {
  auto const row_of = [](bool whole, Rule second) {
    RowMesh row;
    auto const copy_of_blade = [](Surface surface) {
      surface.name = "second";
      surface.at = [at = surface.at](double s, double t) { return rotation_matrix({1, 0, 0}, pitch) * at(s, t); };
      return surface;
    };
    if (whole) {
      row.add(o_blade(161, 41));
      row.add(copy_of_blade(o_blade(161, 41)));
    } else {
      for (bool const suction : {true, false}) {
        row.add(h_side(suction, 81, 41));
        row.add(copy_of_blade(h_side(suction, 81, 41)));
      }
    }
    row.add(end_wall("hub", 0, 401, 5));
    row.add(end_wall("case", 1, 401, 5));
    row.add(inlet_plane(201, 5));
    row.add(outlet_plane(41, 5));
    row.add(periodic());
    Motion motion = row_rules(blade_rule(redesign()));
    motion.rules[slide_number].rule = CircumferentialSlideRule{{"blade", "second"}};
    motion.rules[follow_number].rule = FollowRule{{"blade", "second"}};
    motion.rules.push_back({{"second"}, std::move(second), 0, ""});
    std::string said;
    Mesh const mesh = row.finish();
    BoundaryMotion const moves = motion_on(mesh, motion);
    for (std::string const& note : moves.notes()) said += note + "\n";
    return said;
  };
  for (bool const whole : {true, false}) {
    expect_all_in(row_of(whole, FixedRule{}), {"'blade', 'second'", "do not move alike", "mean", "`of`"});
    EXPECT_EQ(row_of(whole, blade_rule(redesign())).find("alike"), std::string::npos);
  }
}

TEST(BladeRow, TheAxisMayBeAnywhere) {
  RigidTransform const placed = rotation_about({1, 2, 3}, {1, -2, 0.5}, 0.8).then({Mat3{}, {10, -20, 5}});
  RowMesh here, there;
  for (RowMesh* row : {&here, &there}) {
    row->add(o_blade(161, 41));
    row->add(end_wall("hub", 0, 401, 5));
    row->add(end_wall("case", 1, 401, 5));
    row->add(inlet_plane(201, 5));
    row->add(outlet_plane(41, 5));
    row->add(periodic());
  }
  Mesh const a = here.finish(), b = there.finish(placed);
  FunctionRule const rule = blade_rule(redesign());
  FunctionRule const rule_there{"moved", [&](std::span<Vec3 const> points, std::span<Vec3> out) {
                                  std::vector<Vec3> back;
                                  for (Vec3 const& p : points) back.push_back(placed.inverse()(p));
                                  rule.function(back, out);
                                  for (Vec3& u : out) u = placed.rotation * u;
                                }};
  Motion motion_there = row_rules(rule_there);
  motion_there.axis = {placed({-3, 0, 0}), 5.0 * (placed.rotation * Vec3{1, 0, 0})};
  BoundaryMotion const ma = motion_on(a, row_rules(rule)), mb = motion_on(b, motion_there);
  for (auto const& [name, r] : {std::pair{"inlet", slide_number}, {"periodic", follow_number}}) {
    auto const u = evaluate(ma, r, points_of(a, name)), v = evaluate(mb, r, points_of(b, name));
    for (std::size_t n = 0; n < u.size(); ++n) EXPECT_LT(distance(placed.rotation * u[n], v[n]), 1e-11);
  }
}

TEST(BladeRow, WithoutSlippingEndWallsSpanIsTakenFromTheBladesOwnRadii) {
  // A blade in a cylindrical annulus, turned by an angle that is linear in radius.
  auto const twist = [](double r) { return 0.1 + 0.2 * (r - 1); };
  FunctionRule const rule{"twist", [&](std::span<Vec3 const> points, std::span<Vec3> out) {
                            for (std::size_t n = 0; n < points.size(); ++n)
                              out[n] = rotation_matrix({1, 0, 0}, twist(radius_of(points[n]))) * points[n] - points[n];
                          }};
  RowMesh row;
  row.add({"blade",
           PatchKind::wall,
           {81, 21},
           [](double s, double t) {
             double const phi = 2 * std::numbers::pi * (s == 1 ? 0 : s);
             return cylindrical(-0.3 * std::cos(phi), 1 + t, 0.05 * std::sin(phi));
           },
           {}});
  for (double x : {-1.0, 1.0})
    row.add({x < 0 ? "inlet" : "outlet",
             PatchKind::inflow,
             {11, 5},
             [x](double s, double t) { return cylindrical(x, 1 + s, pitch * t); },
             {}});
  row.add({"periodic",
           PatchKind::other,
           {21, 11},
           [](double s, double t) { return cylindrical(2 * s - 1, 1 + t, 0); },
           {}});
  Mesh const mesh = row.finish();
  BoundaryMotion const motion = motion_on(mesh, row_rules(rule, true, false));
  for (auto const& [name, r] :
       {std::pair{"inlet", slide_number}, {"outlet", slide_number}, {"periodic", follow_number}}) {
    auto const points = points_of(mesh, name);
    auto const u = evaluate(motion, r, points);
    for (std::size_t n = 0; n < points.size(); ++n)
      EXPECT_LT(distance(points[n] + u[n], rotation_matrix({1, 0, 0}, twist(radius_of(points[n]))) * points[n]), 1e-12);
  }
}

TEST(BladeRow, ATipGapLeavesTheMotionOfTheTipBeyondIt) {
  RowMesh row;
  Surface blade = o_blade(161, 41);
  blade.at = [](double s, double t) { return blade_point(2 * std::numbers::pi * (s == 1 ? 0 : s), 0.95 * t); };
  row.add(blade);
  row.add({"blade",
           PatchKind::wall,
           {81, 9},
           [](double s, double t) {  // the tip face, from side to side
             double const phi = std::numbers::pi * s;
             Vec3 const a = blade_point(phi, 0.95);
             double const lower = angle_of(blade_point(-phi, 0.95));
             return cylindrical(a.x, radius(a.x, 0.95), angle_of(a) + t * (lower - angle_of(a)));
           },
           {}});
  row.add(end_wall("hub", 0, 401, 5));
  row.add(end_wall("case", 1, 401, 5));
  row.add(inlet_plane(201, 5));
  row.add(outlet_plane(41, 5));
  row.add(periodic());
  Mesh const mesh = row.finish();
  BoundaryMotion const motion = motion_on(mesh, row_rules(blade_rule(redesign())));
  for (auto const& [c, h] : {std::pair{0, 0.3}, {0, 0.94}, {0, 0.97}, {0, 1.0}}) {
    Vec3 const p = cylindrical(inlet(h), radius(inlet(h), h), 0.5);
    Vec3 const q = p + evaluate(motion, slide_number, {p}).front();
    EXPECT_NEAR(angle_of(q) - 0.5, redesign().angle(c, std::min(h, 0.95)), 2e-6);
  }
  std::string notes;
  for (auto const& n : motion.notes()) notes += n + "\n";
  expect_all_in(notes, {"tip face", "left out", "1 closed and 0 open"});
}

TEST(BladeRow, ASideOpenAtTheTrailingEdgeCountsAsTwoSides) {
  RowMesh row;  // a C: from the trailing edge around the leading edge and back, the blunt end left open
  row.add({"blade", PatchKind::wall, {141, 41}, [](double s, double t) { return blade_point(-2.9 + 5.8 * s, t); }, {}});
  row.add(end_wall("hub", 0, 401, 5));
  row.add(end_wall("case", 1, 401, 5));
  row.add(inlet_plane(201, 5));
  row.add(outlet_plane(41, 5));
  row.add(periodic());
  Mesh const mesh = row.finish();
  BoundaryMotion const motion = motion_on(mesh, row_rules(blade_rule(redesign())));
  auto const points = points_of(mesh, "inlet");
  auto const u = evaluate(motion, slide_number, points);
  for (std::size_t n = 0; n < points.size(); ++n)
    EXPECT_NEAR(angle_of(points[n] + u[n]) - angle_of(points[n]),
                redesign().angle(0, span_of(points[n].x, radius_of(points[n]))), 2e-6);
}

TEST(BladeRow, AFlatInletWithoutPatchIsFoundAtTheMostUpstreamNodes) {
  RowMesh row;
  row.add(o_blade(161, 41));
  Surface hub_wall = end_wall("hub", 0, 401, 5), case_wall = end_wall("case", 1, 401, 5);
  auto const flat = [](double h) {
    return [h](double s, double t) {
      double const x = -0.6 + s * (outlet + 0.6);
      return cylindrical(x, radius(x, h), pitch * t);
    };
  };
  hub_wall.at = flat(0);
  case_wall.at = flat(1);
  row.add(hub_wall);
  row.add(case_wall);
  row.add(periodic());
  Mesh const mesh = row.finish();
  Motion motion;
  motion.rules = {{{"blade"}, blade_rule(redesign()), 0, ""},
                  {{"periodic"}, FollowRule{{"blade"}}, 0, ""},
                  {{"hub", "case"}, SlipRule{.surface = SlipRule::Surface::revolution}, 0, ""}};
  BoundaryMotion const surface = motion_on(mesh, motion);
  for (double h : {0.0, 0.5, 1.0}) {
    Vec3 const end = cylindrical(-0.6, radius(-0.6, h), 0.1);
    EXPECT_LT(norm(evaluate(surface, 1, {end}).front()), 1e-12);
    double const x = 0.5 * (-0.6 + leading(h));
    Vec3 const p = cylindrical(x, radius(x, h), 0.1), q = p + evaluate(surface, 1, {p}).front();
    EXPECT_NEAR(angle_of(q) - 0.1, 0.5 * redesign().angle(0, h), 2e-6);
  }
}

TEST(BladeRow, SinglePrecisionCoordinatesChangeTheMotionBySinglePrecision) {
  Mesh const mesh = row_mesh(Blade::o_cut);
  Mesh rounded = row_mesh(Blade::o_cut);
  for (Index n = 0; n < rounded.n_nodes(); ++n) {
    Vec3 const p = rounded.coordinates[n];
    rounded.coordinates.set(n, {double(float(p.x)), double(float(p.y)), double(float(p.z))});
  }
  auto const points = points_of(mesh, "periodic");
  EXPECT_LT(largest_difference(evaluate(motion_on(mesh, row_rules(blade_rule(redesign()))), follow_number, points),
                               evaluate(motion_on(rounded, row_rules(blade_rule(redesign()))), follow_number, points)),
            2e-6);
}

TEST(BladeRow, ASlidePatchBesideTheBladeIsRefused) {
  RowMesh row;
  row.add(o_blade(41, 11));
  row.add({"inlet", PatchKind::inflow, {11, 5}, [](double s, double t) { return cylindrical(s - 0.3, 1.2, t); }, {}});
  Mesh const mesh = row.finish();
  Motion motion;
  motion.rules = {{{"blade"}, RigidRule{}, 0, ""}, {{"inlet"}, CircumferentialSlideRule{{"blade"}}, 0, "case.toml:7"}};
  expect_all_in(message_of<MotionError>([&] { motion_on(mesh, motion); }), {"case.toml:7", "'inlet'", "mid-chord"});
}

TEST(BladeRow, ABladeThatIsNoBladeIsRefusedWithAReason) {
  RowMesh row;
  row.add({"blade", PatchKind::wall, {11, 11}, [](double s, double t) { return cylindrical(0.3, 1 + s, t); }, {}});
  row.add(inlet_plane(11, 5));
  Mesh const mesh = row.finish();
  Motion motion;
  motion.rules = {{{"blade"}, RigidRule{}, 0, ""}, {{"inlet"}, CircumferentialSlideRule{{"blade"}}, 0, "case.toml:7"}};
  expect_all_in(message_of<MotionError>([&] { motion_on(mesh, motion); }), {"case.toml:7", "axial chord"});
}

TEST(BoundaryMotion, DirectRulesAreEvaluatedExactly) {
  Mesh const mesh = row_mesh();
  Vec3 const t{1.0 / 3, -0.1, 1e-7};
  Motion motion;
  motion.rules = {{{"blade"}, FixedRule{}, 0, ""},
                  {{"inlet"}, make_rigid({.translation = t}), 0, ""},
                  {{"outlet"},
                   FunctionRule{"sum",
                                [](std::span<Vec3 const> points, std::span<Vec3> out) {
                                  for (std::size_t n = 0; n < points.size(); ++n)
                                    out[n] = {points[n].x + points[n].y, 0, points[n].z};
                                }},
                   0,
                   ""}};
  BoundaryMotion const surface = motion_on(mesh, motion);
  auto const points = points_of(mesh, "inlet");
  for (Vec3 const& u : evaluate(surface, 0, points)) EXPECT_EQ(u, (Vec3{0, 0, 0}));
  for (Vec3 const& u : evaluate(surface, 1, points)) EXPECT_EQ(u, t);
  auto const u = evaluate(surface, 2, points);
  for (std::size_t n = 0; n < points.size(); ++n) EXPECT_EQ(u[n], (Vec3{points[n].x + points[n].y, 0, points[n].z}));
}

TEST(BoundaryMotion, SaysWhichRulesAreExplicit) {
  Mesh const mesh = row_mesh();
  BoundaryMotion const surface = motion_on(mesh, row_rules(FixedRule{}));
  EXPECT_TRUE(surface.is_explicit(blade_rule_number));
  EXPECT_TRUE(surface.is_explicit(slide_number));
  EXPECT_TRUE(surface.is_explicit(follow_number));
  EXPECT_FALSE(surface.is_explicit(slip_number));
  std::vector<Vec3> p(1), u(1), too_many(2);
  EXPECT_THROW(surface.displacement(slip_number, p, u), MotionError);
  EXPECT_THROW(surface.displacement(blade_rule_number, p, too_many), MotionError);
}

TEST(BoundaryMotion, DisplacementsThatAreNotFiniteNameRulePointAndValue) {
  Mesh const mesh = row_mesh();
  Motion motion;
  motion.rules = {{{"inlet"},
                   FunctionRule{"formula dx = 1 / (x - 3)",
                                [](std::span<Vec3 const> points, std::span<Vec3> out) {
                                  for (std::size_t n = 0; n < points.size(); ++n)
                                    out[n] = {1 / (points[n].x - 3), 0, 0};
                                }},
                   0,
                   "case.toml:12"}};
  BoundaryMotion const surface = motion_on(mesh, motion);
  expect_all_in(message_of<MotionError>([&] {
                  evaluate(surface, 0, {{1, 0, 0}, {3, 4, 5}});
                }),
                {"case.toml:12", "formula dx = 1 / (x - 3)", "(3, 4, 5)", "inf"});
}

}  // namespace
}  // namespace gridmorph
