#include <gridmorph/geometry/affine_fit.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace gridmorph {

namespace {

double entry(Vec3 const& v, int c) { return c == 0 ? v.x : c == 1 ? v.y : v.z; }
Vec3 column(Mat3 const& a, int c) { return {a.m[0][c], a.m[1][c], a.m[2][c]}; }

/// Eigenvectors (columns) of a symmetric matrix by Jacobi rotations; a becomes diagonal.
Mat3 eigenvectors(Mat3& a) {
  Mat3 v;
  for (int sweep = 0; sweep < 30; ++sweep)
    for (int p = 0; p < 2; ++p)
      for (int q = p + 1; q < 3; ++q) {
        if (a.m[p][q] == 0) continue;
        double const h = (a.m[q][q] - a.m[p][p]) / (2 * a.m[p][q]);
        double const t = (h >= 0 ? 1.0 : -1.0) / (std::fabs(h) + std::sqrt(h * h + 1));
        double const c = 1 / std::sqrt(t * t + 1), s = t * c;
        auto const turn = [&](double& left, double& right) {
          double const l = left, r = right;
          left = c * l - s * r;
          right = s * l + c * r;
        };
        for (int k = 0; k < 3; ++k) turn(a.m[k][p], a.m[k][q]);
        for (int k = 0; k < 3; ++k) turn(a.m[p][k], a.m[q][k]);
        for (int k = 0; k < 3; ++k) turn(v.m[k][p], v.m[k][q]);
      }
  return v;
}

}  // namespace

Vec3 AffineDisplacement::turned(Vec3 const& n) const {
  Mat3 m = gradient;
  for (int c = 0; c < 3; ++c) m.m[c][c] += 1;
  return n.x * cross(column(m, 1), column(m, 2)) + n.y * cross(column(m, 2), column(m, 0)) +
         n.z * cross(column(m, 0), column(m, 1));
}

AffineDisplacement fit_affine(std::span<Vec3 const> points, std::span<Vec3 const> displacement,
                              std::span<Vec3 const> region) {
  AffineDisplacement out;
  if (points.empty()) return out;
  double const share = 1 / double(points.size());
  for (Vec3 const& p : points) out.centre += share * p;
  for (Vec3 const& u : displacement) out.mean += share * u;
  Mat3 spread{{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}}, moved = spread;
  for (std::size_t n = 0; n < points.size(); ++n) {
    Vec3 const d = points[n] - out.centre, u = displacement[n] - out.mean;
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) {
        spread.m[r][c] += share * entry(d, r) * entry(d, c);
        moved.m[r][c] += share * entry(u, r) * entry(d, c);
      }
  }
  Mat3 const v = eigenvectors(spread);
  double const largest = std::max({spread.m[0][0], spread.m[1][1], spread.m[2][2]});
  constexpr double flat = 1e-12;  // of the variance
  constexpr double thin = 0.1;
  Vec3 middle;
  for (Vec3 const& p : region) middle += (1 / double(region.size())) * p;
  std::array<Vec3, 3> image;  // of the eigenvectors
  int known = 0, missing = -1;
  for (int k = 0; k < 3; ++k) {
    double const variance = spread.m[k][k];
    Vec3 const e = column(v, k);
    double of_region = 0;
    for (Vec3 const& p : region) of_region += dot(p - middle, e) * dot(p - middle, e) / double(region.size());
    if (!(variance > flat * largest && variance > thin * of_region)) {
      missing = k;
      continue;
    }
    ++known;
    Vec3 const slope = (1 / variance) * (moved * e);
    image[k] = e + slope;
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) out.gradient.m[r][c] += entry(slope, r) * entry(e, c);
  }
  bool turns = false;
  for (auto const& row : out.gradient.m)
    for (double const g : row) turns = turns || g != 0;
  if (known == 2 && turns) {
    Vec3 const e = column(v, missing);
    Vec3 across = cross(image[(missing + 1) % 3], image[(missing + 2) % 3]);
    if (dot(cross(column(v, (missing + 1) % 3), column(v, (missing + 2) % 3)), e) < 0) across = -1.0 * across;
    if (double const length = norm(across); length > 0) {
      Vec3 const slope = (1 / length) * across - e;
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) out.gradient.m[r][c] += entry(slope, r) * entry(e, c);
    }
  }
  return out;
}

}  // namespace gridmorph
