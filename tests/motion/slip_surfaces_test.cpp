// Which surface a patch slips on, and the projection and constraint that kernels apply.
#include "annulus.hpp"
#include "moved_nodes.hpp"
#include "support/expect_error.hpp"

#include <gridmorph/core/error.hpp>

#include <gridmorph/geometry/slip_surface.hpp>
#include <gridmorph/motion/boundary_motion.hpp>
#include <gridmorph/motion/contour.hpp>

#include <random>

namespace gridmorph {
namespace {

using kernels::SlipSurfaceView;

using test::expect_all_in;
using test::message_of;

using namespace test;  // the annulus and its formulas

SlipRule revolution() { return {.surface = SlipRule::Surface::revolution}; }

BoundaryMotion make(Mesh const& mesh, std::vector<MotionRule> rules) {
  Motion motion;
  motion.rules = std::move(rules);
  return test::motion_on(mesh, motion);
}

Surface flat(std::string name, PatchKind kind, Vec3 origin, Vec3 a, Vec3 b, std::vector<std::string> families = {}) {
  return {std::move(name), kind, {7, 9}, [=](double s, double t) { return origin + s * a + t * b; }, families};
}

TEST(SlipSurfaces, AHubSplitInPiecesIsOneProfile) {
  RowMesh row;
  row.add(end_wall("hub", 0, 201, 9), {{30, 100, 150}, {4}, 0, 1});
  Mesh const mesh = row.finish();
  BoundaryMotion const motion = make(mesh, {{{"hub"}, revolution(), 0, ""}});
  auto const first = motion.slip_surface(0);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->kind, SlipSurface::Kind::revolution);
  for (std::size_t p = 1; p < mesh.patches.size(); ++p) {
    auto const other = motion.slip_surface(int(p));
    ASSERT_TRUE(other);
    EXPECT_TRUE(other->profile.knots == first->profile.knots);
  }
  for (double x = -0.55; x < 1.1; x += 0.013) EXPECT_NEAR(first->profile(x), hub(x), 1e-10);
  EXPECT_LT(first->baseline_deviation, 1e-14);
}

class HubAndCase : public ::testing::TestWithParam<std::vector<std::string>> {};
INSTANTIATE_TEST_SUITE_P(WithoutFamilyAndInOneFamily, HubAndCase,
                         ::testing::Values(std::vector<std::string>{}, std::vector<std::string>{"WALLS"}));

TEST_P(HubAndCase, UnderOneRuleHaveTheirOwnProfiles) {
  RowMesh row;
  Surface inner = end_wall("hub", 0, 201, 9), outer = end_wall("case", 1, 173, 9);
  inner.families = outer.families = GetParam();
  row.add(inner, {{77}, {}, 0, 1});
  row.add(outer, {{50}, {}, 3, 1});
  Mesh const mesh = row.finish();
  BoundaryMotion const motion = make(mesh, {{{"type:wall"}, revolution(), 0, ""}});
  for (double x = -0.5; x < 1.1; x += 0.013) {
    for (int p : {0, 1}) EXPECT_NEAR(motion.slip_surface(p)->profile(x), hub(x), 1e-9);
    for (int p : {2, 3}) EXPECT_NEAR(motion.slip_surface(p)->profile(x), shroud(x), 1e-9);
  }
}

TEST(SlipSurfaces, TwoSymmetryPlanesOfOneFamilyAreTwoPlanes) {
  RowMesh row;
  row.add(flat("low", PatchKind::symmetry, {0, 0, 0.5}, {1, 0, 0}, {0, 2, 0}, {"sym"}));
  row.add(flat("high", PatchKind::symmetry, {0, 0, 0.75}, {1, 0, 0}, {0, 2, 0}, {"sym"}));
  row.add(flat("beside", PatchKind::symmetry, {1, 0, 0.5}, {1, 0, 0}, {0, 2, 0}, {"sym"}));
  Mesh const mesh = row.finish();
  BoundaryMotion const motion = make(mesh, {});
  for (int p : {0, 1, 2}) {
    auto const s = motion.slip_surface(p);
    ASSERT_TRUE(s);
    EXPECT_EQ(s->kind, SlipSurface::Kind::plane);
    EXPECT_EQ(std::abs(s->direction.z), 1.0);
    EXPECT_EQ(s->direction.x, 0.0);
    EXPECT_EQ(s->origin.z, p == 1 ? 0.75 : 0.5);
    EXPECT_EQ(s->baseline_deviation, 0.0);
  }
  EXPECT_EQ(motion.slip_surface(0)->origin, motion.slip_surface(2)->origin);
}

TEST(SlipSurfaces, ATiltedPlaneIsFoundAnywhere) {
  RowMesh row;
  row.add(flat("sym", PatchKind::symmetry, {0, 0, 0.5}, {1, 0, 0}, {0, 2, 0}));
  RigidTransform const placed = rotation_about({1, 2, 3}, {1, -2, 0.5}, 0.8);
  Mesh const mesh = row.finish(placed);
  BoundaryMotion const motion = make(mesh, {});
  auto const* const s = motion.slip_surface(0);
  ASSERT_TRUE(s);
  EXPECT_NEAR(std::abs(dot(s->direction, placed.rotation * Vec3{0, 0, 1})), 1, 1e-14);
  EXPECT_LT(s->baseline_deviation, 1e-14);
}

TEST(SlipSurfaces, APatchThatIsNotPlanarIsRefusedWithItsDeviation) {
  RowMesh row;
  row.add({"sym", PatchKind::symmetry, {9, 9}, [](double s, double t) { return Vec3{s, t, 0.01 * s * (1 - s)}; }, {}});
  Mesh const mesh = row.finish();
  expect_all_in(message_of<MotionError>([&] { make(mesh, {}); }), {"'sym'", "0.00", "nearest plane", "fixed"});
  SlipRule given;
  given.plane = {{0, 0, 1}, {0, 0, 3}};
  expect_all_in(message_of<MotionError>([&] {
                  make(mesh, {{{"sym"}, given, 0, "a.toml:5"}});
                }),
                {"a.toml:5", "given plane", "up to 1 off"});
}

TEST(SlipSurfaces, ACollapsedPatchHasNoPlaneOfItsOwn) {
  RowMesh row;
  row.add({"pole", PatchKind::symmetry, {9, 9}, [](double s, double) { return Vec3{s, 0, 0}; }, {}});
  Mesh const mesh = row.finish();
  expect_all_in(message_of<MotionError>([&] { make(mesh, {}); }), {"'pole'", "line"});
  SlipRule given;
  given.plane = {{0, 0, 0}, {0, 1, 0}};
  EXPECT_EQ(make(mesh, {{{"pole"}, given, 0, ""}}).slip_surface(0)->direction, (Vec3{0, 1, 0}));
}

TEST(SlipSurfaces, ABladeIsNoSurfaceOfRevolution) {
  RowMesh row;
  row.add(o_blade(81, 21));
  Mesh const mesh = row.finish();
  expect_all_in(message_of<MotionError>([&] {
                  make(mesh, {{{"blade"}, revolution(), 0, "a.toml:5"}});
                }),
                {"a.toml:5", "'blade'", "surface"});
}

TEST(SlipSurfaces, FreeRulesHaveASurfaceOnlyWhenConstrained) {
  RowMesh row;
  row.add(flat("a", PatchKind::other, {0, 0, 0.5}, {1, 0, 0}, {0, 2, 0}));
  row.add(flat("b", PatchKind::other, {0, 0, 0.5}, {1, 0, 0}, {0, 2, 0}));
  row.add(flat("c", PatchKind::other, {0, 0, 0.5}, {1, 0, 0}, {0, 2, 0}));
  row.add(flat("d", PatchKind::other, {0, 0, 0.5}, {1, 0, 0}, {0, 2, 0}));
  Mesh const mesh = row.finish();
  BoundaryMotion const motion = make(mesh, {{{"a"}, FreeRule{}, 0, ""},
                                            {{"b"}, FreeRule{FreeRule::Constraint::axial}, 0, ""},
                                            {{"c"}, FreeRule{FreeRule::Constraint::plane}, 0, ""}});
  EXPECT_FALSE(motion.slip_surface(0));
  EXPECT_EQ(motion.slip_surface(1)->kind, SlipSurface::Kind::axial);
  EXPECT_EQ(motion.slip_surface(2)->kind, SlipSurface::Kind::plane);
  EXPECT_FALSE(motion.slip_surface(3));
}

/// The profile of the hub at 60 places, moved outwards.
std::vector<std::pair<double, double>> hub_moved_by(double outwards) {
  std::vector<std::pair<double, double>> out;
  for (int i = 0; i < 60; ++i) {
    double const x = -1 + 3.0 * i / 59;
    out.emplace_back(x, hub(x) + outwards);
  }
  return out;
}

TEST(SlipSurfaces, AGivenProfileIsUsedAndItsDistanceReported) {
  RowMesh row;
  row.add(end_wall("hub", 0, 101, 5));
  Mesh const mesh = row.finish();
  SlipRule rule = revolution();
  rule.profile = hub_moved_by(2e-4);
  BoundaryMotion const motion = make(mesh, {{{"hub"}, rule, 0, ""}});
  EXPECT_NEAR(motion.slip_surface(0)->profile(0.3), hub(0.3) + 2e-4, 1e-6);
  EXPECT_NEAR(motion.slip_surface(0)->baseline_deviation, 2e-4, 1e-6);
}

TEST(SlipSurfaces, AProfileFarFromTheWallIsRefusedWithItsDistance) {
  RowMesh row;
  row.add(end_wall("hub", 0, 101, 5));
  Mesh const mesh = row.finish();
  SlipRule rule = revolution();
  rule.profile = hub_moved_by(0.25);
  auto const message = message_of<MotionError>([&] { make(mesh, {{{"hub"}, rule, 0, "case.toml:7"}}); });
  expect_all_in(message,
                {"case.toml:7", "patch 'hub'", "0.25 off the given profile", "axial", "allowed: 0.00", "contour"});
}

TEST(Contour, PutsNodesOnTheNewProfileAtTheirAngleAndAxialPosition) {
  RigidTransform const placed = rotation_about({1, 2, 3}, {1, -2, 0.5}, 0.8);
  Axis const axis{placed({0, 0, 0}), placed.rotation * Vec3{1, 0, 0}};
  auto const profile = hub_moved_by(-0.05);
  for (double const share : {1.0, 0.5, 0.0}) {
    FunctionRule const rule = make_contour(profile, axis, "here", share);
    for (double x = -0.9; x < 1.9; x += 0.07) {
      double const theta = 5 * x;
      Vec3 const p = placed(cylindrical(x, hub(x), theta)),
                 wanted = placed(cylindrical(x, hub(x) - share * 0.05, theta));
      Vec3 u;
      rule.function({&p, 1}, {&u, 1});
      EXPECT_LT(distance(p + u, wanted), 2e-7) << x;
      if (share == 0) {
        EXPECT_EQ(u, (Vec3{0, 0, 0}));
      }
    }
  }
}

TEST(Contour, MovesAWallAcrossTheAxisAlongIt) {
  FunctionRule const rule = make_contour({{0.5, 0}, {0.5, 0.3}, {0.6, 0.8}, {0.6, 1}}, Axis{}, "here");
  for (Vec3 const& p : {Vec3{0.2, 0, 0}, Vec3{0.2, 0.1, 0.2}, Vec3{0.45, 0.5, 0.5}}) {
    Vec3 u;
    rule.function({&p, 1}, {&u, 1});
    EXPECT_EQ(u.y, 0);
    EXPECT_EQ(u.z, 0);
    double const r = std::hypot(p.y, p.z);
    if (r < 0.3) {
      EXPECT_NEAR(p.x + u.x, 0.5, 1e-12);
    }
    EXPECT_GE(p.x + u.x, 0.5 - 1e-12);
    EXPECT_LE(p.x + u.x, 0.6 + 1e-12);
  }
}

TEST(Contour, RefusesNodesBeyondItsEnds) {
  FunctionRule const rule = make_contour({{0, 1}, {1, 1.1}}, Axis{}, "case.toml:7");
  Vec3 const p{1.5, 1, 0};
  Vec3 u;
  expect_all_in(message_of<MotionError>([&] {
                  rule.function({&p, 1}, {&u, 1});
                }),
                {"case.toml:7", "(1.5, 1, 0)", "beyond the ends of the profile by 0.5"});
}

// ---- projection and constraint ------------------------------------------------------------------------------------

/// The surface and the baseline nodes of a placed hub, in single precision when asked: nodes off by noise.
struct PlacedHub {
  RigidTransform placed = rotation_about({1, 2, 3}, {1, -2, 0.5}, 0.8);
  std::vector<Vec3> nodes;
  SlipSurface surface;

  explicit PlacedHub(bool single) {
    RowMesh row;
    row.add(end_wall("hub", 0, 201, 9));
    Mesh mesh = row.finish(placed);
    for (Index n = 0; n < mesh.n_nodes(); ++n) {
      Vec3 p = mesh.coordinates[n];
      if (single) p = {double(float(p.x)), double(float(p.y)), double(float(p.z))};
      mesh.coordinates.set(n, p);
      if (n < 201 * 9) nodes.push_back(p);
    }
    Motion motion;
    motion.axis = {placed({5, 0, 0}), placed.rotation * Vec3{-2, 0, 0}};
    motion.rules = {{{"hub"}, revolution(), 0, ""}};
    surface = *BoundaryMotion(mesh, resolve(mesh, motion)).slip_surface(0);
  }
  /// Distance from the analytic hub, radially.
  double off(Vec3 const& p) const {
    Vec3 const q = placed.inverse()(p);
    return radius_of(q) - hub(q.x);
  }
};

TEST(SlipSurfaceView, ProjectsRadiallyAtConstantAxialPositionAndAngle) {
  PlacedHub const hub_wall(false);
  auto const view = hub_wall.surface.view();
  std::mt19937 random(1);
  std::uniform_real_distribution<> x(-0.5, 1), r(0.5, 2), theta(-3, 3);
  for (int n = 0; n < 1000; ++n) {
    Vec3 const p = cylindrical(x(random), r(random), theta(random));
    Vec3 const q = hub_wall.placed.inverse()(view.project(hub_wall.placed(p)));
    EXPECT_NEAR(q.x, p.x, 1e-13);
    EXPECT_NEAR(angle_of(q), angle_of(p), 1e-13);
    EXPECT_NEAR(radius_of(q), hub(p.x), 1e-9);
  }
}

TEST(SlipSurfaceView, ConstrainedNodesSlideOnTheSurface) {
  PlacedHub const hub_wall(false);
  auto const view = hub_wall.surface.view();
  std::mt19937 random(2);
  std::uniform_real_distribution<> d(-0.05, 0.05);
  for (Vec3 const& p : hub_wall.nodes) {
    Vec3 const u{d(random), d(random), d(random)}, v = view.constrain(p, u);
    Vec3 const wanted = view.project(p + u);
    EXPECT_LT(distance(p + v, wanted), 1e-13);
    Vec3 const q = hub_wall.placed.inverse()(p + v);
    if (q.x > inlet(0) && q.x < outlet) {
      EXPECT_NEAR(hub_wall.off(p + v), 0, 1e-9);
    }
  }
}

TEST(SlipSurfaceView, ZeroDisplacementStaysExactlyZeroForNodesOffTheSurfaceByNoise) {
  PlacedHub const hub_wall(true);
  auto const view = hub_wall.surface.view();
  EXPECT_GT(view.baseline_deviation, 1e-10);
  for (Vec3 const& p : hub_wall.nodes) EXPECT_EQ(view.constrain(p, {0, 0, 0}), (Vec3{0, 0, 0}));
}

TEST(SlipSurfaceView, ATurnAboutTheAxisComesBackBitForBit) {
  for (bool single : {false, true}) {
    PlacedHub const hub_wall(single);
    auto const view = hub_wall.surface.view();
    RigidRule const turn = make_rigid({.angle_rad = 0.1, .axis = {view.origin, view.direction}});
    for (Vec3 const& p : hub_wall.nodes) {
      Vec3 const u = displacement(turn, p);
      EXPECT_EQ(view.constrain(p, u), u);
    }
  }
}

TEST(SlipSurfaceView, ANodesOwnNoiseIsKeptNotRemoved) {
  PlacedHub const hub_wall(true);
  auto const view = hub_wall.surface.view();
  Vec3 const along = hub_wall.placed.rotation * Vec3{0.01, 0, 0};
  for (Vec3 const& p : hub_wall.nodes) {
    Vec3 const q = p + view.constrain(p, along);
    auto const offset = [&](Vec3 const& at) { return distance(at, view.origin) > 0 ? norm(at - view.project(at)) : 0; };
    EXPECT_NEAR(offset(q), offset(p), 1e-13);
  }
}

TEST(SlipSurfaceView, APointOnTheAxisHasNoRadialDirectionAndStays) {
  PlacedHub const hub_wall(false);
  auto const view = hub_wall.surface.view();
  Vec3 const p = view.origin;
  EXPECT_EQ(view.project(p), p);
}

TEST(SlipSurfaceView, PlaneAndAxialRemoveOneComponentOnly) {
  Vec3 const n = (1.0 / 3) * Vec3{1, 2, 2};
  SlipSurface plane;
  plane.kind = SlipSurface::Kind::plane;
  plane.origin = {1, 1, 1};
  plane.direction = n;
  plane.size = 1;
  SlipSurface axial = plane;
  axial.kind = SlipSurface::Kind::axial;
  std::mt19937 random(4);
  std::uniform_real_distribution<> d(-1, 1);
  for (int i = 0; i < 1000; ++i) {
    Vec3 const free{d(random), d(random), d(random)}, u{d(random), d(random), d(random)};
    Vec3 const on = plane.view().project(free);
    EXPECT_NEAR(dot(on - plane.origin, n), 0, 1e-15);
    EXPECT_LT(norm(cross(on - free, n)), 1e-15);
    for (SlipSurface const* s : {&plane, &axial}) {
      Vec3 const v = s->view().constrain(on, u);
      EXPECT_NEAR(dot(v, n), 0, 1e-15);
      EXPECT_LT(norm(cross(u - v, n)), 1e-15);
      EXPECT_EQ(s->view().constrain(on, v), v);
      EXPECT_EQ(s->view().constrain(on, {0, 0, 0}), (Vec3{0, 0, 0}));
    }
    // A node that the baseline mesh has off the plane comes to it when it moves at all.
    EXPECT_NEAR(dot(free + plane.view().constrain(free, u) - plane.origin, n), 0, 1e-14);
  }
}

/// Two displacements of every point: by the first and by the second surface. (nvcc takes no device lambda inside TEST,
/// which makes a private function.)
template <class Space>
struct ConstrainByBoth {
  Kokkos::View<SlipSurfaceView const*, Space> surfaces;
  Kokkos::View<Vec3 const*, Space> points;
  Vec3 u;
  Kokkos::View<Vec3*, Space> result;

  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    result(2 * i) = surfaces(0).constrain(points(i), u);
    result(2 * i + 1) = surfaces(1).constrain(points(i), u);
  }
};

TEST(SlipSurfaceTable, KernelsSeeTheSameSurfacesBitForBit) {
  PlacedHub const hub_wall(false);
  SlipSurface plane;
  plane.direction = {0, 0, 1};
  plane.size = 1;
  Kokkos::DefaultExecutionSpace const exec;
  using Space = Kokkos::DefaultExecutionSpace::memory_space;
  SlipSurfaceTable<Space> const table(exec, {plane, hub_wall.surface});
  int const n = int(hub_wall.nodes.size());
  Kokkos::View<Vec3*, Space> points("gridmorph::test::points", n), result("gridmorph::test::result", 2 * n);
  auto const points_h = Kokkos::create_mirror_view(points);
  for (int i = 0; i < n; ++i) points_h(i) = hub_wall.nodes[i];
  Kokkos::deep_copy(points, points_h);
  Vec3 const u{0.01, 0.02, -0.03};
  Kokkos::parallel_for("gridmorph::test::constrain", Kokkos::RangePolicy<Kokkos::DefaultExecutionSpace>(exec, 0, n),
                       ConstrainByBoth<Space>{table.surfaces, points, u, result});
  auto const result_h = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), result);
  for (int i = 0; i < n; ++i) {
    EXPECT_EQ(result_h(2 * i), plane.view().constrain(hub_wall.nodes[i], u));
    EXPECT_EQ(result_h(2 * i + 1), hub_wall.surface.view().constrain(hub_wall.nodes[i], u));
  }
}

}  // namespace
}  // namespace gridmorph
