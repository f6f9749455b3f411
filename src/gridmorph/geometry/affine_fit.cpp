#include <gridmorph/geometry/affine_fit.hpp>
#include <gridmorph/geometry/symmetric_eigen.hpp>
#include <gridmorph/kernels/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace gridmorph {

namespace {

Vec3 column(Mat3 const& a, int c) { return {a.m[0][c], a.m[1][c], a.m[2][c]}; }

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
  Moments spread;
  Mat3 moved{{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}};
  for (std::size_t n = 0; n < points.size(); ++n) {
    Vec3 const d = points[n] - out.centre, u = displacement[n] - out.mean;
    spread.add(share, d);
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) moved.m[r][c] += share * component(u, r) * component(d, c);
  }
  auto const [moment, direction] = PrincipalAxes(spread);
  constexpr double flat = 1e-12;  // of the variance
  constexpr double thin = 0.1;
  Vec3 middle;
  for (Vec3 const& p : region) middle += (1 / double(region.size())) * p;
  std::array<Vec3, 3> image;  // of the eigenvectors
  int known = 0, missing = -1;
  for (int k = 0; k < 3; ++k) {
    double const variance = moment[k];
    Vec3 const e = direction[k];
    double of_region = 0;
    for (Vec3 const& p : region) of_region += dot(p - middle, e) * dot(p - middle, e) / double(region.size());
    if (!(variance > flat * moment[0] && variance > thin * of_region)) {
      missing = k;
      continue;
    }
    ++known;
    Vec3 const slope = (1 / variance) * (moved * e);
    image[k] = e + slope;
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) out.gradient.m[r][c] += component(slope, r) * component(e, c);
  }
  bool turns = false;
  for (auto const& row : out.gradient.m)
    for (double const g : row) turns = turns || g != 0;
  if (known == 2 && turns) {
    Vec3 const e = direction[missing];
    int const next = (missing + 1) % 3, last = (missing + 2) % 3;
    Vec3 across = cross(image[next], image[last]);
    if (dot(cross(direction[next], direction[last]), e) < 0) across = -1.0 * across;
    if (double const length = norm(across); length > 0) {
      Vec3 const slope = (1 / length) * across - e;
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) out.gradient.m[r][c] += component(slope, r) * component(e, c);
    }
  }
  return out;
}

}  // namespace gridmorph
