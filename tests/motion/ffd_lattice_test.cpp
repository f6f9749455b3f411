// Lattices of control points: weights against the definitions of the polynomials, places in lattices of any shape
// against the map itself.
#include "plain_splines.hpp"
#include "support/expect_error.hpp"
#include "support/random.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/motion/ffd/ffd_lattice.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace gridmorph::test {
namespace {

FfdRule lattice_rule(std::array<int, 3> counts, std::array<int, 3> degree) {
  FfdRule out;
  out.counts = counts;
  out.degree = degree;
  out.displacement.assign(out.size(), {});
  return out;
}

Vec3 random_place(Random& random) { return {random.unit(), random.unit(), random.unit()}; }

/// A box that leans, is sheared and bent; with `bend` 0 a parallelepiped.
Vec3 bent(Vec3 const& p, double bend) {
  return Vec3{3 * p.x + 0.4 * p.y, 1.1 * p.y - 0.2 * p.z, 0.3 * p.x + 0.6 * p.z} +
         bend * Vec3{p.y * p.y * p.z, std::sin(2 * p.x) * p.z, p.x * p.x};
}

std::vector<std::array<std::array<int, 3>, 2>> const shapes{{{{2, 2, 2}, {1, 1, 1}}},
                                                            {{{4, 3, 5}, {3, 2, 4}}},
                                                            {{{9, 4, 6}, {3, 3, 2}}},
                                                            {{{12, 2, 7}, {2, 1, 5}}},
                                                            {{{20, 3, 3}, {19, 2, 1}}}};

TEST(BSplineBasis, IsWhatTheRecursionOfDeBoorSays) {
  Random random(1);
  for (int count : {2, 3, 5, 9})
    for (int degree = 1; degree < count; ++degree) {
      BSplineBasis const basis(count, degree);
      std::vector<double> const knots = plain_knots(count, degree);
      std::vector<double> at{0, 1, 0.5, 0.25, 1e-17, std::nextafter(1.0, 0.0)};
      for (double const knot : knots) at.push_back(knot);
      for (int n = 0; n < 20; ++n) at.push_back(random.unit());
      for (double const s : at) {
        auto const values = basis.values(s);
        std::vector<double> const plain = plain_splines(knots, degree, s);
        ASSERT_GE(values.first, 0);
        ASSERT_LE(values.first + degree, count - 1);
        for (int n = 0; n < count; ++n) {
          bool const here = n >= values.first && n <= values.first + degree;
          EXPECT_NEAR(here ? values.value[n - values.first] : 0, plain[n], 1e-14)
              << count << " " << degree << " " << n << " " << s;
        }
      }
    }
}

TEST(BSplineBasis, EndsExactlyInItsFirstAndLastFunction) {
  for (int count = 2; count < 16; ++count)
    for (int degree = 1; degree < count; ++degree) {
      BSplineBasis const basis(count, degree);
      auto const low = basis.values(0), high = basis.values(1);
      EXPECT_EQ(low.first, 0);
      EXPECT_EQ(high.first + degree, count - 1);
      for (int n = 0; n <= degree; ++n) {
        EXPECT_EQ(low.value[n], n == 0 ? 1 : 0);
        EXPECT_EQ(high.value[n], n == degree ? 1 : 0);
      }
    }
}

TEST(BSplineBasis, SlopesAreThoseOfCentredDifferences) {
  Random random(2);
  for (int const degree : {1, 2, 3, 5}) {
    BSplineBasis const basis(7, degree);
    std::vector<double> const knots = plain_knots(7, degree);
    for (int n = 0; n < 30; ++n) {
      double const s = random.between(0.001, 0.999), h = 1e-6;
      if (std::abs(std::remainder(s * basis.spans(), 1.0)) < 1e-3) continue;  // not across a knot
      auto const at = basis.with_slopes(s);
      for (int m = 0; m <= degree; ++m) {
        int const i = at.first + m;
        double const difference =
            (plain_splines(knots, degree, s + h)[i] - plain_splines(knots, degree, s - h)[i]) / (2 * h);
        EXPECT_NEAR(at.slope[m], difference, 1e-7);
      }
    }
  }
}

TEST(FfdLattice, WeighsAsTheDefinitionSays) {
  Random random(3);
  for (auto const& [counts, degree] : shapes) {
    FfdRule rule = lattice_rule(counts, degree);
    rule.box = FfdBox{{0, 0, 0}, {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}};
    for (Vec3& d : rule.displacement) d = random.vector(1);
    FfdLattice const lattice(rule, "test");
    for (int n = 0; n < 50; ++n) {
      Vec3 const place = random_place(random);
      Vec3 sum{};
      lattice.for_each_weight(place, [&](std::size_t p, double w) { sum += w * rule.displacement[p]; });
      EXPECT_LE(distance(sum, plain_sum(rule, rule.displacement, place)), 1e-14);
      if (degree[0] == counts[0] - 1 && degree[1] == counts[1] - 1 && degree[2] == counts[2] - 1) {
        EXPECT_LE(distance(sum, plain_bezier(rule, rule.displacement, place)), 1e-14);
      }
    }
  }
}

TEST(FfdLattice, FindsThePlacesThatItsMapCameFrom) {
  Random random(4);
  for (double const bend : {0.0, 0.3}) {
    for (auto const& [counts, degree] : shapes) {
      FfdRule rule = lattice_rule(counts, degree);
      for (int k = 0; k < counts[2];
           ++k)  // control points in even steps: with knots between even a box is no linear map
        for (int j = 0; j < counts[1]; ++j)
          for (int i = 0; i < counts[0]; ++i)
            rule.points.push_back(
                bent({double(i) / (counts[0] - 1), double(j) / (counts[1] - 1), double(k) / (counts[2] - 1)}, bend));
      FfdLattice const lattice(rule, "test");
      for (int n = 0; n < 200; ++n) {
        Vec3 place = random_place(random);
        if (n % 4 == 0) (n % 8 == 0 ? place.x : place.z) = n % 3 == 0 ? 0 : 1;  // sides too
        auto const found = lattice.place(plain_sum(rule, rule.points, place));
        ASSERT_TRUE(found);
        EXPECT_LE(distance(*found, place), 1e-9) << bend << " " << counts[0] << " " << n;
      }
    }
  }
}

TEST(FfdLattice, HasNoPlaceForPointsOutside) {
  FfdRule rule = lattice_rule({6, 3, 4}, {3, 2, 3});
  rule.points = at_control_points(rule, [](Vec3 const& p) { return bent(p, 0.3); });
  FfdLattice const lattice(rule, "test");
  Random random(5);
  for (int n = 0; n < 200; ++n) {
    Vec3 place = random_place(random);
    double& across = n % 3 == 0 ? place.x : n % 3 == 1 ? place.y : place.z;
    across = n % 2 == 0 ? 0 : 1;
    Vec3 const side = plain_sum(rule, rule.points, place);
    across = n % 2 == 0 ? 0.02 : 0.98;
    Vec3 const inside = plain_sum(rule, rule.points, place);
    EXPECT_FALSE(lattice.place(side + 0.01 * (side - inside)));
    EXPECT_FALSE(lattice.place(side + 20.0 * (side - inside)));
    EXPECT_TRUE(lattice.place(inside));
  }
  EXPECT_FALSE(lattice.place({100, 0, 0}));
}

TEST(FfdLattice, RefusesLatticesThatFold) {
  FfdRule rule = lattice_rule({4, 2, 2}, {3, 1, 1});
  rule.points = at_control_points(rule, [](Vec3 const& p) { return p; });
  EXPECT_NO_THROW(FfdLattice(rule, "test"));
  for (std::size_t n = 0; n < rule.points.size(); ++n) {
    FfdRule folded = rule;
    folded.points[n] += Vec3{n % 4 < 2 ? 3.0 : -3.0, 0, 0};
    expect_all_in(message_of<MotionError>([&] { (void)FfdLattice(folded, "test"); }), {"test: ", "folds at"});
  }
}

TEST(FfdLattice, ItsControlPointsStandWhereLinearDisplacementsStayLinear) {
  Random random(6);
  for (auto const& [counts, degree] : shapes) {
    FfdRule rule = lattice_rule(counts, degree);
    rule.box = FfdBox{{0.3, -1, 2}, {Vec3{2, 0.1, 0}, Vec3{0.5, 1, 0.2}, Vec3{0, -0.3, 0.7}}};
    FfdLattice const lattice(rule, "test");
    for (int n = 0; n < 50; ++n) {
      Vec3 const place = random_place(random);
      auto const& e = rule.box->edges;
      Vec3 const x = rule.box->origin + place.x * e[0] + place.y * e[1] + place.z * e[2];
      auto const found = lattice.place(x);
      ASSERT_TRUE(found);
      EXPECT_LE(distance(*found, place), 1e-14);
      Vec3 sum{};
      lattice.for_each_weight(place, [&](std::size_t p, double w) {
        int const i = int(p) % counts[0], j = int(p) / counts[0] % counts[1], k = int(p) / counts[0] / counts[1];
        sum += w * lattice.control_point(i, j, k);
      });
      EXPECT_LE(distance(sum, x), 1e-13);
    }
  }
}

}  // namespace
}  // namespace gridmorph::test
