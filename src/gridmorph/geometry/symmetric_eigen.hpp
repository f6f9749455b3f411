// Eigenvalues and eigenvectors of small symmetric matrices.
#pragma once

#include <gridmorph/kernels/vec3.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace gridmorph {

template <std::size_t N>
using SmallMatrix = std::array<std::array<double, N>, N>;

/// Greatest value first, equal ones in the order of their axes; vector[k] belongs to value[k] and has length 1.
template <std::size_t N>
struct SymmetricEigen {
  std::array<double, N> value{};
  SmallMatrix<N> vector{};
};

/// Cyclic Jacobi rotations (Golub and Van Loan, Matrix Computations, section 8.5). Entries off the diagonal that are exactly
/// zero stay so: points on a coordinate plane have its exact normal. Cost: 5 sweeps or so of N (N - 1) / 2 rotations.
template <std::size_t N>
SymmetricEigen<N> symmetric_eigen(SmallMatrix<N> a) {
  SymmetricEigen<N> out;
  auto& v = out.vector;
  for (std::size_t k = 0; k < N; ++k) v[k][k] = 1;
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
        double const t = (h >= 0 ? 1 : -1) / (std::abs(h) + std::sqrt(h * h + 1));
        double const c = 1 / std::sqrt(t * t + 1), s = t * c;
        auto const turn = [&](double& left, double& right) {
          double const l = left, r = right;
          left = c * l - s * r;
          right = s * l + c * r;
        };
        for (std::size_t k = 0; k < N; ++k) turn(a[k][p], a[k][q]);
        for (std::size_t k = 0; k < N; ++k) turn(a[p][k], a[q][k]);
        for (std::size_t k = 0; k < N; ++k) turn(v[p][k], v[q][k]);
      }
  }
  for (std::size_t k = 0; k < N; ++k) out.value[k] = a[k][k];
  for (std::size_t k = 1; k < N; ++k)
    for (std::size_t n = k; n > 0 && out.value[n] > out.value[n - 1]; --n) {
      std::swap(out.value[n], out.value[n - 1]);
      std::swap(v[n], v[n - 1]);
    }
  return out;
}

/// Sums of w d d^T over vectors d: the moments of a cloud of points.
class Moments {
 public:
  void add(double weight, Vec3 const& d) {
    std::array<double, 3> const c{d.x, d.y, d.z};
    for (std::size_t r = 0; r < 3; ++r)
      for (std::size_t s = 0; s < 3; ++s) sum_[r][s] += weight * c[r] * c[s];
  }
  [[nodiscard]] SmallMatrix<3> const& sum() const { return sum_; }

 private:
  SmallMatrix<3> sum_{};
};

/// The principal moments, greatest first, and their unit directions.
struct PrincipalAxes {
  std::array<double, 3> moment{};
  std::array<Vec3, 3> direction{};

  explicit PrincipalAxes(Moments const& moments) {
    auto const eigen = symmetric_eigen(moments.sum());
    moment = eigen.value;
    for (std::size_t k = 0; k < 3; ++k) direction[k] = {eigen.vector[k][0], eigen.vector[k][1], eigen.vector[k][2]};
  }
};

}  // namespace gridmorph
