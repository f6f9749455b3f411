// Measures of single elements: analytic values, and the collapsed hexahedron as oracle where one exists.

#include <gridmorph/kernels/element_quality.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace gridmorph::test {
namespace {

using kernels::CellMeasures;
using kernels::ElementCorners;
using kernels::HexCell;

constexpr Vec3 up{0, 0, 1};

ElementCorners corners(std::vector<Vec3> const& list) {
  ElementCorners c;
  for (std::size_t n = 0; n < list.size(); ++n) c.at[n] = list[n];
  return c;
}

std::vector<Vec3> const regular_tetrahedron{{1, 1, 1}, {-1, 1, -1}, {1, -1, -1}, {-1, -1, 1}};
std::vector<Vec3> const unit_prism{{0, 0, 0}, {1, 0, 0}, {0.5, std::sqrt(0.75), 0},
                                   {0, 0, 1}, {1, 0, 1}, {0.5, std::sqrt(0.75), 1}};
std::vector<Vec3> const unit_pyramid{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, std::sqrt(0.5)}};
std::vector<Vec3> const unit_cube{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                  {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};

struct Named {
  ElementType type;
  std::vector<Vec3> corners;
  double volume, aspect, angle;
};

std::vector<Named> ideal_elements() {
  return {{ElementType::tetrahedron, regular_tetrahedron, 8.0 / 3, 1, 60},
          {ElementType::prism, unit_prism, std::sqrt(0.75) / 2, 1, 60},
          {ElementType::pyramid, unit_pyramid, std::sqrt(0.5) / 3, 1, 60},
          {ElementType::hexahedron, unit_cube, 1, 1, 90},
          {ElementType::triangle, {unit_prism[0], unit_prism[1], unit_prism[2]}, std::sqrt(0.75) / 2, 1, 60},
          {ElementType::quadrilateral, {unit_cube[0], unit_cube[1], unit_cube[2], unit_cube[3]}, 1, 1, 90}};
}

TEST(ElementQuality, IdealElementsHaveTheBestValues) {
  for (auto const& e : ideal_elements()) {
    SCOPED_TRACE(int(e.type));
    CellMeasures const m = element_measures(e.type, corners(e.corners), 1, up);
    EXPECT_NEAR(m.volume, e.volume, 1e-14);
    EXPECT_NEAR(m.determinant_2x2x2, 1, 1e-14);
    EXPECT_NEAR(m.determinant_3x3x3, 1, 1e-14);
    EXPECT_NEAR(m.aspect_ratio, e.aspect, 1e-14);
    EXPECT_NEAR(m.minimum_angle_deg, e.angle, 1e-12);
    EXPECT_NEAR(m.equiangle_skewness, 0, 1e-13);
    EXPECT_GT(m.smallest_corner_jacobian, 0);
    EXPECT_FALSE(m.collapsed);
  }
}

TEST(ElementQuality, MirroredElementsAreInvertedAndTheSignOfTheirZoneUndoesIt) {
  for (auto const& e : ideal_elements()) {
    SCOPED_TRACE(int(e.type));
    auto mirrored = e.corners;
    for (auto& p : mirrored) p.x = -p.x;
    CellMeasures const m = element_measures(e.type, corners(mirrored), 1, up);
    EXPECT_LE(m.smallest_corner_jacobian, 0);
    EXPECT_NEAR(m.volume, -e.volume, 1e-14);
    EXPECT_NEAR(m.determinant_2x2x2, -1, 1e-14);
    EXPECT_NEAR(element_volume(e.type, corners(mirrored), 1, up), -e.volume, 1e-14);
    EXPECT_NEAR(element_measures(e.type, corners(mirrored), -1, up).determinant_3x3x3, 1, 1e-14);
  }
}

TEST(ElementQuality, VolumesOfAffineImagesScaleWithTheDeterminant) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> entry(-1, 1);
  for (auto const& e : ideal_elements()) {
    for (int n = 0; n < 50; ++n) {
      Mat3 a;
      for (auto& row : a.m)
        for (double& v : row) v = entry(random);
      bool const flat = is_surface(e.type);
      if (flat) a = {{{a.m[0][0], a.m[0][1], 0}, {a.m[1][0], a.m[1][1], 0}, {0, 0, 1}}};
      Vec3 const x = a * Vec3{1, 0, 0}, y = a * Vec3{0, 1, 0}, z = a * Vec3{0, 0, 1};
      double const determinant = dot(cross(x, y), z);
      auto moved = e.corners;
      for (auto& p : moved) p = a * p + Vec3{3, -2, flat ? 0.0 : 1.0};
      CellMeasures const m = element_measures(e.type, corners(moved), 1, up);
      EXPECT_NEAR(m.volume, determinant * e.volume, 1e-13);
      EXPECT_NEAR(element_volume(e.type, corners(moved), 1, up), m.volume, 1e-14);
      EXPECT_EQ(m.smallest_corner_jacobian > 0, determinant > 0);
      // Affine images have a constant Jacobian.
      if (e.type != ElementType::tetrahedron && e.type != ElementType::triangle) {
        EXPECT_NEAR(m.determinant_3x3x3, determinant > 0 ? 1 : -1, 1e-10);
      }
    }
  }
}

TEST(ElementQuality, APyramidIsAHexahedronWhoseTopIsCollapsed) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> shift(-0.25, 0.25);
  for (int n = 0; n < 200; ++n) {
    auto pyramid = unit_pyramid;
    for (auto& p : pyramid) p += Vec3{shift(random), shift(random), shift(random)};
    auto const c = corners(pyramid);
    HexCell hexahedron;
    for (int k = 0; k < 4; ++k) hexahedron.corner[4 + k] = pyramid[4];
    hexahedron.corner[0] = pyramid[0];
    hexahedron.corner[1] = pyramid[1];
    hexahedron.corner[2] = pyramid[3];
    hexahedron.corner[3] = pyramid[2];
    CellMeasures const expected = cell_measures(hexahedron, 1);
    CellMeasures const m = element_measures(ElementType::pyramid, c, 1, up);
    EXPECT_NEAR(m.volume, expected.volume, 1e-13);
    EXPECT_NEAR(m.determinant_2x2x2, expected.determinant_2x2x2, 1e-12);
    EXPECT_NEAR(m.aspect_ratio, expected.aspect_ratio, 1e-12);
  }
}

TEST(ElementQuality, APrismIsAHexahedronWithOneCollapsedSideInVolumeAndAspectRatio) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> shift(-0.2, 0.2);
  for (int n = 0; n < 200; ++n) {
    auto prism = unit_prism;
    for (auto& p : prism) p += Vec3{shift(random), shift(random), shift(random)};
    HexCell const hexahedron{{prism[0], prism[1], prism[2], prism[2], prism[3], prism[4], prism[5], prism[5]}};
    CellMeasures const expected = cell_measures(hexahedron, 1);
    CellMeasures const m = element_measures(ElementType::prism, corners(prism), 1, up);
    EXPECT_NEAR(m.volume, expected.volume, 1e-13);
    EXPECT_NEAR(m.aspect_ratio, expected.aspect_ratio, 1e-12);
    EXPECT_GT(m.determinant_2x2x2, 0);
  }
}

TEST(ElementQuality, SkewTetrahedronHasTheScaledJacobianOfItsWorstCorner) {
  // Corner at the origin with edges 1, 1, h along the axes: J = h; the longest product of edges is that of a base
  // corner.
  for (double const h : {0.01, 0.1, 0.5}) {
    auto const c = corners({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, h}});
    double const product = 1 * std::sqrt(2.0) * std::sqrt(1 + h * h);
    EXPECT_NEAR(element_measures(ElementType::tetrahedron, c, 1, up).determinant_2x2x2, std::sqrt(2.0) * h / product,
                1e-14);
    EXPECT_NEAR(element_measures(ElementType::tetrahedron, c, 1, up).aspect_ratio, std::sqrt(2.0) / h, 1e-12);
  }
}

TEST(ElementQuality, AnglesOfATetrahedronAreThoseOfItsFourTriangles) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> shift(-0.9, 0.9);
  for (int n = 0; n < 200; ++n) {
    auto points = regular_tetrahedron;
    for (auto& p : points) p += Vec3{shift(random), shift(random), shift(random)};
    if (n % 4 == 0) points[std::size_t(n) / 4 % 4] = points[(std::size_t(n) / 4 + 1) % 4];  // an edge without length
    double smallest = 180, largest = 0;
    for (std::size_t at = 0; at < 4; ++at)
      for (std::size_t a = 0; a < 4; ++a)
        for (std::size_t b = 0; b < a; ++b) {
          if (a == at || b == at) continue;
          Vec3 const u = points[a] - points[at], v = points[b] - points[at];
          if (norm(u) == 0 || norm(v) == 0) continue;
          double const angle =
              std::acos(std::clamp(dot(u, v) / (norm(u) * norm(v)), -1.0, 1.0)) * 180 / std::acos(-1.0);
          smallest = std::min(smallest, angle);
          largest = std::max(largest, angle);
        }
    CellMeasures const m = element_measures(ElementType::tetrahedron, corners(points), 1, up);
    EXPECT_NEAR(m.minimum_angle_deg, smallest, 1e-5) << n;
    EXPECT_NEAR(m.equiangle_skewness, std::max((largest - 60) / 120, (60 - smallest) / 60), 1e-7) << n;
  }
}

TEST(ElementQuality, ACornerBeyondTheDiagonalTurnsAQuadrilateralAroundThere) {
  auto const c = corners({{0, 0, 0}, {1, 0, 0}, {0.3, 0.3, 0}, {0, 1, 0}});
  CellMeasures const m = element_measures(ElementType::quadrilateral, c, 1, up);
  EXPECT_LT(m.smallest_corner_jacobian, 0);
  EXPECT_GT(m.volume, 0);
  EXPECT_LT(m.determinant_2x2x2, 0);
}

TEST(ElementQuality, CollapsedEdgesLeaveNoTrace) {
  auto prism = unit_prism;
  prism[4] = prism[1];  // one column has no length: a pyramid with its apex there
  CellMeasures const m = element_measures(ElementType::prism, corners(prism), 1, up);
  EXPECT_TRUE(m.collapsed);
  EXPECT_GT(m.smallest_corner_jacobian, 0);
  EXPECT_TRUE(std::isfinite(m.aspect_ratio));
  EXPECT_GT(m.minimum_angle_deg, 0);
}

TEST(ElementQuality, CornersThatAreNoNumbersGiveTheWorstThereIs) {
  for (auto const& e : ideal_elements()) {
    auto broken = e.corners;
    broken[1].y = NAN;
    CellMeasures const m = element_measures(e.type, corners(broken), 1, up);
    EXPECT_EQ(m.determinant_3x3x3, -1);
    EXPECT_LE(m.smallest_corner_jacobian, 0);
    EXPECT_EQ(element_relative_displacement(e.type, corners(e.corners), corners(broken)), HUGE_VAL);
  }
}

TEST(ElementQuality, RelativeDisplacementIsTheStretchOfTheWorstDirection) {
  for (auto const& e : ideal_elements()) {
    auto shifted = e.corners;
    for (auto& p : shifted) p += Vec3{1, 2, 3};
    EXPECT_NEAR(element_relative_displacement(e.type, corners(e.corners), corners(shifted)), 0, 1e-14);
    auto stretched = e.corners;
    for (auto& p : stretched) p = 1.25 * p;  // each edge grows by a quarter of its length
    EXPECT_NEAR(element_relative_displacement(e.type, corners(e.corners), corners(stretched)), 0.25, 1e-14);
  }
}

}  // namespace
}  // namespace gridmorph::test
