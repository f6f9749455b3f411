// One box against formulas: the line sweep, the transfinite correction, what they reproduce exactly.
#include "support/morph_run.hpp"
#include "support/motions.hpp"
#include "support/random.hpp"
#include "support/reference_box.hpp"
#include "support/scramble.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace gridmorph::test {
namespace {

std::vector<std::string> const side_patches{"v_min", "v_max", "w_min", "w_max"};

BoxField field(Mesh const& mesh, Coordinates const& c) {
  Zone const& zone = mesh.zones[0];
  BoxField f(zone.extent);
  for (Index n = 0; n < zone.size(); ++n) f.v[n] = c[n];
  return f;
}

BoxField field(Mesh const& mesh, VectorField const& at) {
  BoxField f(mesh.zones[0].extent);
  for (Index n = 0; n < mesh.n_nodes(); ++n) f.v[n] = at(mesh.coordinates[n]);
  return f;
}

double largest_difference(BoxField const& a, BoxField const& b) {
  double worst = 0;
  for (std::size_t m = 0; m < a.v.size(); ++m) worst = std::max(worst, distance(a.v[m], b.v[m]));
  return worst;
}

double weight(Law law, double t) {
  if (law == Law::c1) return 3 * std::pow(t, 2) - 2 * std::pow(t, 3);
  if (law == Law::c2) return 10 * std::pow(t, 3) - 15 * std::pow(t, 4) + 6 * std::pow(t, 5);
  return t;
}

class BoxLaw : public ::testing::TestWithParam<Law> {};

TEST_P(BoxLaw, SweepBetweenTwoKnownFacesIsThePapersFormula) {
  VectorField const f = waves(0.2);
  PlanOptions options = without_near_field();
  options.volume.law = GetParam();
  Outcome const r =
      morph(box({9, 7, 6}, Shape::curved, 1),
            motion({rule({"u_min", "u_max"}, function_rule(f)), rule(side_patches, FreeRule{})}), options);
  BoxField const expected = reference_sweep(field(r.mesh, r.mesh.coordinates), field(r.mesh, f),
                                            [&](double t) { return weight(GetParam(), t); });
  EXPECT_LT(largest_difference(field(r.mesh, r.morphed.displacement), expected), 1e-14);
}

TEST_P(BoxLaw, SixKnownFacesGiveTheBooleanSum) {
  VectorField const f = waves(0.2);
  PlanOptions options = without_near_field();
  options.volume.law = GetParam();
  Outcome const r = morph(box({9, 7, 6}, Shape::curved, 2), motion({rule({"*"}, function_rule(f))}), options);
  ASSERT_EQ(r.plan().stages.size(), 1u);
  ASSERT_EQ(r.plan().stages[0].lines.chains[0].n_s, 9) << "the wall ranks first, so the chain runs along u";
  BoxField const expected = reference_transfinite(field(r.mesh, r.mesh.coordinates), field(r.mesh, f),
                                                  [&](double t) { return weight(GetParam(), t); });
  EXPECT_LT(largest_difference(field(r.mesh, r.morphed.displacement), expected), 1e-14);
}

INSTANTIATE_TEST_SUITE_P(Laws, BoxLaw, ::testing::Values(Law::linear, Law::c1, Law::c2), [](auto const& info) {
  return std::string(info.param == Law::linear ? "linear" : info.param == Law::c1 ? "c1" : "c2");
});

TEST(Box, TheThreeLawsDiffer) {
  VectorField const f = waves(0.2);
  auto const with = [&](Law law) {
    PlanOptions options = without_near_field();
    options.volume.law = law;
    Outcome const r = morph(box({9, 7, 6}, Shape::curved, 1), motion({rule({"*"}, function_rule(f))}), options);
    return field(r.mesh, r.morphed.displacement);
  };
  EXPECT_GT(largest_difference(with(Law::linear), with(Law::c1)), 1e-3);
  EXPECT_GT(largest_difference(with(Law::c1), with(Law::c2)), 1e-4);
}

TEST(Box, TrilinearFieldsAreExactOnAStraightUniformGrid) {
  Random random(5);
  Vec3 const c[8] = {random.vector(1), random.vector(1), random.vector(1), random.vector(1),
                     random.vector(1), random.vector(1), random.vector(1), random.vector(1)};
  VectorField const f = [&](Vec3 const& p) {
    return c[0] + p.x * c[1] + p.y * c[2] + p.z * c[3] + p.x * p.y * c[4] + p.y * p.z * c[5] + p.z * p.x * c[6] +
           p.x * p.y * p.z * c[7];
  };
  Outcome const r = morph(box({9, 7, 6}, Shape::straight, 1), motion({rule({"*"}, function_rule(f))}));
  EXPECT_LT(largest_difference(field(r.mesh, r.morphed.displacement), field(r.mesh, f)), 1e-14);
}

TEST(Box, LinearFieldsOnTwoFacesAreExactBetweenThem) {
  VectorField const f = [](Vec3 const& p) { return Vec3{0.1 * p.x - 0.3 * p.y, 0.2 * p.z, p.x + p.y}; };
  Outcome const r = morph(box({9, 7, 6}, Shape::straight, 1),
                          motion({rule({"u_min", "u_max"}, function_rule(f)), rule(side_patches, FreeRule{})}));
  EXPECT_LT(largest_difference(field(r.mesh, r.morphed.displacement), field(r.mesh, f)), 1e-14);
}

TEST(Box, AKnownSideFadesOutLinearlyTowardsTheUnknownOne) {
  // On a straight uniform grid with u_min, u_max and v_min known: u = L + (1 - v) (known - L on v_min).
  VectorField const f = waves(0.2);
  Outcome const r = morph(
      box({9, 7, 6}, Shape::straight, 1),
      motion({rule({"u_min", "u_max", "v_min"}, function_rule(f)), rule({"v_max", "w_min", "w_max"}, FreeRule{})}));
  BoxField const known = field(r.mesh, f);
  BoxField expected = reference_sweep(field(r.mesh, r.mesh.coordinates), known, [](double t) { return t; });
  BoxField const line = expected;
  for (int k = 0; k < 6; ++k)
    for (int j = 0; j < 7; ++j)
      for (int i = 0; i < 9; ++i) expected(i, j, k) += (1 - j / 6.0) * (known(i, 0, k) - line(i, 0, k));
  EXPECT_LT(largest_difference(field(r.mesh, r.morphed.displacement), expected), 1e-14);
}

TEST(Box, ASideGivesItsResidualAtTheSameFractionOfTheLinesBesideIt) {
  // Lines along x are spaced evenly on v_min and ever more closely at both ends away from it. What v_min does must not
  // reach the first nodes of the crowded lines before it reaches its own nodes at that distance.
  VectorField const tent = [](Vec3 const& p) { return Vec3{0, 0, 0.2 * std::min(p.x, 2 - p.x)}; };
  for (int const thickness : {2, 6}) {
    Mesh mesh = box({9, 7, thickness}, Shape::straight, 1);
    for (Index n = 0; n < mesh.n_nodes(); ++n) {
      Vec3 p = mesh.coordinates[n];
      double const crowded = std::pow(std::min(p.x, 2 - p.x), 1 + 8 * p.y);
      p.x = p.x < 1 ? crowded : 2 - crowded;
      mesh.coordinates.set(n, p);
    }
    Outcome const r = morph(std::move(mesh), motion({rule({"u_min", "u_max", "v_min"}, function_rule(tent)),
                                                     rule({"v_max", "w_min", "w_max"}, FreeRule{})}));
    for (Index n = 0; n < r.mesh.n_nodes(); ++n) {
      Vec3 const p = r.mesh.coordinates[n];
      ASSERT_LT(distance(r.u(n), (1 - p.y) * tent(p)), 1e-14) << describe_node(r.mesh, n);
    }
  }
}

TEST(Box, OneKnownFaceIsCarriedThroughUnchanged) {
  VectorField const f = waves(0.2);
  std::vector<std::string> rest = side_patches;
  rest.push_back("u_max");
  Outcome const r =
      morph(box({9, 7, 6}, Shape::curved, 1), motion({rule({"u_min"}, function_rule(f)), rule(rest, FreeRule{})}));
  BoxField const u = field(r.mesh, r.morphed.displacement);
  for (int k = 0; k < 6; ++k)
    for (int j = 0; j < 7; ++j)
      for (int i = 0; i < 9; ++i) EXPECT_TRUE(same_bits(u(i, j, k), u(0, j, k)));
}

TEST(Box, ChainsOfTwoNodesHaveNothingToDo) {
  VectorField const f = waves(0.2);
  for (Index3 const& n : {Index3{2, 2, 2}, Index3{2, 6, 5}, Index3{7, 2, 5}, Index3{7, 6, 2}})
    for (bool all : {true, false}) {
      std::vector<MotionRule> rules{
          rule(all ? std::vector<std::string>{"*"} : std::vector<std::string>{"u_min", "u_max"}, function_rule(f))};
      if (!all) rules.push_back(rule(side_patches, FreeRule{}));
      Outcome const r = morph(box(n, Shape::curved, 3), motion(rules));
      BoxField const expected =
          all ? reference_transfinite(field(r.mesh, r.mesh.coordinates), field(r.mesh, f), [](double t) { return t; })
              : reference_sweep(field(r.mesh, r.mesh.coordinates), field(r.mesh, f), [](double t) { return t; });
      EXPECT_LT(largest_difference(field(r.mesh, r.morphed.displacement), expected), 1e-14);
    }
}

TEST(Box, TurnedAndMirroredItGivesTheSame) {
  VectorField const f = waves(0.2);
  Mesh const plain = box({9, 7, 6}, Shape::curved, 4);
  Motion const m = motion({rule({"*"}, function_rule(f))});
  Outcome const expected = morph(plain, m);
  for (unsigned seed = 1; seed <= 48; ++seed) {
    ScrambledMesh s = scramble(plain, {seed});
    Outcome const r = morph(std::move(s.mesh), m);
    double worst = 0;
    for (Index n = 0; n < r.mesh.n_nodes(); ++n) worst = std::max(worst, distance(r.u(n), expected.u(s.old_node[n])));
    EXPECT_LT(worst, 1e-14) << "seed " << seed;
  }
}

TEST(SlipOnNoisyPlanes, DisplacementsAlongTheTruePlaneAreHonouredExactly) {
  for (double const noise : {0.0, 1e-9, 1e-7}) {
    Mesh mesh = box({9, 8, 7}, Shape::straight, 3);
    Random random(5);
    for (Index n = 0; n < mesh.n_nodes(); ++n) {
      Vec3 p = mesh.coordinates[n];
      p.y += noise * random.vector(1).y;
      mesh.coordinates.set(n, p);
    }
    Motion const along = motion({rule({"u_min"}, function_rule([](Vec3 const& p) {
                                        return Vec3{0.3 + 0.1 * p.z, 0, 0.2 * p.z * (1.2 - p.z)};
                                      })),
                                 rule({"u_max"}, FixedRule{}), rule({"v_min", "v_max"}, SlipRule{}),
                                 rule({"w_min", "w_max"}, SlipRule{})});
    Outcome const run = morph(std::move(mesh), along);
    for (std::size_t n = 0; n < run.boundary.size(); ++n) {
      Index const node = run.plan().boundary_nodes[n];
      EXPECT_EQ(run.u(node), run.boundary[n]) << noise << " " << describe_node(run.mesh, node);
    }
  }
}

}  // namespace
}  // namespace gridmorph::test
