// Morphing by radial basis functions, the usual way to move unstructured meshes, as a yardstick: dense, with centres
// picked from the boundary. Not part of the library: it solves a system of equations.
//
//   u(x) = sum_c w_c phi(|x - x_c| / R)      phi(r) = (1 - r)^4 (4 r + 1) for r < 1, else 0      u(x_c) = given
//
// H. Wendland, "Piecewise polynomial, positive definite and compactly supported radial functions of minimal degree",
// Adv. Comput. Math. 4 (1995) 389: C2 and positive definite in 3-D, so that the matrix is regular for distinct centres.
// A. de Boer, M.S. van der Schoot, H. Bijl, "Mesh deformation based on radial basis function interpolation", Comput.
// Struct. 85 (2007) 784.
//
// Setting up: n^3 / 3 multiplications for n centres. Applying: about 16 flops and a square root per node and centre;
// bytes do not matter.
#pragma once

#include <gridmorph/kernels/field.hpp>
#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/kernels/vec3.hpp>

#include <Kokkos_Core.hpp>

#include <cmath>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

namespace gridmorph::bench {

/// phi at the square of a distance in units of the radius.
KOKKOS_INLINE_FUNCTION double wendland_c2(double squared) {
  if (squared >= 1) return 0;
  double const r = compat::math::sqrt(squared), s = 1 - r, s2 = s * s;
  return s2 * s2 * (4 * r + 1);
}

/// Solves the dense system a w = b in place for each b, of three right sides: Gaussian elimination with row exchange.
/// a: row-major (n, n).
inline void solve_dense(std::vector<double>& a, std::span<std::vector<Vec3>> right) {
  std::size_t const n = right.front().size();
  auto const at = [&](std::size_t row, std::size_t column) -> double& { return a[row * n + column]; };
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t row = k + 1; row < n; ++row)
      if (std::abs(at(row, k)) > std::abs(at(pivot, k))) pivot = row;
    if (!(std::abs(at(pivot, k)) > 0)) throw std::runtime_error("rbf reference: two centres are the same point");
    if (pivot != k) {
      for (std::size_t column = k; column < n; ++column) std::swap(at(k, column), at(pivot, column));
      for (auto& b : right) std::swap(b[k], b[pivot]);
    }
    for (std::size_t row = k + 1; row < n; ++row) {
      double const factor = at(row, k) / at(k, k);
      if (factor == 0) continue;
      for (std::size_t column = k + 1; column < n; ++column) at(row, column) -= factor * at(k, column);
      for (auto& b : right) b[row] = b[row] - factor * b[k];
    }
  }
  for (auto& b : right)
    for (std::size_t k = n; k-- > 0;) {
      for (std::size_t column = k + 1; column < n; ++column) b[k] = b[k] - at(k, column) * b[column];
      b[k] = (1 / at(k, k)) * b[k];
    }
}

/// Weights for centres with given displacements, in a memory space.
template <class MemorySpace>
struct RbfField {
  Kokkos::View<Vec3*, MemorySpace> centres, weights;
  double inverse_radius = 1;

  RbfField(std::vector<Vec3> const& points, std::vector<Vec3> displacement, double radius)
      : centres("gridmorph::bench::centres", points.size()),
        weights("gridmorph::bench::weights", points.size()),
        inverse_radius(1 / radius) {
    std::size_t const n = points.size();
    std::vector<double> matrix(n * n);
    for (std::size_t r = 0; r < n; ++r)
      for (std::size_t c = 0; c < n; ++c) {
        Vec3 const d = inverse_radius * (points[r] - points[c]);
        matrix[r * n + c] = wendland_c2(dot(d, d));
      }
    solve_dense(matrix, {&displacement, 1});
    copy_to(centres, points);
    copy_to(weights, displacement);
  }

  /// Displacement of a point.
  KOKKOS_INLINE_FUNCTION Vec3 operator()(Vec3 const& x) const {
    Vec3 u;
    auto const n = centres.extent(0);
    for (std::size_t c = 0; c < n; ++c) {
      Vec3 const d = inverse_radius * (x - centres(c));
      u += wendland_c2(dot(d, d)) * weights(c);
    }
    return u;
  }

  /// morphed = x + u(x) for n nodes; may be in place. Enqueued on exec.
  template <class ExecutionSpace>
  void apply(ExecutionSpace const& exec, std::size_t n, kernels::Field<double const> const& x,
             kernels::Field<double> const& morphed) const {
    auto const self = *this;
    Kokkos::parallel_for(
        "gridmorph::bench::rbf", Kokkos::RangePolicy<ExecutionSpace>(exec, 0, n), KOKKOS_LAMBDA(std::size_t i) {
          Vec3 const p{x.x[i], x.y[i], x.z[i]}, u = self(p);
          morphed.x[i] = p.x + u.x;
          morphed.y[i] = p.y + u.y;
          morphed.z[i] = p.z + u.z;
        });
  }

 private:
  static void copy_to(Kokkos::View<Vec3*, MemorySpace> const& to, std::vector<Vec3> const& from) {
    Kokkos::deep_copy(to,
                      Kokkos::View<Vec3 const*, Kokkos::HostSpace, Kokkos::MemoryUnmanaged>(from.data(), from.size()));
  }
};

}  // namespace gridmorph::bench
