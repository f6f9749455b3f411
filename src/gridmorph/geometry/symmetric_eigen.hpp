// Principal directions of a symmetric 3x3 matrix. Internal to casefile.
#pragma once

#include <gridmorph/kernels/vec3.hpp>

#include <array>
#include <cmath>

namespace gridmorph::casefile {

/// Eigenvalues (in value) and eigenvectors (columns of the result) of a symmetric matrix, by Jacobi rotations.
inline Mat3 eigenvectors(Mat3 a, std::array<double, 3>& value) {
  Mat3 v;
  for (int sweep = 0; sweep < 30; ++sweep) {
    double const off = std::fabs(a.m[0][1]) + std::fabs(a.m[0][2]) + std::fabs(a.m[1][2]);
    double const trace = std::fabs(a.m[0][0]) + std::fabs(a.m[1][1]) + std::fabs(a.m[2][2]);
    if (off <= 1e-17 * trace) break;
    for (int p = 0; p < 2; ++p)
      for (int q = p + 1; q < 3; ++q) {
        if (a.m[p][q] == 0) continue;
        double const h = (a.m[q][q] - a.m[p][p]) / (2 * a.m[p][q]);
        double const t = (h >= 0 ? 1.0 : -1.0) / (std::fabs(h) + std::sqrt(h * h + 1));
        double const c = 1 / std::sqrt(t * t + 1), s = t * c;
        for (int k = 0; k < 3; ++k) {
          double const kp = a.m[k][p], kq = a.m[k][q];
          a.m[k][p] = c * kp - s * kq;
          a.m[k][q] = s * kp + c * kq;
        }
        for (int k = 0; k < 3; ++k) {
          double const pk = a.m[p][k], qk = a.m[q][k];
          a.m[p][k] = c * pk - s * qk;
          a.m[q][k] = s * pk + c * qk;
          double const vp = v.m[k][p], vq = v.m[k][q];
          v.m[k][p] = c * vp - s * vq;
          v.m[k][q] = s * vp + c * vq;
        }
      }
  }
  for (int k = 0; k < 3; ++k) value[k] = a.m[k][k];
  return v;
}

inline Vec3 column(Mat3 const& a, int c) { return {a.m[0][c], a.m[1][c], a.m[2][c]}; }

}  // namespace gridmorph::casefile
