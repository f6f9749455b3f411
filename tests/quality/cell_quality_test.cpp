// Measures of single cells: analytic cells, degenerate cells, and random cells against the plain reference.
#include <gridmorph/kernels/cell_quality.hpp>

#include "quality/reference_cell.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>

namespace gridmorph {
namespace {

using kernels::CellMeasures;
using kernels::HexCell;
using kernels::larger;
using kernels::unbounded;

using test::Corners;

template <class Map>
HexCell mapped_cube(Map const& map) {
  HexCell cell;
  for (int n = 0; n < 8; ++n) cell.corner[n] = map(Vec3{double(n & 1), double(n >> 1 & 1), double(n >> 2)});
  return cell;
}

HexCell unit_cube() {
  return mapped_cube([](Vec3 const& p) { return p; });
}

HexCell mirrored(HexCell cell) {
  for (int n = 0; n < 8; n += 2) std::swap(cell.corner[n], cell.corner[n + 1]);
  return cell;
}

void expect_defined(CellMeasures const& m) {
  for (double const v : {m.determinant_2x2x2, m.determinant_3x3x3, m.smallest_corner_jacobian, m.volume, m.aspect_ratio,
                         m.minimum_angle_deg, m.equiangle_skewness})
    EXPECT_FALSE(std::isnan(v));
}

TEST(CellQuality, UnitCubeIsPerfect) {
  CellMeasures const m = cell_measures(unit_cube(), 1);
  EXPECT_DOUBLE_EQ(m.determinant_2x2x2, 1);
  EXPECT_DOUBLE_EQ(m.determinant_3x3x3, 1);
  EXPECT_DOUBLE_EQ(m.smallest_corner_jacobian, 1);
  EXPECT_DOUBLE_EQ(m.volume, 1);
  EXPECT_DOUBLE_EQ(m.aspect_ratio, 1);
  EXPECT_DOUBLE_EQ(m.minimum_angle_deg, 90);
  EXPECT_NEAR(m.equiangle_skewness, 0, 1e-15);
  EXPECT_FALSE(m.collapsed);
}

TEST(CellQuality, ShearKeepsDeterminantAndVolumeAndTiltsTheAngle) {
  double const shear = 0.75;
  CellMeasures const m = cell_measures(mapped_cube([&](Vec3 const& p) {
                                         return Vec3{2 * p.x + shear * p.z, 3 * p.y, p.z};
                                       }),
                                       1);
  EXPECT_NEAR(m.determinant_2x2x2, 1, 1e-14);
  EXPECT_NEAR(m.determinant_3x3x3, 1, 1e-14);
  EXPECT_NEAR(m.volume, 6, 1e-13);
  EXPECT_NEAR(m.aspect_ratio, 3 / 1.25, 1e-14);
  double const angle = std::atan2(1.0, shear) * 180 / std::acos(-1.0);
  EXPECT_NEAR(m.minimum_angle_deg, angle, 1e-12);
  EXPECT_NEAR(m.equiangle_skewness, (90 - angle) / 90, 1e-13);
}

TEST(CellQuality, ScaledJacobianIsTheVolumeOfUnitEdgesAtTheWorstCorner) {
  for (double const shear : {0.0, 0.75, -2.0})
    for (double const mirrored : {1.0, -1.0}) {
      HexCell const cell = mapped_cube([&](Vec3 const& p) {
        return Vec3{mirrored * (2 * p.x + shear * p.z), 3 * p.y, p.z};
      });
      EXPECT_NEAR(scaled_jacobian(hex_edges(cell), 0, mirrored), 1 / std::hypot(1, shear), 1e-14);
    }
  HexCell cell = unit_cube();
  cell.corner[7] = {0.1, 0.1, 0.1};
  // The edges that meet there are (b, a, a), (a, b, a), (a, a, b).
  double const a = -0.9, b = 0.1, length = std::sqrt(2 * a * a + b * b);
  EXPECT_NEAR(scaled_jacobian(hex_edges(cell), 0, 1), (b - a) * (b - a) * (b + 2 * a) / std::pow(length, 3), 1e-14);
}

TEST(CellQuality, ScaledJacobianLeavesCornersOfCollapsedEdgesOut) {
  HexCell wedge = unit_cube();
  wedge.corner[6] = wedge.corner[4];
  wedge.corner[7] = wedge.corner[5];
  kernels::HexEdges const edges = hex_edges(wedge);
  EXPECT_NEAR(kernels::scaled_jacobian(edges, kernels::collapsed_edges(edges), 1), std::sqrt(0.5), 1e-14);
}

// Top face turned by t against the bottom face: J(zeta) = (1 - zeta)^2 + zeta^2 + 2 zeta (1 - zeta) cos t.
TEST(CellQuality, TwistShowsInThe27PointsButNotInTheCorners) {
  for (double const t : {0.2, 1.0, 2.0}) {
    HexCell const cell = mapped_cube([&](Vec3 const& p) {
      double const c = p.z > 0 ? std::cos(t) : 1, s = p.z > 0 ? std::sin(t) : 0, x = p.x - 0.5, y = p.y - 0.5;
      return Vec3{c * x - s * y, s * x + c * y, p.z};
    });
    CellMeasures const m = cell_measures(cell, 1);
    EXPECT_NEAR(m.determinant_2x2x2, 1, 1e-14);
    EXPECT_NEAR(m.determinant_3x3x3, (1 + std::cos(t)) / 2, 1e-14);
    EXPECT_NEAR(m.volume, (2 + std::cos(t)) / 3, 1e-14);
  }
}

TEST(CellQuality, CornerPushedThroughItsCellGivesANegativeDeterminant) {
  HexCell cell = unit_cube();
  cell.corner[7] = {0.1, 0.1, 0.1};
  CellMeasures const m = cell_measures(cell, 1);
  EXPECT_LT(m.determinant_2x2x2, 0);
  EXPECT_LT(m.determinant_3x3x3, 0);
  EXPECT_LT(m.smallest_corner_jacobian, 0);
  EXPECT_GE(m.determinant_3x3x3, -1);
}

TEST(CellQuality, MirroredCellIsAsGoodWithTheOtherHandednessAndFailsWithItsOwn) {
  HexCell const cell = mapped_cube([](Vec3 const& p) { return Vec3{p.x + 0.2 * p.y * p.z, p.y + 0.1 * p.x, 2 * p.z}; });
  CellMeasures const right = cell_measures(cell, 1), left = cell_measures(mirrored(cell), -1);
  EXPECT_NEAR(left.determinant_3x3x3, right.determinant_3x3x3, 1e-14);
  EXPECT_NEAR(left.determinant_2x2x2, right.determinant_2x2x2, 1e-14);
  EXPECT_NEAR(left.volume, right.volume, 1e-14);
  EXPECT_NEAR(left.minimum_angle_deg, right.minimum_angle_deg, 1e-12);
  EXPECT_EQ(cell_measures(cell, -1).determinant_3x3x3, -1);
  EXPECT_LT(cell_measures(cell, -1).volume, 0);
}

// Face i_min collapsed to an edge: J grows linearly from it, the points on it do not count.
TEST(CellQuality, WedgeIsJudgedWithoutItsCollapsedEdge) {
  HexCell const cell = mapped_cube([](Vec3 const& p) { return Vec3{p.x, p.x * p.y, p.z}; });
  CellMeasures const m = cell_measures(cell, 1);
  EXPECT_TRUE(m.collapsed);
  EXPECT_NEAR(m.determinant_2x2x2, 1, 1e-14);
  EXPECT_NEAR(m.determinant_3x3x3, 0.5, 1e-14);
  EXPECT_NEAR(m.smallest_corner_jacobian, 1, 1e-14);
  EXPECT_NEAR(m.volume, 0.5, 1e-14);
  EXPECT_NEAR(m.aspect_ratio, std::sqrt(2.0), 1e-14);
  EXPECT_NEAR(m.minimum_angle_deg, 45, 1e-12);
}

// Face k_min collapsed to a point: J grows with the square of the distance.
TEST(CellQuality, PyramidIsJudgedWithoutItsApex) {
  HexCell const cell = mapped_cube([](Vec3 const& p) { return Vec3{(p.x - 0.5) * p.z, (p.y - 0.5) * p.z, p.z}; });
  CellMeasures const m = cell_measures(cell, 1);
  EXPECT_TRUE(m.collapsed);
  EXPECT_NEAR(m.determinant_2x2x2, 1, 1e-14);
  EXPECT_NEAR(m.determinant_3x3x3, 0.25, 1e-14);
  EXPECT_NEAR(m.volume, 1.0 / 3, 1e-14);
  expect_defined(m);
}

TEST(CellQuality, CellWithoutVolumeIsFlatWithDefinedValues) {
  CellMeasures const point = cell_measures(mapped_cube([](Vec3 const&) { return Vec3{1, 2, 3}; }), 1);
  CellMeasures const flat = cell_measures(mapped_cube([](Vec3 const& p) { return Vec3{p.x, p.y, 0}; }), 1);
  CellMeasures const line = cell_measures(mapped_cube([](Vec3 const& p) { return Vec3{p.x, 0, 0}; }), 1);
  for (CellMeasures const& m : {point, flat, line}) {
    expect_defined(m);
    EXPECT_EQ(m.determinant_3x3x3, 0);
    EXPECT_EQ(m.determinant_2x2x2, 0);
    EXPECT_EQ(m.smallest_corner_jacobian, 0);
    EXPECT_EQ(m.volume, 0);
  }
}

// A corner whose edges lie on a line, and a cell of no height, far from the origin: signs of their Jacobians are
// round-off.
TEST(CellQuality, JacobiansThatRoundOffDecidesAboutAreZeroInCellsOfAnySize) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> shift(-1, 1);
  for (double const size : {1e-6, 1.0, 1e6})
    for (double const thin : {1.0, 1e-6})
      for (int n = 0; n < 50; ++n) {
        Vec3 const origin = 100 * size * Vec3{shift(random), shift(random), shift(random)};
        double const turn = shift(random);
        auto const place = [&](Vec3 const& p) {
          return origin + size * Vec3{std::cos(turn) * p.x - std::sin(turn) * p.y,
                                      std::sin(turn) * p.x + std::cos(turn) * p.y, thin * p.z};
        };
        HexCell straight = mapped_cube(place);
        for (int k = 0; k < 2; ++k)
          straight.corner[3 + 4 * k] = 0.5 * (straight.corner[1 + 4 * k] + straight.corner[2 + 4 * k]);
        EXPECT_EQ(cell_measures(straight, 1).smallest_corner_jacobian, 0);
        EXPECT_EQ(cell_measures(straight, 1).determinant_3x3x3, 0);
        EXPECT_GT(cell_measures(mapped_cube(place), 1).smallest_corner_jacobian, 0);
        HexCell bent = straight;  // by a thousandth of a degree
        bent.corner[3] += 1e-5 * (straight.corner[0] - straight.corner[3]);
        EXPECT_LT(cell_measures(bent, 1).smallest_corner_jacobian, 0);
        HexCell const no_height = mapped_cube([&](Vec3 const& p) { return place({p.x, p.y, 1e-13 * shift(random)}); });
        EXPECT_EQ(cell_measures(no_height, 1).smallest_corner_jacobian, 0);
        EXPECT_EQ(cell_measures(no_height, 1).determinant_2x2x2, 0);
      }
}

TEST(CellQuality, CornerThatIsNotFiniteGivesTheWorstValues) {
  for (double const bad : {std::nan(""), double(HUGE_VAL)})
    for (int n = 0; n < 8; ++n) {
      HexCell cell = unit_cube();
      cell.corner[n].y = bad;
      CellMeasures const m = cell_measures(cell, 1);
      expect_defined(m);
      EXPECT_EQ(m.determinant_3x3x3, -1);
      EXPECT_LE(m.smallest_corner_jacobian, 0);
      EXPECT_EQ(determinant_3x3x3(cell, 1), -1);
      Vec3 const r = relative_displacement(unit_cube(), cell);
      EXPECT_EQ(larger(r.x, larger(r.y, r.z)), unbounded);
    }
}

HexCell random_cell(std::mt19937& random, double disturbance) {
  std::uniform_real_distribution<double> shift(-disturbance, disturbance), exponent(-4, 4);
  Vec3 const size{std::exp(exponent(random)), std::exp(exponent(random)), std::exp(exponent(random))};
  double const turn = exponent(random);
  return mapped_cube([&](Vec3 const& p) {
    Vec3 const q{size.x * (p.x + shift(random)), size.y * (p.y + shift(random)), size.z * (p.z + shift(random))};
    return Vec3{std::cos(turn) * q.x - std::sin(turn) * q.z, q.y, std::sin(turn) * q.x + std::cos(turn) * q.z};
  });
}

TEST(CellQuality, RandomCellsAgreeWithThePlainReference) {
  std::mt19937 random(7);
  int inverted = 0;
  for (int n = 0; n < 3000; ++n) {
    HexCell const cell = random_cell(random, 0.15 + 0.25 * (n % 3));
    double const handedness = n % 2 == 0 ? 1 : -1;
    HexCell const shown = handedness > 0 ? cell : mirrored(cell);
    CellMeasures const m = cell_measures(shown, handedness);
    test::ReferenceCell const r = test::reference(test::corners_of(shown), handedness);
    EXPECT_NEAR(m.determinant_2x2x2, r.determinant_2x2x2, 1e-12);
    EXPECT_NEAR(m.determinant_3x3x3, r.determinant_3x3x3, 1e-12);
    EXPECT_EQ(determinant_3x3x3(shown, handedness), m.determinant_3x3x3);
    EXPECT_NEAR(m.volume, r.volume, 1e-12 * std::abs(r.volume) + 1e-13);
    EXPECT_NEAR(m.aspect_ratio, r.aspect_ratio, 1e-12 * r.aspect_ratio);
    EXPECT_NEAR(m.minimum_angle_deg, r.minimum_angle_deg, 1e-5);  // acos near 0 degrees
    EXPECT_NEAR(m.equiangle_skewness, r.equiangle_skewness, 1e-7);
    EXPECT_EQ(m.smallest_corner_jacobian > 0, r.smallest_corner_jacobian > 0);
    inverted += m.smallest_corner_jacobian > 0 ? 0 : 1;
  }
  EXPECT_GT(inverted, 100);  // the sample holds good and bad cells
  EXPECT_LT(inverted, 2900);
}

TEST(RelativeDisplacement, IsZeroForTranslationAndTheStrainForStretching) {
  HexCell const cell = mapped_cube([](Vec3 const& p) { return Vec3{4 * p.x, 2 * p.y, p.z}; });
  HexCell moved = cell, stretched = cell;
  for (int n = 0; n < 8; ++n) {
    moved.corner[n] += Vec3{8, 16, -32};
    stretched.corner[n].y *= 1.25;
  }
  EXPECT_EQ(relative_displacement(cell, moved), (Vec3{0, 0, 0}));
  EXPECT_EQ(relative_displacement(cell, stretched), (Vec3{0, 0.25, 0}));
}

TEST(RelativeDisplacement, SkipsADirectionWhoseEdgesAreCollapsed) {
  HexCell const line = mapped_cube([](Vec3 const& p) { return Vec3{p.x, 0, 0}; });
  HexCell const longer = mapped_cube([](Vec3 const& p) { return Vec3{1.5 * p.x, 0, 0}; });
  EXPECT_EQ(relative_displacement(line, longer), (Vec3{0.5, 0, 0}));
}

TEST(RelativeDisplacement, AgreesWithThePlainReference) {
  std::mt19937 random(11);
  for (int n = 0; n < 500; ++n) {
    HexCell const before = random_cell(random, 0.2);
    HexCell after = before;
    std::uniform_real_distribution<double> shift(-0.1, 0.1);
    for (Vec3& p : after.corner) p += Vec3{shift(random), shift(random), shift(random)};
    Vec3 const r = relative_displacement(before, after);
    double const expected = test::reference_relative_displacement(test::corners_of(before), test::corners_of(after));
    EXPECT_NEAR(std::max({r.x, r.y, r.z}), expected, 1e-13 * expected);
  }
}

}  // namespace
}  // namespace gridmorph
