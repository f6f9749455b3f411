#include <gridmorph/geometry/rotation.hpp>

#include <algorithm>
#include <cmath>

namespace gridmorph {

Vec3 RigidTransform::operator()(Vec3 const& x) const { return rotation * x + translation; }

RigidTransform RigidTransform::inverse() const {
  Mat3 const rt = transpose(rotation);
  return {rt, -(rt * translation)};
}

RigidTransform RigidTransform::then(RigidTransform const& next) const {
  return {next.rotation * rotation, next.rotation * translation + next.translation};
}

namespace {

Vec3 row(Mat3 const& a, int r) { return {a.m[r][0], a.m[r][1], a.m[r][2]}; }

Vec3 mean(std::span<Vec3 const> points) {
  Vec3 sum;
  for (Vec3 const& p : points) sum += p;
  return (1 / double(points.size())) * sum;
}

}  // namespace

Mat3 from_columns(Vec3 const& a, Vec3 const& b, Vec3 const& c) {
  return {{{a.x, b.x, c.x}, {a.y, b.y, c.y}, {a.z, b.z, c.z}}};
}

Mat3 cofactor(Mat3 const& a) {
  Vec3 const x = row(a, 0), y = row(a, 1), z = row(a, 2);
  return transpose(from_columns(cross(y, z), cross(z, x), cross(x, y)));
}

double determinant(Mat3 const& a) { return dot(row(a, 0), cross(row(a, 1), row(a, 2))); }

Mat3 inverse(Mat3 const& a) {
  Vec3 const x = row(a, 0), y = row(a, 1), z = row(a, 2);
  Vec3 const u = cross(y, z), v = cross(z, x), w = cross(x, y);
  double const scale = 1 / dot(x, u);
  return from_columns(scale * u, scale * v, scale * w);
}

Mat3 polar_rotation(Mat3 x) {
  for (int n = 0; n < 30; ++n) {
    Mat3 const t = transpose(inverse(x));
    double change = 0;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        double const next = 0.5 * (x.m[i][j] + t.m[i][j]);
        change = std::max(change, std::fabs(next - x.m[i][j]));
        x.m[i][j] = next;
      }
    if (change < 1e-15) break;
  }
  return x;
}

Vec3 rotation_vector(Mat3 const& r) {
  // The quaternion with the largest component from the diagonal, so that nothing is lost at angles near pi.
  double const trace = r.m[0][0] + r.m[1][1] + r.m[2][2];
  Vec3 const skew{r.m[2][1] - r.m[1][2], r.m[0][2] - r.m[2][0], r.m[1][0] - r.m[0][1]};
  double const sine = 0.5 * norm(skew), cosine = 0.5 * (trace - 1);
  if (sine == 0 && cosine > 0) return {0, 0, 0};
  if (cosine > -0.9) return (std::atan2(sine, cosine) / (2 * sine)) * skew;
  int const k = r.m[0][0] >= r.m[1][1] && r.m[0][0] >= r.m[2][2] ? 0 : r.m[1][1] >= r.m[2][2] ? 1 : 2;
  Vec3 axis{0.5 * (r.m[0][k] + r.m[k][0]), 0.5 * (r.m[1][k] + r.m[k][1]), 0.5 * (r.m[2][k] + r.m[k][2])};
  (k == 0 ? axis.x : k == 1 ? axis.y : axis.z) -= cosine;
  if (dot(axis, skew) < 0) axis = -axis;
  return (std::atan2(sine, cosine) / norm(axis)) * axis;
}

Mat3 rotation_by(Vec3 const& v) {
  double const angle = norm(v);
  return angle > 0 ? rotation_matrix((1 / angle) * v, angle) : Mat3();
}

std::optional<RigidFit> rigid_fit(std::span<Vec3 const> before, std::span<Vec3 const> after) {
  if (before.empty()) return {};
  RigidFit fit{mean(before), mean(after), {}};
  Mat3 h{{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}};
  for (std::size_t n = 0; n < before.size(); ++n) {
    Vec3 const x = before[n] - fit.from, y = after[n] - fit.to;
    for (int j = 0; j < 3; ++j) {
      double const xj = j == 0 ? x.x : j == 1 ? x.y : x.z;
      h.m[0][j] += y.x * xj;
      h.m[1][j] += y.y * xj;
      h.m[2][j] += y.z * xj;
    }
  }
  double size = 0;
  for (auto const& r : h.m)
    for (double const value : r) size += value * value;
  size = std::sqrt(size);
  if (!(size > 0)) return {};
  for (auto& r : h.m)
    for (double& value : r) value /= size;
  constexpr double smallest = 1e-9;  // where all directions were alike it would be 0.2
  if (determinant(h) < -smallest) return {};
  Mat3 const c = cofactor(h);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) h.m[i][j] += c.m[i][j];
  if (!(determinant(h) > smallest)) return {};
  fit.rotation = polar_rotation(h);
  return fit;
}

}  // namespace gridmorph
