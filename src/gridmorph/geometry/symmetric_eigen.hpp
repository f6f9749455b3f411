// Eigenvalues and eigenvectors of small symmetric matrices.
#pragma once

#include <gridmorph/kernels/symmetric_eigen.hpp>
#include <gridmorph/kernels/vec3.hpp>

#include <array>
#include <cstddef>
#include <utility>

namespace gridmorph {

template <std::size_t N>
using SmallMatrix = std::array<std::array<double, N>, N>;

/// Eigenvalues and eigenvectors: greatest value first, equal ones in the order of their axes; vector[k] belongs to
/// value[k] and has length 1.
template <std::size_t N>
struct SymmetricEigen {
  std::array<double, N> value{};
  SmallMatrix<N> vector{};
};

/// Eigenvalues and eigenvectors as kernels::diagonalise() finds them, in order.
template <std::size_t N>
SymmetricEigen<N> symmetric_eigen(SmallMatrix<N> const& matrix) {
  SymmetricEigen<N> out;
  double a[N][N], vector[N][N];
  for (std::size_t p = 0; p < N; ++p)
    for (std::size_t q = 0; q < N; ++q) a[p][q] = matrix[p][q];
  kernels::diagonalise(a, vector);
  auto& v = out.vector;
  for (std::size_t p = 0; p < N; ++p)
    for (std::size_t q = 0; q < N; ++q) v[p][q] = vector[p][q];
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
