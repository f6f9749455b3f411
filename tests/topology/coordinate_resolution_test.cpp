// How exactly coordinates are known, whatever keeps them: single precision, few digits, or all there is.
#include "support/mesh_builders.hpp"

#include <gridmorph/mesh/coordinate_resolution.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>

namespace gridmorph::test {
namespace {

template <class Round>
Mesh resolution_box(Round&& round, Vec3 const& shift = {}) {
  Mesh mesh = box({9, 8, 7}, Shape::curved, 3);
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    Vec3 const p = mesh.coordinates[n] + shift;
    mesh.coordinates.set(n, {round(p.x), round(p.y), round(p.z)});
  }
  return mesh;
}

double as_text(double v, char const* format) {
  char text[40];
  std::snprintf(text, sizeof text, format, v);
  return std::strtod(text, nullptr);
}

TEST(CoordinateResolution, OfDoublePrecisionIsItsOwnWherever) {
  Mesh const here = resolution_box([](double v) { return v; });
  EXPECT_LT(coordinate_resolution(here), 1e-15 * here.size());
  Mesh const far = resolution_box([](double v) { return v; }, {1e6, 0, 0});
  EXPECT_GT(coordinate_resolution(far), 1e-10);
  EXPECT_LT(coordinate_resolution(far), 1e-9);
}

TEST(CoordinateResolution, OfSinglePrecisionIsFoundInFilesOfDoublePrecisionToo) {
  Mesh mesh = resolution_box([](double v) { return double(float(v)); });
  double const found = coordinate_resolution(mesh);
  EXPECT_GT(found, 1e-7 * mesh.size() / 2);
  EXPECT_LT(found, 2e-7 * mesh.size());
  mesh.zones[0].single_precision = true;
  EXPECT_EQ(coordinate_resolution(mesh), found);
}

TEST(CoordinateResolution, OfTextIsItsLastDecimal) {
  Mesh const full = resolution_box([](double v) { return v; });
  double largest = 0;
  for (Index n = 0; n < full.n_nodes(); ++n)
    for (double const v : {full.coordinates[n].x, full.coordinates[n].y, full.coordinates[n].z})
      largest = std::max(largest, std::abs(v));
  double const leading = std::pow(10, std::floor(std::log10(largest)));
  for (int const digits : {6, 8, 10}) {
    std::string const format = "%." + std::to_string(digits) + "g";
    Mesh const mesh = resolution_box([&](double v) { return as_text(v, format.c_str()); });
    double const unit = leading * std::pow(10, 1 - digits), found = coordinate_resolution(mesh);
    EXPECT_GT(found, 0.09 * unit) << digits;
    EXPECT_LT(found, 1.01 * unit) << digits;
  }
  Mesh const fixed = resolution_box([](double v) { return as_text(v, "%.7f"); });
  EXPECT_NEAR(coordinate_resolution(fixed), 1e-7, 1e-12);
}

TEST(CoordinateResolution, OfTextIsThatOfTheLargestNumberWhateverIsLookedAt) {
  // One node lies a decade farther out than all others; which nodes are looked at is nobody's business.
  for (auto const& [format, unit] : {std::pair("%.7g", 1e-5), std::pair("%.7f", 1e-7)})
    for (Index const far : {0, 1, 2, 100, 101, 102}) {
      Mesh mesh = resolution_box([&](double v) { return as_text(v, format); });
      mesh.coordinates.set(far, {as_text(12.3456789, format), 0, 0});
      EXPECT_NEAR(coordinate_resolution(mesh), unit, 1e-6 * unit) << format << " " << far;
    }
}

TEST(CoordinateResolution, OfRoundNumbersIsThatOfDoublePrecision) {
  for (double const unit : {1.0, 0.125, 0.1, 0.001}) {
    Mesh const mesh = resolution_box([&](double v) { return unit * std::round(v / unit); });
    EXPECT_LT(coordinate_resolution(mesh), 1e-14 * (1 + mesh.size())) << unit;
  }
}

}  // namespace
}  // namespace gridmorph::test
