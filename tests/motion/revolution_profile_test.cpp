// RevolutionProfile against the analytic curves its points were taken from.
#include "support/expect_error.hpp"

#include <gridmorph/core/error.hpp>

#include <gridmorph/geometry/cylindrical.hpp>
#include <gridmorph/geometry/slip_surface.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace gridmorph {
namespace {

using kernels::ProfileKnot;
using kernels::ProfileView;

using test::expect_all_in;
using test::message_of;
using Points = std::vector<std::pair<double, double>>;

Points sample(std::function<double(double)> const& f, double lo, double hi, int n) {
  Points p;
  for (int i = 0; i < n; ++i) {
    double const a = lo + (hi - lo) * i / (n - 1);
    p.emplace_back(a, f(a));
  }
  return p;
}

double largest_error(RevolutionProfile const& profile, std::function<double(double)> const& f, double lo, double hi) {
  double worst = 0;
  for (int i = 0; i <= 10000; ++i) {
    double const a = lo + (hi - lo) * i / 10000;
    worst = std::max(worst, std::abs(profile(a) - f(a)));
  }
  return worst;
}

double wavy(double a) { return 1 + 0.1 * std::sin(4 * a); }
double cylinder_then_cone(double a) { return a < 0.5 ? 1.0 : 1.0 + 0.3 * (a - 0.5); }

TEST(RevolutionProfile, ReturnsAConstantRadiusBitForBit) {
  double const r = 0.1 + 0.2;
  Points points;
  std::mt19937 random(1);
  for (int i = 0; i < 500; ++i) points.emplace_back(std::uniform_real_distribution<>(-1, 2)(random), r);
  auto const profile = RevolutionProfile::from_points(points);
  EXPECT_EQ(profile.deviation, 0.0);
  for (double a : {-3.0, -0.9, 0.1234567, 1.3, 2.5}) EXPECT_EQ(profile(a), r);
}

TEST(RevolutionProfile, IsWithin1em10OfASmoothCurveWithAFewHundredPoints) {
  auto const profile = RevolutionProfile::from_points(sample(wavy, 0, 1, 300));
  EXPECT_LT(largest_error(profile, wavy, 0.02, 0.98), 1e-10);
  EXPECT_LT(largest_error(profile, wavy, 0, 1), 1e-9);
  EXPECT_LT(profile.deviation, 1e-15);
}

TEST(RevolutionProfile, IsAccurateAndReproducesNodesWhenPointsAreScattered) {
  Points points{{0, wavy(0)}, {1, wavy(1)}};
  std::mt19937 random(7);
  for (int i = 0; i < 5000; ++i) {
    double const a = std::uniform_real_distribution<>(0, 1)(random);
    points.emplace_back(a, wavy(a));
  }
  auto const profile = RevolutionProfile::from_points(points);
  EXPECT_LT(largest_error(profile, wavy, 0, 1), 1e-10);
  EXPECT_LT(profile.deviation, 1e-10);
}

TEST(RevolutionProfile, DoesNotDependOnTheOrderOfThePoints) {
  Points points = sample(wavy, 0, 1, 101), shuffled = points;
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(3));
  auto const a = RevolutionProfile::from_points(points), b = RevolutionProfile::from_points(shuffled);
  EXPECT_TRUE(a.knots == b.knots);
}

class NoisyProfile : public ::testing::TestWithParam<double> {};

TEST_P(NoisyProfile, ErrorStaysOfTheSizeOfTheNoise) {
  double const noise = GetParam();
  std::mt19937 random(11);
  std::uniform_real_distribution<> error(-noise, noise);
  // 40 circumferential lines of 200 stations, as an H mesh has them, every coordinate with its own noise.
  Points points;
  for (auto const& [a, r] : sample(wavy, 0, 1, 200))
    for (int k = 0; k < 40; ++k) points.emplace_back(a + error(random), r + error(random));
  auto const profile = RevolutionProfile::from_points(points);
  EXPECT_LT(largest_error(profile, wavy, 0.02, 0.98), 4e-10 + 10 * noise);
  double worst_slope = 0;
  for (ProfileKnot const& knot : profile.knots)
    worst_slope = std::max(worst_slope, std::abs(knot.slope - 0.4 * std::cos(4 * knot.axial)));
  EXPECT_LT(worst_slope, 1e-5 + 4000 * noise);
}

TEST_P(NoisyProfile, SlopesOfScatteredPointsDoNotBlowUp) {
  double const noise = GetParam();
  std::mt19937 random(12);
  std::uniform_real_distribution<> error(-noise, noise), anywhere(0, 1);
  Points points;
  for (int i = 0; i < 20000; ++i) {
    double const a = anywhere(random);
    points.emplace_back(a + error(random), wavy(a) + error(random));
  }
  auto const profile = RevolutionProfile::from_points(points);
  EXPECT_LT(largest_error(profile, wavy, 0.01, 0.99), 1e-10 + 30 * noise);
  double worst_slope = 0;
  for (ProfileKnot const& knot : profile.knots)
    if (knot.axial > 0.01 && knot.axial < 0.99)
      worst_slope = std::max(worst_slope, std::abs(knot.slope - 0.4 * std::cos(4 * knot.axial)));
  EXPECT_LT(worst_slope, 0.05);
}

INSTANTIATE_TEST_SUITE_P(RoundOffToSinglePrecision, NoisyProfile, ::testing::Values(1e-16, 1e-14, 1e-12, 6e-8));

TEST(RevolutionProfile, ReproducesStraightPiecesToRoundOffWithAKinkAtAPoint) {
  auto const profile = RevolutionProfile::from_points(sample(cylinder_then_cone, 0, 1, 101));
  // Only the piece of the cone that begins at the kink has to bend.
  EXPECT_LT(largest_error(profile, cylinder_then_cone, 0, 0.5), 1e-15);
  EXPECT_LT(largest_error(profile, cylinder_then_cone, 0.51, 1), 1e-15);
  EXPECT_LT(largest_error(profile, cylinder_then_cone, 0.5, 0.51), 0.3 * 0.01 * 4 / 27 + 1e-15);
}

TEST(RevolutionProfile, DoesNotOvershootAtKinks) {
  for (int n : {3, 4, 5, 8, 21, 50, 101, 128}) {
    auto const profile = RevolutionProfile::from_points(sample(cylinder_then_cone, 0, 1, n));
    double worst_fall = 0;
    for (int i = 0; i < 3000; ++i) worst_fall = std::max(worst_fall, profile(i / 3000.0) - profile((i + 1) / 3000.0));
    EXPECT_LT(worst_fall, 1e-15) << n << " points";
    EXPECT_GE(profile(0.0), 1 - 1e-15);
  }
}

TEST(RevolutionProfile, KeepsEveryPointOfATableWrittenByHand) {
  Points const table{{0, 1}, {0.5, 1}, {0.501, 1.1}, {1, 1.1}};
  auto const profile = RevolutionProfile::from_points(table);
  ASSERT_EQ(profile.knots.size(), table.size());
  for (auto const& [a, r] : table) EXPECT_EQ(profile(a), r);
}

/// Spacings from 1e-5 to 1, as of a blade passage with a fine hub fillet.
TEST(RevolutionProfile, FindsPiecesInBucketsAsABisectionDoes) {
  Points points;
  for (int i = 0; i <= 400; ++i) points.emplace_back(std::pow(i / 400.0, 3), wavy(std::pow(i / 400.0, 3)));
  auto const profile = RevolutionProfile::from_points(points);
  ProfileView const with_buckets = profile.view();
  ProfileView without = with_buckets;
  without.n_buckets = 0;
  ASSERT_EQ(with_buckets.n_buckets, int(profile.knots.size()) - 1);
  for (int i = 0; i < 20000; ++i) EXPECT_EQ(with_buckets.piece(i / 20000.0), without.piece(i / 20000.0)) << i;
  for (std::size_t n = 0; n + 1 < profile.knots.size(); ++n)
    EXPECT_EQ(with_buckets.piece(profile.knots[n].axial), int(n)) << profile.knots[n].axial;
}

TEST(RevolutionProfile, ContinuesItsEndSlopes) {
  auto const profile = RevolutionProfile::from_points(sample([](double a) { return 1 + 0.5 * a; }, 0, 1, 30));
  EXPECT_NEAR(profile(-2), 0, 1e-13);
  EXPECT_NEAR(profile(3), 2.5, 1e-13);
}

TEST(RevolutionProfile, ReportsHowFarPointsLieOffIt) {
  Points points = sample(wavy, 0, 1, 200);
  for (auto const& [a, r] : sample(wavy, 0, 1, 200)) points.emplace_back(a, r + 2e-5);
  auto const profile = RevolutionProfile::from_points(points);
  EXPECT_NEAR(profile.deviation, 1e-5, 1e-8);
}

TEST(RevolutionProfile, RefusesAWallAtConstantAxialPositionAndNamesThePlace) {
  Points points = sample([](double) { return 1.0; }, 0, 0.5, 40);
  for (int i = 1; i < 20; ++i) points.emplace_back(0.5, 1 + 0.01 * i);
  expect_all_in(message_of<MotionError>([&] { RevolutionProfile::from_points(points); }), {"0.5", "1.19"});
}

TEST(RevolutionProfile, RefusesPointsAtOneAxialPosition) {
  expect_all_in(message_of<MotionError>([] { RevolutionProfile::from_points({{0.25, 1}, {0.25, 2}}); }), {"0.25"});
  expect_all_in(message_of<MotionError>([] { RevolutionProfile::from_points({{0.25, 1}}); }), {"two points"});
}

TEST(RevolutionProfile, RefusesTwoSurfacesAtOnce) {
  Points together = sample(wavy, 0, 1, 200), apart = together;
  for (auto const& [a, r] : sample(wavy, 0, 1, 200)) together.emplace_back(a, r + 0.5);
  for (auto const& [a, r] : sample(wavy, 0.001, 0.999, 173)) apart.emplace_back(a, r + 0.5);
  EXPECT_THROW(RevolutionProfile::from_points(together), MotionError);
  EXPECT_THROW(RevolutionProfile::from_points(apart), MotionError);
}

TEST(RevolutionProfile, RefusesNumbersThatAreNotFinite) {
  Points points = sample(wavy, 0, 1, 20);
  points[4].second = std::nan("");
  expect_all_in(message_of<MotionError>([&] { RevolutionProfile::from_points(points); }), {"not finite"});
}

double smooth_step(double x) { return 0.455 + 0.015 * std::tanh(8 * (x - 0.02)); }

/// Axial positions as the blocks of an O4H mesh have them: several families of nodes, clusters beside gaps.
std::vector<std::pair<double, double>> uneven_points(unsigned seed, double noise) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<> unit(0, 1);
  std::normal_distribution<> scatter;
  std::vector<std::pair<double, double>> points{{-0.16, smooth_step(-0.16)}, {0.2, smooth_step(0.2)}};
  for (int k = 0; k < 600; ++k) {
    double const q = unit(random), x = k % 3 == 0   ? -0.06 + 0.12 * q
                                       : k % 3 == 1 ? -0.16 + 0.36 * q * q
                                                    : 0.2 - 0.2 * q * q * q;
    double const off_axial = noise * scatter(random);
    points.emplace_back(x + off_axial, smooth_step(x) + noise * scatter(random));
  }
  return points;
}

TEST(RevolutionProfile, OfPointsInClustersIsAsExactAsTheirNoise) {
  for (double const noise : {0.0, 1e-15, 1e-13, 1e-12, 1e-10, 1e-8})
    for (unsigned seed = 0; seed < 4; ++seed) {
      auto const profile = RevolutionProfile::from_points(uneven_points(seed, noise));
      EXPECT_LT(profile.deviation, 1e-13 + 20 * noise) << noise;
      for (double x = -0.15; x < 0.19; x += 1e-4) EXPECT_NEAR(profile(x), smooth_step(x), 1e-11 + 100 * noise) << noise;
    }
}

TEST(RevolutionProfile, DoesNotDependOnTheUnit) {
  for (double const noise : {0.0, 3e-14, 1e-13, 1e-10})
    for (double const unit : {1e-3, 1e3, 0.0254}) {
      auto const points = uneven_points(7, noise);
      auto scaled = points;
      for (auto& [a, r] : scaled) {
        a *= unit;
        r *= unit;
      }
      auto const one = RevolutionProfile::from_points(points), other = RevolutionProfile::from_points(scaled);
      for (double x = -0.16; x < 0.2; x += 1e-4)
        EXPECT_NEAR(other(unit * x) / unit, one(x), 1e-13) << noise << " " << unit;
    }
}

double wavy_step(double x) { return 0.45 + 0.01 * std::sin(12 * x) + 0.01 * std::tanh(6 * x); }

/// Nodes as a passage with resolved walls has them: clusters a few micrometres wide, a centimetre apart; several nodes
/// round the axis at each axial position.
Points clustered_points(double spacing, int in_cluster, double growth) {
  Points points;
  std::mt19937_64 random(11);
  std::uniform_real_distribution<> rounding(-1e-16, 1e-16);
  for (double first = -0.16; first < 0.2; first += 0.01) {
    double x = first, step = spacing;
    for (int n = 0; n < in_cluster; ++n, x += step, step *= growth)
      for (int round = 0; round < 3; ++round)
        points.emplace_back(x + rounding(random), wavy_step(x) + rounding(random));
  }
  return points;
}

TEST(RevolutionProfile, BetweenClustersOfPointsIsWithin1em10OfTheSizeAndTheSameInAnyUnit) {
  double const size = 0.6;
  for (double const spacing : {1e-6, 1e-5})
    for (int const in_cluster : {3, 5, 12})
      for (double const growth : {1.0, 1.25}) {
        auto const points = clustered_points(spacing, in_cluster, growth);
        auto const profile = RevolutionProfile::from_points(points);
        double const first = profile.knots.front().axial, last = profile.knots.back().axial;
        EXPECT_LT(largest_error(profile, wavy_step, first, last), 1e-10 * size) << spacing << " " << in_cluster;
        for (double const unit : {1e3, 0.0254}) {
          auto scaled = points;
          for (auto& [a, r] : scaled) a *= unit, r *= unit;
          auto const other = RevolutionProfile::from_points(scaled);
          double apart = 0;
          for (double x = first; x < last; x += 1e-4)
            apart = std::max(apart, std::abs(other(unit * x) / unit - profile(x)));
          EXPECT_LT(apart, 1e-11 * size) << spacing << " " << in_cluster << " " << unit;
        }
      }
}

TEST(RevolutionProfile, BetweenClustersOfPointsIsTheSameAboutATurnedAndShiftedAxis) {
  CylindricalFrame const frame(Axis{{0, 0, 0}, {1, 0, 0}}), turned(Axis{{0.3, -0.2, 0.7}, {1, 2, -0.5}});
  auto const meridional = [](CylindricalFrame const& of, Vec3 const& p) {
    auto const [axial, radius] = of.meridional(p);
    return std::pair(axial, radius);
  };
  Vec3 const along = turned.direction(), across = (1 / std::sqrt(5.0)) * Vec3{2, -1, 0}, third = cross(along, across);
  Points points, others;
  int n = 0;
  for (auto const& [x, r] : clustered_points(2e-6, 5, 1.2)) {
    double const angle = 0.1 * (n++ % 7);
    double const y = r * std::cos(angle), z = r * std::sin(angle);
    points.push_back(meridional(frame, {x, y, z}));
    others.push_back(meridional(turned, turned.origin() + x * along + y * across + z * third));
  }
  auto const profile = RevolutionProfile::from_points(points), other = RevolutionProfile::from_points(others);
  for (double x = -0.15; x < 0.19; x += 1e-4) EXPECT_NEAR(other(x), profile(x), 0.6e-11);
}

}  // namespace
}  // namespace gridmorph
