// Morphing by thin plate splines, the radial basis functions that are said to turn bodies best, with every boundary
// node as a centre: the yardstick of docs/unstructured.md for shapes of elements. Not part of the library: it assembles
// and solves a dense system.
//
//   u(x) = sum_c w_c phi(|x - x_c|) + a + B x      phi(r) = r^2 log r      u(x_c) = given
//   sum_c w_c = 0, sum_c w_c x_c = 0
//
// (A. de Boer, M.S. van der Schoot, H. Bijl, Comput. Struct. 85 (2007) 784, there the best of their functions for
// turns.) Linear in what is given: solved once for a few fields.
#pragma once

#include "rbf_reference.hpp"

namespace gridmorph::bench {

class ThinPlate {
 public:
  /// dimension 2: centres in the plane z = 0. given: fields of the centres' displacements.
  ThinPlate(std::vector<Vec3> centres, std::vector<std::vector<Vec3>> given, int dimension)
      : centres_(std::move(centres)), weights_(std::move(given)), dimension_(dimension) {
    std::size_t const n = centres_.size(), all = n + std::size_t(dimension) + 1;
    std::vector<double> matrix(all * all, 0);
    for (std::size_t r = 0; r < n; ++r) {
      for (std::size_t c = 0; c < n; ++c) matrix[r * all + c] = phi(centres_[r], centres_[c]);
      for (std::size_t k = n; k < all; ++k) matrix[r * all + k] = matrix[k * all + r] = term(centres_[r], k - n);
    }
    for (auto& weight : weights_) weight.resize(all);
    solve_dense(matrix, weights_);
  }

  /// Of each field, at a point.
  [[nodiscard]] std::vector<Vec3> operator()(Vec3 const& x) const {
    std::vector<Vec3> u(weights_.size());
    auto const add = [&](double value, std::size_t row) {
      for (std::size_t f = 0; f < u.size(); ++f) u[f] += value * weights_[f][row];
    };
    for (std::size_t c = 0; c < centres_.size(); ++c) add(phi(x, centres_[c]), c);
    for (std::size_t k = 0; k <= std::size_t(dimension_); ++k) add(term(x, k), centres_.size() + k);
    return u;
  }

 private:
  static double phi(Vec3 const& a, Vec3 const& b) {
    double const r2 = dot(a - b, a - b);
    return r2 > 0 ? 0.5 * r2 * std::log(r2) : 0;
  }
  static double term(Vec3 const& x, std::size_t k) { return k == 0 ? 1 : k == 1 ? x.x : k == 2 ? x.y : x.z; }

  std::vector<Vec3> centres_;
  std::vector<std::vector<Vec3>> weights_;
  int dimension_;
};

}  // namespace gridmorph::bench
