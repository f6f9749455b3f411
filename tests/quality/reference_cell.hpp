// Cell quality written a second time, plainly and by other formulas than the library's: the oracle of the tests.
//
// Jacobians from the trilinear shape functions, volumes by Gauss quadrature, angles by atan2 on listed face vertices,
// edges from a list of corner pairs. For cells without collapsed edges.
#pragma once

#include <gridmorph/kernels/cell_quality.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace gridmorph::test {

using Corners = std::array<Vec3, 8>;  // numbered i + 2 j + 4 k

inline Corners corners_of(kernels::HexCell const& cell) {
  Corners c;
  for (int n = 0; n < 8; ++n) c[n] = cell.corner[n];
  return c;
}

/// The trilinear map by its shape functions.
inline Vec3 trilinear(Corners const& c, double xi, double eta, double zeta) {
  Vec3 p{0, 0, 0};
  for (int n = 0; n < 8; ++n) {
    double const w = ((n & 1) != 0 ? xi : 1 - xi) * ((n & 2) != 0 ? eta : 1 - eta) * ((n & 4) != 0 ? zeta : 1 - zeta);
    p += w * c[n];
  }
  return p;
}

/// The map is linear in each parameter, so end differences are its exact derivatives.
inline double jacobian(Corners const& c, double xi, double eta, double zeta) {
  Vec3 const a = trilinear(c, 1, eta, zeta) - trilinear(c, 0, eta, zeta);
  Vec3 const b = trilinear(c, xi, 1, zeta) - trilinear(c, xi, 0, zeta);
  Vec3 const d = trilinear(c, xi, eta, 1) - trilinear(c, xi, eta, 0);
  return a.x * (b.y * d.z - b.z * d.y) - a.y * (b.x * d.z - b.z * d.x) + a.z * (b.x * d.y - b.y * d.x);
}

inline constexpr std::array<std::array<int, 2>, 12> edge_corners{
    {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3}, {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};
inline constexpr std::array<std::array<int, 4>, 6> face_corners{
    {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}}};

struct ReferenceCell {
  double determinant_2x2x2, determinant_3x3x3, smallest_corner_jacobian, volume, aspect_ratio, minimum_angle_deg,
      equiangle_skewness;
};

inline double sampled_determinant(Corners const& c, double handedness, std::initializer_list<double> parameters,
                                  double* smallest = nullptr) {
  double lo = std::numeric_limits<double>::max(), hi = std::numeric_limits<double>::lowest();
  for (double const xi : parameters)
    for (double const eta : parameters)
      for (double const zeta : parameters) {
        double const j = handedness * jacobian(c, xi, eta, zeta);
        lo = std::min(lo, j);
        hi = std::max(hi, j);
      }
  if (smallest != nullptr) *smallest = lo;
  return hi > 0 ? std::max(-1.0, lo / hi) : -1.0;
}

inline double gauss_volume(Corners const& c, double handedness) {
  double const g[2] = {0.5 - 0.5 / std::sqrt(3.0), 0.5 + 0.5 / std::sqrt(3.0)};
  double sum = 0;
  for (double const xi : g)
    for (double const eta : g)
      for (double const zeta : g) sum += jacobian(c, xi, eta, zeta) / 8;
  return handedness * sum;
}

inline ReferenceCell reference(Corners const& c, double handedness) {
  ReferenceCell r{};
  r.determinant_2x2x2 = sampled_determinant(c, handedness, {0.0, 1.0}, &r.smallest_corner_jacobian);
  r.determinant_3x3x3 = sampled_determinant(c, handedness, {0.0, 0.5, 1.0});
  r.volume = gauss_volume(c, handedness);
  double shortest = std::numeric_limits<double>::max(), longest = 0;
  for (auto const& e : edge_corners) {
    double const l = distance(c[e[0]], c[e[1]]);
    shortest = std::min(shortest, l);
    longest = std::max(longest, l);
  }
  r.aspect_ratio = longest / shortest;
  double amin = 180, amax = 0;
  for (auto const& f : face_corners)
    for (int n = 0; n < 4; ++n) {
      Vec3 const u = c[f[(n + 1) % 4]] - c[f[n]], v = c[f[(n + 3) % 4]] - c[f[n]];
      double const angle = std::atan2(norm(cross(u, v)), dot(u, v)) * 180 / std::acos(-1.0);
      amin = std::min(amin, angle);
      amax = std::max(amax, angle);
    }
  r.minimum_angle_deg = amin;
  r.equiangle_skewness = std::max((amax - 90) / 90, (90 - amin) / 90);
  return r;
}

/// The paper's section 3.2, for each grid direction: the largest relative displacement of two nodes of the cell that an
/// edge along it joins, divided by the average length of the cell there. Edges 4 d to 4 d + 3 of edge_corners run along
/// direction d.
inline std::array<double, 3> reference_relative_displacements(Corners const& before, Corners const& after) {
  std::array<double, 3> out{};
  for (int d = 0; d < 3; ++d) {
    double length = 0, difference = 0;
    for (int e = 4 * d; e < 4 * d + 4; ++e) {
      auto const [p, q] = edge_corners[e];
      length += distance(before[p], before[q]) / 4;
      difference = std::max(difference, norm((after[p] - before[p]) - (after[q] - before[q])));
    }
    out[d] = difference / length;
  }
  return out;
}
inline double reference_relative_displacement(Corners const& before, Corners const& after) {
  auto const along = reference_relative_displacements(before, after);
  return *std::max_element(along.begin(), along.end());
}

}  // namespace gridmorph::test
