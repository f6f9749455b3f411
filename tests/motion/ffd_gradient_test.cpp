// Gradients of control points: against the rule itself, centred differences of the rules, and whole morphs.
#include "support/expect_error.hpp"
#include "support/functional_of_morph.hpp"
#include "support/made_bodies.hpp"
#include "support/mesh_builders.hpp"
#include "support/motions.hpp"
#include "support/transpose_check.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/morph/parameter_gradient.hpp>

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace gridmorph::test {
namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;

FfdRule random_ffd(std::array<int, 3> counts, double size, unsigned seed) {
  Random random(seed);
  FfdRule out;
  out.counts = counts;
  for (std::size_t a = 0; a < 3; ++a) out.degree[a] = std::min(3, counts[a] - 1);
  for (std::size_t n = 0; n < out.size(); ++n) out.displacement.push_back(random.vector(size));
  out.share = 0.75;
  return out;
}

std::vector<Vec3> random_list(std::size_t n, unsigned seed) {
  Random random(seed);
  std::vector<Vec3> out(n);
  for (Vec3& v : out) v = random.vector(1);
  return out;
}

/// The motion with other numbers: x, y, z of all control points of its first rule.
ParametricMotion by_numbers(Motion const& motion) {
  return [motion](std::span<double const> p) {
    Motion out = motion;
    auto& d = std::get<FfdRule>(out.rules[0].rule).displacement;
    for (std::size_t n = 0; n < d.size(); ++n) d[n] = {p[3 * n], p[3 * n + 1], p[3 * n + 2]};
    return out;
  };
}

std::vector<double> numbers_of(FfdRule const& rule) {
  std::vector<double> out;
  for (Vec3 const& d : rule.displacement) out.insert(out.end(), {d.x, d.y, d.z});
  return out;
}

/// A body among sides that stand, and one that goes along with it.
Motion motion_of_body(FfdRule const& lattice, bool with_attached) {
  Motion out = motion({rule({"body"}, lattice)});
  std::vector<std::string> sides{"i_min", "j_min", "j_max", "k_min", "k_max"};
  if (with_attached)
    out.rules.push_back(rule({"i_max"}, AttachedRule{{"body"}, AttachedRule::How::shift, {}}, 1));
  else
    sides.emplace_back("i_max");
  out.rules.push_back(rule(sides, FixedRule{}));
  return out;
}

Mesh box_with_hole() {
  return box_around({6, 5, 5}, [](Vec3 const& c) { return distance(c, {3, 2.5, 2.5}) < 1.2; });
}

/// Against what the rules give: b is linear in d, so g . b(d) - g . b(0) is the gradient times d.
void expect_products_agree(MorphPlan const& plan, Motion const& motion) {
  auto const& lattice = std::get<FfdRule>(motion.rules[0].rule);
  std::vector<Vec3> const g = random_list(plan.boundary_nodes().size(), 3);
  std::vector<Vec3> const slopes = ffd_gradient(plan, 0, g);
  ASSERT_EQ(slopes.size(), lattice.size());
  Motion still = motion;
  std::get<FfdRule>(still.rules[0].rule).displacement.assign(lattice.size(), {});
  std::vector<Vec3> const b = plan.boundary_displacement(motion), b0 = plan.boundary_displacement(still);
  double forwards = 0, backwards = 0, size = 0;
  for (std::size_t m = 0; m < g.size(); ++m) {
    forwards += dot(g[m], b[m] - b0[m]);
    size += norm(g[m]) * norm(b[m] - b0[m]);
  }
  for (std::size_t n = 0; n < slopes.size(); ++n) backwards += dot(slopes[n], lattice.displacement[n]);
  ASSERT_GT(size, 0);
  EXPECT_LE(std::abs(forwards - backwards), 1e-13 * size);
}

void expect_slopes_of_the_rules(MorphPlan const& plan, Motion const& motion) {
  auto const& lattice = std::get<FfdRule>(motion.rules[0].rule);
  std::vector<Vec3> const g = random_list(plan.boundary_nodes().size(), 4);
  std::vector<Vec3> const slopes = ffd_gradient(plan, 0, g);
  std::vector<double> const p = numbers_of(lattice), steps(p.size(), 1e-3);
  std::vector<double> const other = parameter_gradient(plan, by_numbers(motion), p, steps, g);
  for (std::size_t n = 0; n < slopes.size(); ++n)
    EXPECT_LE(distance(slopes[n], {other[3 * n], other[3 * n + 1], other[3 * n + 2]}), 1e-10) << n;
}

TEST(FfdGradient, IsTheTransposeOfTheRuleOnBlocksAndElements) {
  Mesh const elements = box_with_hole(), blocks = o_grid(0.8, 12);
  Motion const on_elements = motion_of_body(random_ffd({4, 3, 3}, 0.1, 1), false),
               on_blocks = motion({rule({"body"}, random_ffd({3, 4, 2}, 0.02, 2)), rule({"far"}, FixedRule{})});
  for (auto const& [mesh, moves] : {std::pair(&elements, &on_elements), std::pair(&blocks, &on_blocks)}) {
    MorphPlan const plan(*mesh, *moves);
    expect_products_agree(plan, *moves);
    expect_slopes_of_the_rules(plan, *moves);
  }
}

TEST(FfdGradient, HoldsForWhatGoesAlongWithTheLattice) {
  Mesh const mesh = box_with_hole();
  Motion const moves = motion_of_body(random_ffd({3, 3, 3}, 0.1, 5), true);
  MorphPlan const plan(mesh, moves);
  expect_slopes_of_the_rules(plan, moves);
  // The side alone: nothing of it stands in the lattice.
  std::vector<Vec3> g(plan.boundary_nodes().size());
  for (auto const& place : plan.boundary_places())
    if (mesh.patches[place.patch].name == "i_max") g[place.boundary_node] = {1, 0, 0};
  double sum = 0;
  for (Vec3 const& slope : ffd_gradient(plan, 0, g)) sum += slope.x;
  EXPECT_GT(sum, 1);
}

TEST(FfdGradient, OfControlPointsThatAFaceHoldsIsZero) {
  Mesh const mesh = box_with_hole();
  FfdRule lattice = random_ffd({6, 3, 3}, 0, 6);
  lattice.box = FfdBox{{1.9, -1, -1}, {Vec3{1.4, 0, 0}, Vec3{0, 8, 0}, Vec3{0, 0, 8}}};  // ends in the body
  Motion const moves = motion_of_body(lattice, false);
  PlanOptions options;
  options.elements.motion = 0.1;
  MorphPlan const plan(mesh, moves, options);
  std::vector<Vec3> const slopes = ffd_gradient(plan, 0, random_list(plan.boundary_nodes().size(), 7));
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 6; ++i) EXPECT_EQ(slopes[lattice.number(i, j, k)] == Vec3{}, i >= 4) << i << j << k;
}

void expect_slopes_of_whole_morphs(Mesh const& mesh, Motion const& moves) {
  auto const& lattice = std::get<FfdRule>(moves.rules[0].rule);
  MorphPlan const plan(mesh, moves);
  FunctionalOfMorph<Exec> const functional(plan, mesh.coordinates);
  auto const of_numbers = by_numbers(moves);
  std::vector<double> const p = numbers_of(lattice);
  std::vector<Vec3> const slopes = ffd_gradient(plan, 0, functional.gradient());
  double const h = 1e-4;
  for (std::size_t n = 0; n < slopes.size(); n += 5) {
    std::size_t const k = 3 * n + n % 3;
    std::vector<double> up = p, down = p;
    up[k] += h;
    down[k] -= h;
    double const difference = (functional.of(of_numbers(up)) - functional.of(of_numbers(down))) / (2 * h);
    double const slope = n % 3 == 0 ? slopes[n].x : n % 3 == 1 ? slopes[n].y : slopes[n].z;
    EXPECT_NE(slope, 0);
    EXPECT_NEAR(slope, difference, 1e-6 * std::abs(difference)) << n;
  }
}

TEST(FfdGradient, OfBlocksIsThatOfWholeMorphs) {
  expect_slopes_of_whole_morphs(o_grid(0.8, 12),
                                motion({rule({"body"}, random_ffd({4, 4, 3}, 0.02, 8)), rule({"far"}, FixedRule{})}));
}

TEST(FfdGradient, OfElementsIsThatOfWholeMorphs) {
  expect_slopes_of_whole_morphs(box_with_hole(), motion_of_body(random_ffd({3, 4, 3}, 0.05, 9), false));
}

TEST(FfdGradient, RefusesWhatDoesNotFit) {
  Mesh const mesh = box_with_hole();
  MorphPlan const plan(mesh, motion_of_body(random_ffd({3, 3, 3}, 0.05, 1), false));
  std::vector<Vec3> const g(plan.boundary_nodes().size());
  expect_all_in(message_of<ConfigError>([&] { (void)ffd_gradient(plan, 1, g); }), {"rule number 1", "no ffd rule"});
  EXPECT_THROW((void)ffd_gradient(plan, -1, g), ConfigError);
  EXPECT_THROW((void)ffd_gradient(plan, 7, g), ConfigError);
  EXPECT_THROW((void)ffd_gradient(plan, 0, std::span(g).first(2)), ConfigError);
}

}  // namespace
}  // namespace gridmorph::test
