#include <gridmorph/geometry/rotation.hpp>

#include <gridmorph/geometry/symmetric_eigen.hpp>

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

/// The weight of point n; all are alike where none are given.
double weight_of(std::span<double const> weights, std::size_t n) { return weights.empty() ? 1 : weights[n]; }

Vec3 mean_of(std::span<Vec3 const> points, std::span<double const> weights) {
  Vec3 sum;
  double total = 0;
  for (std::size_t n = 0; n < points.size(); ++n) {
    sum += weight_of(weights, n) * points[n];
    total += weight_of(weights, n);
  }
  return (1 / total) * sum;
}

/// Eigenvectors are quaternions (w, x, y, z); s[a][b] = sum of from_a to_b.
SymmetricEigen<4> quaternions(SmallMatrix<3> const& s) {
  return symmetric_eigen<4>(
      {{{s[0][0] + s[1][1] + s[2][2], s[1][2] - s[2][1], s[2][0] - s[0][2], s[0][1] - s[1][0]},
        {s[1][2] - s[2][1], s[0][0] - s[1][1] - s[2][2], s[0][1] + s[1][0], s[2][0] + s[0][2]},
        {s[2][0] - s[0][2], s[0][1] + s[1][0], -s[0][0] + s[1][1] - s[2][2], s[1][2] + s[2][1]},
        {s[0][1] - s[1][0], s[2][0] + s[0][2], s[1][2] + s[2][1], -s[0][0] - s[1][1] + s[2][2]}}});
}

Mat3 rotation_of(std::array<double, 4> const& quaternion) {
  auto const [w, x, y, z] = quaternion;
  double const l = w * w + x * x + y * y + z * z;
  return {{{(w * w + x * x - y * y - z * z) / l, 2 * (x * y - w * z) / l, 2 * (x * z + w * y) / l},
           {2 * (x * y + w * z) / l, (w * w - x * x + y * y - z * z) / l, 2 * (y * z - w * x) / l},
           {2 * (x * z - w * y) / l, 2 * (y * z + w * x) / l, (w * w - x * x - y * y + z * z) / l}}};
}

struct Correlation {
  Vec3 from, to;  ///< means
  SmallMatrix<3> sum{};

  Correlation(std::span<Vec3 const> before, std::span<Vec3 const> after, std::span<double const> weights = {})
      : from(mean_of(before, weights)), to(mean_of(after, weights)) {
    for (std::size_t n = 0; n < before.size(); ++n) {
      Vec3 const f = before[n] - from, t = after[n] - to;
      std::array<double, 3> const fv{f.x, f.y, f.z}, tv{t.x, t.y, t.z};
      for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t b = 0; b < 3; ++b) sum[a][b] += weight_of(weights, n) * (fv[a] * tv[b]);
    }
  }
  [[nodiscard]] double size() const {
    double squares = 0;
    for (auto const& row : sum)
      for (double const v : row) squares += v * v;
    return std::sqrt(squares);
  }
  [[nodiscard]] double determinant() const {
    auto const row = [&](std::size_t r) { return Vec3{sum[r][0], sum[r][1], sum[r][2]}; };
    return dot(row(0), cross(row(1), row(2)));
  }
};

}  // namespace

Mat3 rotation_matrix(Vec3 const& direction, double angle_rad) {
  double const s = std::sin(angle_rad), c = std::cos(angle_rad), v = 1 - c;
  auto const [x, y, z] = direction;
  return {{{c + x * x * v, x * y * v - z * s, x * z * v + y * s},
           {y * x * v + z * s, c + y * y * v, y * z * v - x * s},
           {z * x * v - y * s, z * y * v + x * s, c + z * z * v}}};
}

RigidTransform rotation_about(Vec3 const& origin, Vec3 const& direction, double angle_rad) {
  Mat3 const r = rotation_matrix((1 / norm(direction)) * direction, angle_rad);
  return {r, origin - r * origin};
}

Mat3 nearest_rotation(Mat3 const& m) {
  SmallMatrix<3> s{};
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = 0; b < 3; ++b) s[a][b] = m.m[b][a];
  return rotation_of(quaternions(s).vector[0]);
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

RigidTransform fit_rigid_transform(std::span<Vec3 const> from, std::span<Vec3 const> to) {
  Correlation const c(from, to);
  Mat3 const r = rotation_of(quaternions(c.sum).vector[0]);
  return {r, c.to - r * c.from};
}

std::optional<RigidFit> rigid_fit(std::span<Vec3 const> before, std::span<Vec3 const> after,
                                  std::span<double const> weights) {
  if (before.empty()) return {};
  Correlation const c(before, after, weights);
  double const size = c.size();
  // With singular values a >= b >= c of the sum, negative c where it mirrors, the two greatest eigenvalues are a + b +
  // c and a - b - c.
  constexpr double mirrored = 1e-9, alone = 6e-5;
  if (!(size > 0) || c.determinant() < -mirrored * size * size * size) return {};
  auto const q = quaternions(c.sum);
  if (!(q.value[0] - q.value[1] > alone * size)) return {};
  return RigidFit{c.from, c.to, rotation_of(q.vector[0])};
}

}  // namespace gridmorph
