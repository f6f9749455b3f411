#include <gridmorph/geometry/smoothstep.hpp>
#include <gridmorph/kernels/symmetric_eigen.hpp>
#include <gridmorph/plan/elements/body_stretch.hpp>

#include <algorithm>
#include <cmath>

namespace gridmorph {

namespace {

Vec3 beside(Vec3 const& axis, Vec3 const& v) { return v - dot(axis, v) * axis; }

}  // namespace

void BodyStretch::add_place(double w, Vec3 const& arm) {
  Vec3 const y = beside(axis_, arm);
  double const c[3] = {y.x, y.y, y.z};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) moments_[i][j] += w * c[i] * c[j];
}

void BodyStretch::find_axes() {
  double v[3][3];
  kernels::diagonalise(moments_, v);
  double largest = 0;
  for (int k = 0; k < 3; ++k) largest = std::max(largest, moments_[k][k]);
  for (auto& row : limits_.span.m)
    for (double& entry : row) entry = 0;
  if (!(largest > 0)) return;
  if (limits_.even) {
    double const trace = moments_[0][0] + moments_[1][1] + moments_[2][2];
    for (int k = 0; k < 3; ++k)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) limits_.span.m[i][j] += moments_[k][k] / trace * v[k][i] * v[k][j];
    for (int i = 0; i < 3; ++i) inverse_[i][i] = 1 / trace;
    return;
  }
  constexpr double thin = 0.01, full = 0.03;
  for (int k = 0; k < 3; ++k) {
    double const extent = std::sqrt(std::max(0.0, moments_[k][k] / largest));
    double const share = smoothstep((extent - thin) / (full - thin));
    if (share == 0) continue;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        limits_.span.m[i][j] += share * v[k][i] * v[k][j];
        inverse_[i][j] += share * v[k][i] * v[k][j] / moments_[k][k];
      }
  }
}

Vec3 BodyStretch::lever(double w, Vec3 const& arm) const {
  Vec3 const y = limits_.even ? beside(axis_, arm) : arm;
  auto const row = [&](int i) { return inverse_[i][0] * y.x + inverse_[i][1] * y.y + inverse_[i][2] * y.z; };
  return w * Vec3{row(0), row(1), row(2)};
}

void BodyStretch::fit() {
  kernels::StretchMap const n = kernels::in_plane(moments_of_u_, axis_);
  for (int a = 0; a < 3; ++a) stretch_.column[a] = kernels::stretched(limits_, whole_, a, n.column[a]);
  if (limits_.even) stretch_ = kernels::evened(stretch_, axis_);
}

void BodyStretch::add_rest(double w, Vec3 const& arm, Vec3 const& u) {
  Vec3 const left = u - whole_.turned(arm);
  Vec3 const v = left + whole_.back().turned(left), beyond = v - stretch_ * arm;
  largest_rest_ = std::max(largest_rest_, norm(v));
  before_ += w * dot(v, v);
  after_ += w * dot(beyond, beyond);
}

void BodyStretch::decide(double size) {
  double const rounding = 1e-12 * size;
  double const explained = before_ > rounding * rounding ? 1 - after_ / before_ : 0;
  if (largest_rest_ < 1e-6 * size) largest_rest_ = 0;
  limits_.share = limits_.even ? smoothstep((explained - 0.8) / 0.15) : smoothstep((explained - 0.5) / 0.4);
  for (Vec3& column : stretch_.column) column = limits_.share * column;
}

Vec3 BodyStretch::rest(Vec3 const& arm, Vec3 const& u) const {
  Vec3 const more = stretch_ * arm;
  return u - more - whole_.turned(arm + more);
}

}  // namespace gridmorph
