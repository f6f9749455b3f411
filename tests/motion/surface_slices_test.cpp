// Sections cut from triangles: the surface is given by a formula, the triangles lie on it.
#include "support/expect_error.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/motion/turbomachinery/blade_surface.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

namespace gridmorph {
namespace {

using test::expect_all_in;
using test::message_of;

constexpr double pi = std::numbers::pi;

/// Adds n[0] x n[1] quadrilaterals of a surface, each as two triangles, the diagonals in turn one way and the other.
class Surface {
 public:
  void add(
      int n_a, int n_b, std::function<Vec3(double, double)> const& at,
      std::function<bool(int, int)> const& left_out = [](int, int) { return false; }) {
    for (int b = 0; b < n_b; ++b)
      for (int a = 0; a < n_a; ++a) {
        if (left_out(a, b)) continue;
        auto const node = [&](int da, int db) { return number(at(double(a + da) / n_a, double(b + db) / n_b)); };
        int const p = node(0, 0), q = node(1, 0), r = node(1, 1), s = node(0, 1);
        if ((a + b) % 2 == 0) {
          triangle(p, q, r);
          triangle(p, r, s);
        } else {
          triangle(p, q, s);
          triangle(q, r, s);
        }
      }
  }
  SliceInput input;
  std::vector<std::string> notes;

  std::vector<SlicedContour> slice() {
    input.span = [](Vec3 const& p) { return p.z; };
    input.along = [](Vec3 const& p) { return p.x; };
    input.height = [](Vec3 const&) { return 1.0; };
    return slice_surface(input, notes);
  }

 private:
  int number(Vec3 const& p) {
    for (std::size_t n = 0; n < input.points.size(); ++n)
      if (distance(input.points[n], p) < 1e-12) return int(n);
    input.points.push_back(p);
    return int(input.points.size()) - 1;
  }
  void triangle(int a, int b, int c) {
    if (a != b && b != c && c != a) input.triangles.push_back({a, b, c});
  }
};

/// An elliptic blade, sharp behind where `sharp`; s goes once around from the trailing edge.
Vec3 blade_point(double s, double h, double size, bool sharp, Vec3 const& at = {}) {
  double const phi = 2 * pi * (s == 1 ? 0 : s), x = 0.5 * (1 + std::cos(phi));
  double const y =
      (sharp ? 0.4 * x * (1 - x) + 0.1 * std::sqrt(x) * (1 - x) * (1 - x) : 0.1) * std::sin(phi) * (sharp ? 0.5 : 1);
  double const chord = size * (1 - 0.3 * h), turn = 0.4 * h;
  return at + Vec3{0.2 * h + chord * ((x - 0.5) * std::cos(turn) - y * std::sin(turn)),
                   chord * ((x - 0.5) * std::sin(turn) + y * std::cos(turn)), h};
}

void add_blade(Surface& surface, int around, int spanwise, bool sharp, double size = 1, Vec3 const& at = {}) {
  surface.add(around, spanwise, [=](double s, double h) { return blade_point(s, h, size, sharp, at); });
}
void add_tip(Surface& surface, int around) {
  surface.add(around, 2, [](double s, double t) {
    Vec3 const edge = blade_point(s, 1, 1, false);
    return (1 - t) * edge + t * Vec3{0.2, 0, 1};
  });
}

/// The largest distance of places from the surface x = blade_point(s, z), found by scanning s.
double off(std::vector<SlicedContour> const& found, bool sharp) {
  double worst = 0;
  for (SlicedContour const& contour : found)
    for (std::size_t l = 0; l < contour.lines.size(); l += 7)
      for (SlicePlace const& place : contour.lines[l]) {
        double nearest = 1;
        for (int k = 0; k < 4000; ++k)
          nearest = std::min(nearest, distance(place.point, blade_point(k / 4000.0, place.point.z, 1, sharp)));
        worst = std::max(worst, nearest);
      }
  return worst;
}

TEST(SurfaceSlices, GoOnceAroundEveryLineFromEndToEnd) {
  for (bool const sharp : {false, true}) {
    Surface surface;
    add_blade(surface, 48, 12, sharp);
    auto const found = surface.slice();
    ASSERT_EQ(found.size(), 1u);
    EXPECT_TRUE(found[0].closed);
    EXPECT_EQ(found[0].lines.size(), 128u);
    for (auto const& line : found[0].lines) {
      EXPECT_EQ(line.front().span, 0);
      EXPECT_EQ(line.back().span, 1);
      for (std::size_t n = 0; n < line.size(); ++n) {
        EXPECT_NEAR(line[n].point.z, line[n].span, 1e-12);
        double sum = 0;
        for (auto const& [v, w] : line[n].weights) sum += w;
        EXPECT_NEAR(sum, 1, 1e-14);
        EXPECT_TRUE(n == 0 || line[n].span > line[n - 1].span);
      }
    }
  }
}

TEST(SurfaceSlices, AreOffByTheSquareOfTheFacets) {
  std::vector<double> errors;
  for (int const n : {1, 2}) {
    Surface surface;
    add_blade(surface, 32 * n, 8 * n, false);
    errors.push_back(off(surface.slice(), false));
  }
  EXPECT_LT(errors[0], 4e-3);
  EXPECT_GT(errors[0] / errors[1], 3);
}

// One line runs along the sharp trailing edge, bit for bit on its nodes' edges.
TEST(SurfaceSlices, HaveALineInASharpEdge) {
  Surface surface;
  add_blade(surface, 48, 12, true);
  auto const found = surface.slice();
  bool there = false;
  for (auto const& line : found[0].lines)
    there = there || std::all_of(line.begin(), line.end(), [](SlicePlace const& p) {
              return distance(p.point, blade_point(0, p.span, 1, true)) < 2e-3;
            });
  EXPECT_TRUE(there);
}

TEST(SurfaceSlices, OfTheTipAreNone) {
  Surface with, without;
  add_blade(with, 48, 12, false);
  add_tip(with, 48);
  add_blade(without, 48, 12, false);
  auto const a = with.slice(), b = without.slice();
  ASSERT_EQ(a.size(), 1u);
  ASSERT_EQ(a[0].lines.size(), b[0].lines.size());
  for (std::size_t l = 0; l < a[0].lines.size(); ++l) {
    ASSERT_EQ(a[0].lines[l].size(), b[0].lines[l].size());
    for (std::size_t n = 0; n < a[0].lines[l].size(); ++n)
      EXPECT_LT(distance(a[0].lines[l][n].point, b[0].lines[l][n].point), 1e-12);
  }
}

// Inner walls of a squealer, a hollow blade and a hole through the skin: the outer contour gives the sections.
TEST(SurfaceSlices, AreThoseOfTheOuterContour) {
  Surface plain, more;
  add_blade(plain, 48, 12, false);
  add_blade(more, 48, 12, false);
  add_blade(more, 40, 10, false, 0.6);  // the inner wall of a hollow blade
  more.add(24, 3, [](double s, double t) {
    Vec3 const p = blade_point(s, 0.8 + 0.2 * t, 0.8, false);
    return p;
  });
  auto const a = plain.slice(), b = more.slice();
  ASSERT_EQ(b.size(), 1u);
  ASSERT_EQ(a[0].lines.size(), b[0].lines.size());
  ASSERT_EQ(a[0].lines[0].size(), b[0].lines[0].size());
  for (std::size_t l = 0; l < a[0].lines.size(); ++l)
    EXPECT_LT(distance(a[0].lines[l][3].point, b[0].lines[l][3].point), 1e-12);
  EXPECT_NE(more.notes.back().find("2 parts"), std::string::npos) << more.notes.back();
}

TEST(SurfaceSlices, BridgeHolesInTheSkin) {
  Surface surface;
  surface.add(
      96, 24, [](double s, double h) { return blade_point(s, h, 1, false); },
      [](int a, int b) { return (a == 20 || a == 70) && (b == 10 || b == 11); });
  auto const found = surface.slice();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].lines.front().front().span, 0);
  EXPECT_EQ(found[0].lines.front().back().span, 1);
  EXPECT_LT(off(found, false), 4e-3);
}

TEST(SurfaceSlices, GiveEachBladeItsContour) {
  Surface surface;
  add_blade(surface, 48, 12, false);
  add_blade(surface, 48, 12, false, 0.9, {0, 0.8, 0});
  EXPECT_EQ(surface.slice().size(), 2u);
}

TEST(SurfaceSlices, OfOneSideRunFromEndToEnd) {
  Surface surface;
  surface.add(24, 12, [](double s, double h) { return blade_point(0.5 * s, h, 1, true); });
  auto const found = surface.slice();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_FALSE(found[0].closed);
  EXPECT_EQ(found[0].lines.size(), 65u);
  for (SlicePlace const& p : found[0].lines.front())
    EXPECT_LT(distance(p.point, blade_point(0.5, p.span, 1, true)), 2e-3);
  for (SlicePlace const& p : found[0].lines.back()) EXPECT_LT(distance(p.point, blade_point(0, p.span, 1, true)), 2e-3);
}

TEST(SurfaceSlices, SayWhenThereAreNone) {
  Surface surface;
  add_tip(surface, 24);
  expect_all_in(message_of<MotionError>([&] { surface.slice(); }), {"runs spanwise"});
}

}  // namespace
}  // namespace gridmorph
