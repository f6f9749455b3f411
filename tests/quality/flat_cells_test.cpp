// Scaled Jacobians of cells that may be flat, against angles and against triple products written out.
#include "quality/reference_cell.hpp"

#include <gridmorph/kernels/flat_cells.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

namespace gridmorph::test {
namespace {

using kernels::ElementCorners;

constexpr Vec3 plane_z{0, 0, 1};

/// Three corners that edges lead to, right-handed seen from the corner that comes first.
using CornerTable = std::vector<std::array<int, 4>>;

double by_table(ElementCorners const& c, CornerTable const& table) {
  double least = 1;
  for (auto const& [at, p, q, r] : table) {
    Vec3 const a = c.at[p] - c.at[at], b = c.at[q] - c.at[at], d = c.at[r] - c.at[at];
    double const j = a.x * (b.y * d.z - b.z * d.y) + a.y * (b.z * d.x - b.x * d.z) + a.z * (b.x * d.y - b.y * d.x);
    least = std::min(least, j / std::sqrt(dot(a, a) * dot(b, b) * dot(d, d)));
  }
  return least;
}

struct KindOfElement {
  ElementType type;
  ElementCorners corners;  ///< sound
  CornerTable table;
};

std::vector<KindOfElement> kinds_of_elements() {
  return {{ElementType::tetrahedron,
           {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
           {{0, 1, 2, 3}, {1, 2, 0, 3}, {2, 0, 1, 3}, {3, 0, 2, 1}}},
          {ElementType::pyramid,
           {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}}},
           {{0, 1, 3, 4}, {1, 2, 0, 4}, {2, 3, 1, 4}, {3, 0, 2, 4}}},
          {ElementType::prism,
           {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}}},
           {{0, 1, 2, 3}, {1, 2, 0, 4}, {2, 0, 1, 5}, {3, 5, 4, 0}, {4, 3, 5, 1}, {5, 4, 3, 2}}},
          {ElementType::hexahedron,
           {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}},
           {{0, 1, 3, 4},
            {1, 2, 0, 5},
            {2, 3, 1, 6},
            {3, 0, 2, 7},
            {4, 7, 5, 0},
            {5, 4, 6, 1},
            {6, 5, 7, 2},
            {7, 6, 4, 3}}}};
}

ElementCorners mapped(ElementCorners c, int n, std::function<Vec3(Vec3 const&)> const& f) {
  for (int k = 0; k < n; ++k) c.at[k] = f(c.at[k]);
  return c;
}

TEST(FlatCells, ScaledJacobiansAreTripleProductsOfUnitEdges) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> off(-0.4, 0.4);
  for (auto const& kind : kinds_of_elements())
    for (int n = 0; n < 200; ++n) {
      ElementCorners const c = mapped(kind.corners, n_corners(kind.type), [&](Vec3 const& p) {
        return Vec3{3 * (p.x + off(random)), 1e-3 * (p.y + off(random)), 40 * (p.z + off(random))};
      });
      for (double const sign : {1.0, -1.0}) {
        ElementCorners const turned = sign > 0 ? c : mapped(c, n_corners(kind.type), [](Vec3 const& p) {
          return Vec3{-p.x, p.y, p.z};
        });
        EXPECT_NEAR(kernels::scaled_jacobian(kind.type, turned, sign, {}), by_table(c, kind.table), 1e-9)
            << int(kind.type);
      }
    }
}

TEST(FlatCells, InAPlaneTheyAreSinesOfTheAngles) {
  for (double const degrees : {90.0, 30.0, 1.0, -0.5}) {
    double const a = degrees * std::acos(-1.0) / 180;
    Vec3 const along{3, 0, 0}, up{2 * std::cos(a), 2 * std::sin(a), 0};
    ElementCorners const lozenge{{{0, 0, 0}, along, along + up, up}};
    EXPECT_NEAR(kernels::scaled_jacobian(ElementType::quadrilateral, lozenge, 1, plane_z), std::sin(a), 1e-14);
    EXPECT_NEAR(kernels::scaled_jacobian(ElementType::quadrilateral, lozenge, -1, plane_z), -std::sin(a), 1e-14);
  }
  ElementCorners const triangle{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
  EXPECT_NEAR(kernels::scaled_jacobian(ElementType::triangle, triangle, 1, plane_z), std::sqrt(0.5), 1e-15);
}

TEST(FlatCells, FlatOnesAreZeroWhereverTheyLieAndCollapsedCornersDoNotCount) {
  double const nan = std::nan("");
  for (auto const& kind : kinds_of_elements()) {
    int const n = n_corners(kind.type);
    auto const scaled = [&](auto const& f) {
      return kernels::scaled_jacobian(kind.type, mapped(kind.corners, n, f), 1, {});
    };
    // Pressed into a plane askew, 1000 of its sizes away, where coordinates are rounded.
    Vec3 const a{0.6, 0.64, 0.48}, b{0.8, -0.48, -0.36}, far{1000.1, -2000.2, 300.3};
    EXPECT_EQ(scaled([&](Vec3 const& p) { return far + (p.x + 0.3 * p.z) * a + (p.y + 0.2 * p.z) * b; }), 0)
        << int(kind.type);
    EXPECT_EQ(scaled([](Vec3 const&) { return Vec3{1, 2, 3}; }), 0) << "a point";
    EXPECT_EQ(scaled([&](Vec3 const& p) { return Vec3{p.x == 0 ? nan : p.x, p.y, p.z}; }), -1);
  }
  // A wedge: the edge along the axis has no length across it.
  ElementCorners const wedge{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 0, 1}}};
  EXPECT_NEAR(kernels::scaled_jacobian(ElementType::hexahedron, wedge, 1, {}), std::sqrt(0.5), 1e-15);
}

TEST(FlatCells, StayFlatWithinTheAllowanceAndOnlyIfTheyWereFlat) {
  EXPECT_TRUE((kernels::FlatCell{0, -0.9e-3}.stays_flat()));
  EXPECT_TRUE((kernels::FlatCell{-0.9e-10, 0.5}.stays_flat()));
  EXPECT_FALSE((kernels::FlatCell{0, -1.1e-3}.stays_flat()));
  EXPECT_FALSE((kernels::FlatCell{0, std::nan("")}.stays_flat()));
  for (double const before : {1.1e-10, -1.1e-10, 1.0})
    EXPECT_FALSE((kernels::FlatCell{before, 0}.stays_flat())) << before;
}

}  // namespace
}  // namespace gridmorph::test
