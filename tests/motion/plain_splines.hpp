// Tensor products of B-splines and Bernstein polynomials, as their definitions say: slow and plain.
#pragma once

#include <gridmorph/motion/ffd_rule.hpp>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <vector>

namespace gridmorph::test {

/// Clamped, uniform: degree + 1 zeros, the knots between, degree + 1 ones.
inline std::vector<double> plain_knots(int count, int degree) {
  std::vector<double> out(std::size_t(degree) + 1, 0.0);
  for (int m = 1; m < count - degree; ++m) out.push_back(double(m) / (count - degree));
  out.insert(out.end(), std::size_t(degree) + 1, 1.0);
  return out;
}

/// All B_n at a place, degree by degree from the spans on (de Boor 1972); 0/0 is 0.
inline std::vector<double> plain_splines(std::vector<double> const& knots, int degree, double s) {
  auto const u = [&](std::size_t k) { return knots[k]; };
  std::vector<double> b;
  for (std::size_t n = 0; n + 1 < knots.size(); ++n)
    b.push_back((u(n) <= s && s < u(n + 1)) || (s == 1 && u(n) < 1 && u(n + 1) == 1) ? 1 : 0);
  for (std::size_t d = 1; d <= std::size_t(degree); ++d) {
    std::vector<double> next;
    for (std::size_t n = 0; n + 1 < b.size(); ++n) {
      double const up = u(n + d) > u(n) ? (s - u(n)) / (u(n + d) - u(n)) * b[n] : 0;
      double const down = u(n + d + 1) > u(n + 1) ? (u(n + d + 1) - s) / (u(n + d + 1) - u(n + 1)) * b[n + 1] : 0;
      next.push_back(up + down);
    }
    b = next;
  }
  return b;
}

/// Where de Casteljau's repeated linear interpolation ends.
inline Vec3 de_casteljau(std::vector<Vec3> points, double s) {
  for (std::size_t left = points.size(); left > 1; --left)
    for (std::size_t n = 0; n + 1 < left; ++n) points[n] = (1 - s) * points[n] + s * points[n + 1];
  return points.front();
}

/// sum B_i B_j B_k values_ijk at (s, t, w).
inline Vec3 plain_sum(FfdRule const& rule, std::vector<Vec3> const& values, Vec3 const& place) {
  auto const along = [&](std::size_t a, double s) {
    return plain_splines(plain_knots(rule.counts[a], rule.degree[a]), rule.degree[a], s);
  };
  std::vector<double> const a = along(0, place.x), b = along(1, place.y), c = along(2, place.z);
  Vec3 sum{};
  for (int k = 0; k < rule.counts[2]; ++k)
    for (int j = 0; j < rule.counts[1]; ++j)
      for (int i = 0; i < rule.counts[0]; ++i) sum += a[i] * b[j] * c[k] * values[rule.number(i, j, k)];
  return sum;
}

/// The same for Bernstein polynomials, one direction after another.
inline Vec3 plain_bezier(FfdRule const& rule, std::vector<Vec3> const& values, Vec3 const& place) {
  std::vector<Vec3> planes;
  for (int k = 0; k < rule.counts[2]; ++k) {
    std::vector<Vec3> rows;
    for (int j = 0; j < rule.counts[1]; ++j) {
      auto const first = values.begin() + std::ptrdiff_t(rule.number(0, j, k));
      rows.push_back(de_casteljau({first, first + rule.counts[0]}, place.x));
    }
    planes.push_back(de_casteljau(rows, place.y));
  }
  return de_casteljau(planes, place.z);
}

/// One value for each control point, by its place among the control points where values linear in the place of a point
/// keep it: the means of `degree` knots.
inline std::vector<Vec3> at_control_points(FfdRule const& rule, std::function<Vec3(Vec3 const& place)> const& value) {
  auto const along = [&](std::size_t a, int n) {
    int const degree = rule.degree[a];
    if (degree == 0) return 0.5;
    std::vector<double> const knots = plain_knots(rule.counts[a], degree);
    double sum = 0;
    for (int m = n + 1; m <= n + degree; ++m) sum += knots[m];
    return sum / degree;
  };
  std::vector<Vec3> out;
  for (int k = 0; k < rule.counts[2]; ++k)
    for (int j = 0; j < rule.counts[1]; ++j)
      for (int i = 0; i < rule.counts[0]; ++i) out.push_back(value({along(0, i), along(1, j), along(2, k)}));
  return out;
}

}  // namespace gridmorph::test
