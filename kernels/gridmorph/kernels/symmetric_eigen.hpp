// Eigenvalues and eigenvectors of small symmetric matrices.
//
// Cyclic Jacobi rotations (Golub and Van Loan, Matrix Computations, section 8.5). Entries off the diagonal that are
// exactly zero stay so: points on a coordinate plane have its exact normal, and what moves by nothing is turned by
// nothing.
//
// Cost: 5 sweeps or so of N (N - 1) / 2 rotations.
#pragma once

#include <Kokkos_Core.hpp>

#include <cmath>
#include <cstddef>

namespace gridmorph::kernels {

/// a: symmetric, left with its eigenvalues on the diagonal, in no order; v[k] is the unit vector of a[k][k].
template <std::size_t N>
KOKKOS_INLINE_FUNCTION void diagonalise(double (&a)[N][N], double (&v)[N][N]) {
  using std::sqrt;
  for (std::size_t k = 0; k < N; ++k)
    for (std::size_t n = 0; n < N; ++n) v[k][n] = k == n ? 1 : 0;
  auto const turn = [](double c, double s, double& left, double& right) {
    double const l = left, r = right;
    left = c * l - s * r;
    right = s * l + c * r;
  };
  constexpr int most_sweeps = 60;
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    double off = 0, diagonal = 0;
    for (std::size_t p = 0; p < N; ++p) {
      diagonal += a[p][p] * a[p][p];
      for (std::size_t q = p + 1; q < N; ++q) off += a[p][q] * a[p][q];
    }
    if (off <= 1e-40 * diagonal) break;
    for (std::size_t p = 0; p < N; ++p)
      for (std::size_t q = p + 1; q < N; ++q) {
        if (a[p][q] == 0) continue;
        double const h = (a[q][q] - a[p][p]) / (2 * a[p][q]);
        // The smaller of both rotations that make this entry zero: with it the sweeps converge.
        double const t = (h >= 0 ? 1 : -1) / ((h < 0 ? -h : h) + sqrt(h * h + 1));
        double const c = 1 / sqrt(t * t + 1), s = t * c;
        for (std::size_t k = 0; k < N; ++k) turn(c, s, a[k][p], a[k][q]);
        for (std::size_t k = 0; k < N; ++k) turn(c, s, a[p][k], a[q][k]);
        for (std::size_t k = 0; k < N; ++k) turn(c, s, v[p][k], v[q][k]);
      }
  }
}

}  // namespace gridmorph::kernels
