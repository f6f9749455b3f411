// A real cascade of elements: its blade, those behind its periodic sides, and sides that follow it.
#include "io/io_support.hpp"
#include "support/reduced.hpp"
#include "support/transpose_check.hpp"
#include "support/unstructured_case.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/mesh/repeated_elements.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

namespace gridmorph::test {
namespace {

TEST(Cascade, ItsBladeTurnsBetweenNeighboursThatTurnWithIt) {
  // When the sides stood still, 0.17 of 0.22 was left of the smallest scaled Jacobian after 5 degrees.
  constexpr double degrees = std::numbers::pi / 180;
  UnstructuredCase const c(read_mesh(shared_mesh("mesh_vki_turbine.su2")));
  PlanOptions options;
  options.boundary_layers.push_back(
      {.walls = {"airfoil"}, .extent = BoundaryLayer::Extent::thickness, .thickness = 1e-3});
  double const before = c.quality(c.mesh.coordinates)[Measure::minimum_angle_deg].min;
  for (double const angle : {5.0, -5.0, 10.0}) {
    auto const turned = rotation_about({0.018, -0.02, 0}, {0, 0, 1}, angle * degrees);
    auto const m = c.morph(motion_of({rule_for({"airfoil"}, rotation({0.018, -0.02, 0}, {0, 0, 1}, angle * degrees)),
                                      rule_for({"periodic_*"}, FreeRule{})}),
                           options);
    auto const& bodies = m.prepared.plan.turns_of_bodies;
    ASSERT_EQ(bodies.size(), 1);
    ASSERT_EQ(bodies.images.size(), 7u) << "three passages on each side";
    EXPECT_EQ(c.inverted(m.x), 0);
    EXPECT_GT(c.quality(m.x)[Measure::minimum_angle_deg].min, (angle < 10 ? 0.9 : 0.6) * before) << angle;
    for (Index32 const n : m.prepared.plan.columns.node)
      EXPECT_LT(distance(m.x[n], turned(c.mesh.coordinates[n])), 1e-12);
    auto const& images = m.prepared.boundary.images;
    ASSERT_GT(images.size(), 50u);
    double moves = 0, apart = 0;
    auto const n_nodes = std::size_t(c.mesh.n_nodes());
    for (auto const& image : images) {
      Vec3 const u = m.x[image.node] - c.mesh.coordinates[image.node];
      EXPECT_LT(distance(u, m.x[image.owner] - c.mesh.coordinates[image.owner]), 1e-15);
      moves = std::max(moves, norm(u));
      double sums[2] = {0, 0};
      for (std::size_t k = 0; k < bodies.images.size(); ++k) {
        sums[0] += bodies.share[k * n_nodes + std::size_t(image.node)];
        sums[1] += bodies.share[k * n_nodes + std::size_t(image.owner)];
      }
      apart = std::max(apart, std::abs(sums[0] - sums[1]));
    }
    EXPECT_GT(moves, 1e-4) << "the sides of the passage turn too";
    EXPECT_LT(apart, 0.02) << "shares are those of the infinite row, nearly";
  }
}

TEST(Cascade, ItsVelocitiesAreThoseOfDifferences) {
  using Exec = UnstructuredCase::Host;
  UnstructuredCase const c(read_mesh(shared_mesh("mesh_vki_turbine.su2")));
  auto const prepared =
      prepare(c.mesh, c.topology, c.face_patches,
              motion_of({rule_for({"airfoil"}, rotation({0.018, -0.02, 0}, {0, 0, 1}, std::numbers::pi / 18)),
                         rule_for({"periodic_*"}, FreeRule{})}),
              PlanOptions{});
  ASSERT_EQ(prepared.plan.turns_of_bodies.images.size(), 7u);
  auto const morpher = MorpherAccess::of(Exec(), prepared.plan, c.mesh.coordinates, {1, true});
  auto const view = [](std::vector<Vec3> const& v) {
    return Kokkos::View<Vec3 const*, Kokkos::HostSpace>(v.data(), v.size());
  };
  std::vector<Vec3> const at = prepared.boundary_displacement();
  std::vector<Vec3> rate, sides[2];
  constexpr double h = 1e-5;
  for (std::size_t k = 0; k < at.size(); ++k) {
    Vec3 const x = c.mesh.coordinates[prepared.plan.known[k]];
    // Turns on, shifts and bends; inlet and outlet stand.
    bool const stands = norm(at[k]) == 0;
    rate.push_back(stands ? Vec3{} : Vec3{-x.y + 0.01, x.x + 5 * x.x * x.x, 0});
    sides[0].push_back(at[k] - h * rate[k]);
    sides[1].push_back(at[k] + h * rate[k]);
  }
  Coordinates v(c.mesh.n_nodes()), u[2]{Coordinates(c.mesh.n_nodes()), Coordinates(c.mesh.n_nodes())};
  morpher.velocities(Exec(), view(at), view(rate), v);
  for (int s = 0; s < 2; ++s) morpher.displacements(Exec(), view(sides[s]), u[s]);
  Exec().fence();
  double error = 0, size = 0;
  for (Index n = 0; n < v.size(); ++n) {
    error = std::max(error, distance(v[n], (0.5 / h) * (u[1][n] - u[0][n])));
    size = std::max(size, norm(v[n]));
  }
  EXPECT_GT(size, 0.01);
  EXPECT_LT(error, 1e-7 * size);
}

TEST(Cascade, ItsTransposeHasTheProductsOfItsVelocities) {
  UnstructuredCase const c(read_mesh(shared_mesh("mesh_vki_turbine.su2")));
  PlanOptions options;
  options.boundary_layers.push_back(
      {.walls = {"airfoil"}, .extent = BoundaryLayer::Extent::thickness, .thickness = 1e-3});
  auto const prepared =
      prepare(c.mesh, c.topology, c.face_patches,
              motion_of({rule_for({"airfoil"}, rotation({0.018, -0.02, 0}, {0, 0, 1}, std::numbers::pi / 18)),
                         rule_for({"periodic_*"}, FreeRule{})}),
              options);
  LinearisedMorph<UnstructuredCase::Host> const at(prepared.plan, c.mesh.coordinates, prepared.boundary_displacement());
  EXPECT_LE(product_error(at, 1), 1e-13);
}

// ---- blades from hub to case
// ----------------------------------------------------------------------------------------

/// The section, each element once.
UnstructuredCase section_of_cascade() {
  Mesh mesh = read_mesh(shared_mesh("mesh_vki_turbine.su2"));
  (void)leave_out_repeated_elements(mesh);
  return UnstructuredCase(std::move(mesh));
}

/// Layers of a plane mesh from hub to case. Those at both ends are half as thick as some faces of hub and case are
/// long, so that columns stand on these alone.
Mesh stacked(Mesh const& plane, std::function<Vec3(Vec3 const& p, double share)> const& place, int layers) {
  Index32 const n = Index32(plane.n_nodes());
  Mesh out;
  out.dimension = 3;
  out.source = "stacked cascade";
  out.add_zone("stack", Index(n) * (layers + 1));
  out.coordinates = Coordinates(out.n_nodes());
  for (int k = 0; k <= layers; ++k) {
    constexpr double thin = 0.009;
    double const share = k == 0 ? 0 : k == layers ? 1 : thin + (1 - 2 * thin) * (k - 1) / (layers - 2);
    for (Index32 i = 0; i < n; ++i) out.coordinates.set(i + k * n, place(plane.coordinates[i], share));
  }
  std::vector<Index32> nodes;
  auto const lifted = [&](std::span<Index32 const> of, int k, bool back) {
    nodes.clear();
    for (Index32 const i : of) nodes.push_back(i + k * n);
    if (back)
      for (std::size_t c = of.size(); c-- > 0;) nodes.push_back(of[c] + (k + 1) * n);
    else
      for (Index32 const i : of) nodes.push_back(i + (k + 1) * n);
    return std::span<Index32 const>(nodes);
  };
  for (int k = 0; k < layers; ++k)
    for (Index e = 0; e < plane.n_elements(); ++e)
      out.add_element(ElementType::hexahedron, lifted(plane.elements.nodes[e], k, false));
  for (Patch const& of : plane.patches) {
    Patch& patch = out.patches.emplace_back(of);
    patch.faces = {};
    for (int k = 0; k < layers; ++k)
      for (Index f = 0; f < of.faces.size(); ++f) patch.faces.add(lifted(of.faces[f], k, true));
  }
  for (int const end : {0, layers}) {
    Patch& patch = out.patches.emplace_back();
    patch.name = end == 0 ? "hub" : "case";
    patch.kind = PatchKind::wall;
    patch.zone = 0;
    for (Index e = 0; e < plane.n_elements(); ++e) {
      auto const face = plane.elements.nodes[e];
      nodes.assign(face.begin(), face.end());
      for (Index32& i : nodes) i += end * n;
      patch.faces.add(nodes);
    }
  }
  for (Connection const& of : plane.connections) {
    Connection& c = out.connections.emplace_back(of);
    for (int k = 1; k <= layers; ++k)
      for (std::size_t i = 0; i < of.nodes.size(); ++i) {
        c.nodes.push_back(of.nodes[i] + k * n);
        c.donor_nodes.push_back(of.donor_nodes[i] + k * n);
      }
  }
  return out;
}

MotionRule rotated_blade(double angle) { return rule_for({"airfoil"}, rotation({0.018, -0.02, 0}, {0, 0, 1}, angle)); }

PlanOptions first_millimetre() {
  PlanOptions options;
  options.boundary_layers.push_back(
      {.walls = {"airfoil"}, .extent = BoundaryLayer::Extent::thickness, .thickness = 1e-3});
  return options;
}

/// Copies are known both or not at all, or their mean is of what nobody has set.
void expect_whole_columns(UnstructuredMorphed const& m) {
  std::vector<std::uint8_t> slides(m.x.size(), 0);
  for (Index32 const n : m.prepared.plan.sliding) slides[n] = 1;
  for (auto const& image : m.prepared.boundary.images) EXPECT_EQ(slides[image.node], slides[image.owner]);
}

/// How far the layers' displacements are from those of their section, at most, by the largest of these.
double apart_from(UnstructuredCase const& flat, UnstructuredMorphed const& section, UnstructuredCase const& c,
                  UnstructuredMorphed const& m, std::function<Vec3(Vec3 const&)> const& in_section) {
  double largest = 0, apart = 0;
  for (Index n = 0; n < c.mesh.n_nodes(); ++n) {
    Index const below = n % flat.mesh.n_nodes();
    Vec3 const u = section.x[below] - flat.mesh.coordinates[below];
    largest = std::max(largest, norm(u));
    apart = std::max(apart, distance(in_section(m.x[n]) - in_section(c.mesh.coordinates[n]), u));
  }
  return apart / largest;
}

TEST(StackedCascade, BetweenPlanesEveryLayerMovesAsTheSectionDoes) {
  // By distances alone, 0.07 of 0.22 was left of the smallest scaled Jacobian after 5 degrees.
  UnstructuredCase const flat = section_of_cascade();
  int const layers = reduced() ? 3 : 6;
  UnstructuredCase const c(stacked(
      flat.mesh,
      [](Vec3 const& p, double share) {
        return Vec3{p.x, p.y, 0.06 * share};
      },
      layers));
  double const angle = std::numbers::pi / 18;
  auto const section =
      flat.morph(motion_of({rotated_blade(angle), rule_for({"periodic_*"}, FreeRule{})}), first_millimetre());
  auto const m = c.morph(motion_of({rotated_blade(angle), rule_for({"periodic_*"}, FreeRule{}),
                                    rule_for({"hub", "case"}, SlipRule{.surface = SlipRule::Surface::plane})}),
                         first_millimetre());
  EXPECT_EQ(c.inverted(m.x), 0);
  expect_whole_columns(m);
  EXPECT_LT(apart_from(flat, section, c, m, [](Vec3 const& p) { return p; }), 0.04);
}

/// A passage between a hub and a case that are cones around the x axis: places by those of the section.
struct Cones {
  static constexpr int blades = 40;
  static constexpr double radius = blades * 5.749995e-2 / (2 * std::numbers::pi);

  static double hub(double x) { return radius * (0.9 + 0.05 * (x + 0.055) / 0.135); }
  static double casing(double x) { return radius * (1.08 - 0.05 * (x + 0.055) / 0.135); }
  static Vec3 place(Vec3 const& p, double share) {
    double const r = hub(p.x) + share * (casing(p.x) - hub(p.x));
    return {p.x, r * std::sin(p.y / radius), r * std::cos(p.y / radius)};
  }
  static Vec3 in_section(Vec3 const& p) { return {p.x, radius * std::atan2(p.y, p.z), 0}; }
  static double share(Vec3 const& p) { return (std::hypot(p.y, p.z) - hub(p.x)) / (casing(p.x) - hub(p.x)); }
};

UnstructuredCase cascade_between_cones(Mesh const& section, int layers = 3) {
  Mesh mesh = stacked(section, Cones::place, layers);
  for (Connection& side : mesh.connections)
    if (side.periodic)
      side.periodic = periodic_rotation({0, 0, 0}, {1, 0, 0}, -side.periodic->translation.y / Cones::radius);
  return UnstructuredCase(std::move(mesh));
}

TEST(StackedCascade, BetweenConesEveryLayerMovesAsTheSectionDoes) {
  // By the lattice thousands of elements were inverted at 10 degrees.
  UnstructuredCase const flat = section_of_cascade();
  UnstructuredCase const c = cascade_between_cones(flat.mesh, reduced() ? 3 : 6);
  for (double const angle : {-5.0, 10.0}) {
    auto const turned = rotation_about({0.018, -0.02, 0}, {0, 0, 1}, angle * std::numbers::pi / 180);
    auto const section =
        flat.morph(motion_of({rotated_blade(angle * std::numbers::pi / 180), rule_for({"periodic_*"}, FreeRule{})}),
                   first_millimetre());
    FunctionRule const in_its_layer{"in its layer", [&](std::span<Vec3 const> p, std::span<Vec3> u) {
                                      for (std::size_t n = 0; n < p.size(); ++n)
                                        u[n] = Cones::place(turned(Cones::in_section(p[n])), Cones::share(p[n])) - p[n];
                                    }};
    auto const m = c.morph(motion_of({rule_for({"airfoil"}, in_its_layer), rule_for({"periodic_*"}, FreeRule{}),
                                      rule_for({"hub", "case"}, SlipRule{.surface = SlipRule::Surface::revolution})}),
                           first_millimetre());
    ASSERT_EQ(m.prepared.plan.turns_of_bodies.size(), 1);
    EXPECT_EQ(c.inverted(m.x), 0) << angle;
    expect_whole_columns(m);
    // The blades beside it shift another way there, and lengths are others at hub and case.
    EXPECT_LT(apart_from(flat, section, c, m, Cones::in_section), 0.2) << angle;
  }
}

// ---- sides that follow their blade
// ------------------------------------------------------------------------------------

/// Inlet and outlet slide with the blade's edges, the sides follow its mean line.
Motion with_sides(Rule blade, std::vector<MotionRule> more = {}) {
  more.push_back(rule_for({"airfoil"}, std::move(blade)));
  more.push_back(rule_for({"inflow", "outflow"}, CircumferentialSlideRule{{"airfoil"}}));
  more.push_back(rule_for({"periodic_*"}, FollowRule{{"airfoil"}}));
  Motion motion = motion_of(std::move(more));
  motion.axis = {{0, 0, 0}, {1, 0, 0}};
  return motion;
}
MotionRule on_cones() { return rule_for({"hub", "case"}, SlipRule{.surface = SlipRule::Surface::revolution}); }

/// What a displacement of the section is in all layers between the cones.
Rule in_layers(std::function<Vec3(Vec3 const&)> moved) {
  return FunctionRule{"in its layer", [moved = std::move(moved)](std::span<Vec3 const> p, std::span<Vec3> u) {
                        for (std::size_t n = 0; n < p.size(); ++n)
                          u[n] = Cones::place(moved(Cones::in_section(p[n])), Cones::share(p[n])) - p[n];
                      }};
}
Rule in_plane(std::function<Vec3(Vec3 const&)> moved) {
  return FunctionRule{"in the plane", [moved = std::move(moved)](std::span<Vec3 const> p, std::span<Vec3> u) {
                        for (std::size_t n = 0; n < p.size(); ++n) u[n] = moved(p[n]) - p[n];
                      }};
}
std::function<Vec3(Vec3 const&)> turned(double degrees) {
  auto const turn = rotation_about({0.018, -0.02, 0}, {0, 0, 1}, degrees * std::numbers::pi / 180);
  return [turn](Vec3 const& p) { return turn(p); };
}

TEST(FollowingSides, ABladeThatGoesAlongThePitchTakesItsPassageAlong) {
  // Amid the chord, the sides do what the blade does: so does what is between, whatever inlet and outlet do.
  UnstructuredCase const flat = section_of_cascade(), c = cascade_between_cones(flat.mesh);
  constexpr double way = 0.01;
  auto const shifted = [](Vec3 const& p) { return Vec3{p.x, p.y + way, p.z}; };
  auto const expect = [&](UnstructuredCase const& of, Motion motion, auto const& in_section) {
    for (MotionRule& rule : motion.rules)
      if (std::holds_alternative<CircumferentialSlideRule>(rule.rule)) rule.rule = FixedRule{};
    auto const m = of.morph(motion, first_millimetre());
    ASSERT_FALSE(m.prepared.plan.passage.empty());
    double apart = 0;
    for (Index n = 0; n < of.mesh.n_nodes(); ++n) {
      Vec3 const p = in_section(of.mesh.coordinates[n]);
      if (p.x > 0.01 && p.x < 0.028) apart = std::max(apart, distance(in_section(m.x[n]), shifted(p)));
    }
    EXPECT_LT(apart, 0.03 * way);
  };
  expect(flat, with_sides(in_plane(shifted)), [](Vec3 const& p) { return p; });
  expect(c, with_sides(in_layers(shifted), {on_cones()}), Cones::in_section);
}

TEST(FollowingSides, ColumnsTurnWithTheBladeAndNothingIsInverted) {
  // By the lattice, 0.3 was left of the smallest determinant of 0.59 after 5 degrees, and elements were inverted
  // after 15.
  UnstructuredCase const flat = section_of_cascade();
  for (double const degrees : {5.0, 15.0}) {
    auto const m = flat.morph(with_sides(in_plane(turned(degrees))), first_millimetre());
    ASSERT_FALSE(m.prepared.plan.passage.empty());
    EXPECT_EQ(flat.largest_miss(m), 0);
    EXPECT_GT(flat.quality(m.x)[Measure::determinant_3x3x3].min, degrees < 10 ? 0.55 : 0.45) << degrees;
    for (Index32 const n : m.prepared.plan.columns.node)
      EXPECT_LT(distance(m.x[n], turned(degrees)(flat.mesh.coordinates[n])), 1e-12);
  }
  UnstructuredCase const c = cascade_between_cones(flat.mesh);
  auto const m = c.morph(with_sides(in_layers(turned(5)), {on_cones()}), first_millimetre());
  ASSERT_FALSE(m.prepared.plan.passage.empty());
  EXPECT_EQ(c.inverted(m.x), 0);
  EXPECT_GT(c.quality(m.x)[Measure::determinant_3x3x3].min, 0.2);
}

TEST(FollowingSides, TheirDerivativesAreThoseOfDifferences) {
  UnstructuredCase const flat = section_of_cascade(), c = cascade_between_cones(flat.mesh);
  auto const expect = [](UnstructuredCase const& of, Motion const& motion) {
    auto const prepared = prepare(of.mesh, of.topology, of.face_patches, motion, first_millimetre());
    ASSERT_FALSE(prepared.plan.passage.empty());
    auto const given = prepared.boundary_displacement();
    auto const at = [&](double t) {
      std::vector<Vec3> out = given;
      for (std::size_t k = 0; k < out.size(); ++k) {
        Vec3 const x = of.mesh.coordinates[prepared.plan.known[k]];
        out[k] += t * Vec3{0.3 * x.x + x.y, std::sin(20 * x.x) - 0.2 * x.y, of.mesh.dimension == 2 ? 0 : x.x * x.y};
      }
      return out;
    };
    auto const rate = rate_error(of, prepared.plan, at);
    EXPECT_LT(rate.error, 1e-7 * rate.largest);
    LinearisedMorph<UnstructuredCase::Host> const linear(prepared.plan, of.mesh.coordinates, given);
    EXPECT_LE(product_error(linear, 1), 1e-13);
  };
  expect(flat, with_sides(in_plane(turned(5))));
  expect(c, with_sides(in_layers(turned(5)), {on_cones()}));
}

TEST(FollowingSides, HaveNoSayWhereTheyDifferOrAnotherMethodIsAskedFor) {
  UnstructuredCase const c = section_of_cascade();
  Motion const motion = with_sides(in_plane(turned(5)));
  PlanOptions options = first_millimetre();
  for (NearFieldMethod const method : {NearFieldMethod::lattice, NearFieldMethod::layers}) {
    options.elements.method = method;
    EXPECT_TRUE(c.morph(motion, options).prepared.plan.passage.empty());
  }
  options.elements.method = NearFieldMethod::least_squares;
  auto const whole = c.morph(motion, options).prepared;
  EXPECT_FALSE(whole.plan.passage.empty());
  // Two passages of a wheel that are not alike: one side does half of what the other does.
  auto displacement = whole.boundary_displacement();
  for (Index32 const s : whole.plan.passage.slots)
    if (c.mesh.coordinates[whole.plan.known[s]].y > 0) displacement[s] = 0.5 * displacement[s];
  auto const differs =
      prepare(HostInstance(), c.mesh, c.topology, c.face_patches, whole.graph, whole.boundary, options, displacement);
  EXPECT_TRUE(differs.plan.passage.empty());
}

}  // namespace
}  // namespace gridmorph::test
