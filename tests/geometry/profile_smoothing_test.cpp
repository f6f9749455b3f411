// Profiles through points in single precision, against the analytic curves that the points were taken from.
#include <gridmorph/geometry/profile_smoothing.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace gridmorph::test {
namespace {

using MeridionalPoints = std::vector<std::pair<double, double>>;
using Wall = std::function<double(double)>;

/// One unit in the last place of the coordinates here, which are about 1.
constexpr double unit = 1.2e-7;

double rippled(double a) { return 0.6 + 0.05 * std::sin(4 * a); }

/// A node of a wall about the x axis as a file in single precision has it.
std::pair<double, double> rounded(double axial, double radius, double angle) {
  return {double(float(axial)),
          std::hypot(double(float(radius * std::cos(angle))), double(float(radius * std::sin(angle))))};
}

/// Nodes anywhere, but for two stretches without any, and pairs of them close together.
MeridionalPoints scattered(Wall const& wall, int n) {
  MeridionalPoints out{rounded(0, wall(0), 0.1), rounded(1, wall(1), 0.1)};
  std::mt19937 random(4);
  std::uniform_real_distribution<> anywhere(0, 1);
  while (int(out.size()) < n) {
    double const a = anywhere(random), theta = 0.5 * anywhere(random);
    if (std::abs(a - 0.3) < 0.02 || std::abs(a - 0.9) < 0.03) continue;
    out.push_back(rounded(a, wall(a), theta));
    if (out.size() % 3 == 0) out.push_back(rounded(a + 2e-5, wall(a + 2e-5), theta));
  }
  return out;
}

/// Circumferential lines of an H mesh.
MeridionalPoints stations(Wall const& wall, int n) {
  MeridionalPoints out;
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < 20; ++k) out.push_back(rounded(double(i) / (n - 1), wall(double(i) / (n - 1)), 0.02 * k));
  return out;
}

double largest_error(RevolutionProfile const& profile, Wall const& wall, double from = 0, double to = 1) {
  double most = 0;
  for (int i = 0; i <= 10000; ++i) {
    double const a = from + (to - from) * i / 10000;
    most = std::max(most, std::abs(profile(a) - wall(a)));
  }
  return most;
}

RevolutionProfile smoothed(MeridionalPoints const& points) {
  RevolutionProfile out = RevolutionProfile::from_points(points);
  smooth(out, points, 0.7 * unit);
  return out;
}

TEST(SmoothedProfile, IsWithinAFractionOfARoundingOfASmoothWall) {
  Wall const walls[] = {[](double) { return 0.7; }, [](double a) { return 0.4 + 0.3 * a; }, rippled,
                        [](double a) { return 2.1 - std::sqrt(2.5 - a * a); }};
  for (Wall const& wall : walls)
    for (MeridionalPoints const& points : {scattered(wall, 800), scattered(wall, 30000), stations(wall, 150)}) {
      RevolutionProfile const profile = smoothed(points);
      EXPECT_LT(largest_error(profile, wall), 0.6 * unit);
      EXPECT_LT(profile.deviation, 1.1 * unit);
    }
  // As it is through the points themselves, rounding grows where points are close together beside a stretch of none.
  MeridionalPoints const points = scattered(rippled, 30000);
  EXPECT_GT(largest_error(RevolutionProfile::from_points(points), rippled), 3 * unit);
}

TEST(SmoothedProfile, KeepsKinksAndFeaturesThatAreFiner) {
  Wall const kink = [](double a) { return a < 0.5 ? 0.6 : 0.6 + 0.3 * (a - 0.5); };
  Wall const ridge = [](double a) { return 0.6 + 0.01 * std::exp(-std::pow((a - 0.5) / 0.02, 2)); };
  for (MeridionalPoints const& points : {scattered(kink, 3000), stations(kink, 301)}) {
    RevolutionProfile const raw = RevolutionProfile::from_points(points), out = smoothed(points);
    EXPECT_LT(largest_error(out, kink), 1.01 * largest_error(raw, kink));
    EXPECT_LT(largest_error(out, kink, 0, 0.48), 0.5 * unit);
    EXPECT_LT(largest_error(out, kink, 0.52, 1), 0.5 * unit);
  }
  EXPECT_LT(largest_error(smoothed(scattered(ridge, 3000)), ridge), 1.5 * unit);
  EXPECT_LT(largest_error(smoothed(stations(ridge, 301)), ridge), 1.5 * unit);
}

TEST(SmoothedProfile, IsItselfWithoutRoundingAndForAConstantRadius) {
  MeridionalPoints const points = scattered(rippled, 500);
  RevolutionProfile const raw = RevolutionProfile::from_points(points);
  RevolutionProfile out = raw;
  smooth(out, points, 0);
  EXPECT_TRUE(out.knots == raw.knots);
  MeridionalPoints constant;
  for (auto const& [a, r] : points) constant.emplace_back(a, 0.7f);
  for (double const a : {-0.2, 0.3, 0.31, 0.77, 1.1}) EXPECT_EQ(smoothed(constant)(a), double(0.7f));
}

TEST(SmoothedProfile, DoesNotDependOnTheOrderOfThePointsOrOnTheirUnit) {
  MeridionalPoints points = scattered(rippled, 800), scaled;
  for (auto const& [a, r] : points) scaled.emplace_back(1024 * a, 1024 * r);
  RevolutionProfile const one = smoothed(points);
  RevolutionProfile other = RevolutionProfile::from_points(scaled);
  smooth(other, scaled, 1024 * 0.7 * unit);
  std::shuffle(points.begin(), points.end(), std::mt19937(3));
  EXPECT_TRUE(smoothed(points).knots == one.knots);
  for (int i = 0; i <= 1000; ++i) EXPECT_NEAR(other(1.024 * i) / 1024, one(0.001 * i), 1e-3 * unit);
}

}  // namespace
}  // namespace gridmorph::test
