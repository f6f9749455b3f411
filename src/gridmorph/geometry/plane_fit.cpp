#include <gridmorph/geometry/plane_fit.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace gridmorph {

namespace {

struct Eigen {
  std::array<double, 3> value{};
  Mat3 vectors;  ///< columns
};

/// Cyclic Jacobi rotations for a symmetric matrix (Golub and Van Loan, section 8.5).
Eigen eigen_symmetric(Mat3 a) {
  Mat3 v;
  for (int sweep = 0; sweep < 30; ++sweep) {
    double off = 0;
    for (auto const& [p, q] : {std::pair{0, 1}, {0, 2}, {1, 2}}) {
      double const apq = a.m[p][q];
      // Below round-off of the diagonal a rotation changes nothing.
      if (std::abs(apq) <= 1e-17 * (std::abs(a.m[p][p]) + std::abs(a.m[q][q]))) continue;
      off += std::abs(apq);
      double const tau = (a.m[q][q] - a.m[p][p]) / (2 * apq);
      double const t = (tau >= 0 ? 1.0 : -1.0) / (std::abs(tau) + std::sqrt(1 + tau * tau));
      double const c = 1 / std::sqrt(1 + t * t), s = t * c;
      Mat3 j;
      j.m[p][p] = j.m[q][q] = c;
      j.m[p][q] = s;
      j.m[q][p] = -s;
      a = transpose(j) * (a * j);
      a.m[p][q] = a.m[q][p] = 0;
      v = v * j;
    }
    if (off == 0) break;
  }
  return {{a.m[0][0], a.m[1][1], a.m[2][2]}, v};
}

}  // namespace

double deviation_from_plane(std::span<Vec3 const> points, Vec3 const& origin, Vec3 const& normal) {
  double worst = 0;
  for (Vec3 const& p : points) worst = std::max(worst, std::abs(dot(p - origin, normal)));
  return worst;
}

PlaneFit fit_plane(std::span<Vec3 const> points) {
  PlaneFit fit;
  // Offsets from the first point, so that a coordinate all points share drops out exactly.
  for (Vec3 const& p : points) fit.origin += p - points.front();
  fit.origin = points.front() + (1.0 / double(points.size())) * fit.origin;

  Mat3 covariance{{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}};
  for (Vec3 const& p : points) {
    Vec3 const e = p - fit.origin;
    double const d[3] = {e.x, e.y, e.z};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) covariance.m[i][j] += d[i] * d[j];
    fit.extent = std::max(fit.extent, norm(e));
  }
  Eigen const eigen = eigen_symmetric(covariance);
  std::array<int, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(), [&](int i, int j) { return eigen.value[i] < eigen.value[j]; });
  int const n = order[0];
  fit.normal = {eigen.vectors.m[0][n], eigen.vectors.m[1][n], eigen.vectors.m[2][n]};
  fit.normal = (1 / norm(fit.normal)) * fit.normal;
  fit.deviation = deviation_from_plane(points, fit.origin, fit.normal);
  // The middle eigenvalue measures the width across the longest direction: 1e-6 of the length is a line.
  fit.determined = eigen.value[order[1]] > 1e-12 * eigen.value[order[2]] && fit.extent > 0;
  return fit;
}

}  // namespace gridmorph
