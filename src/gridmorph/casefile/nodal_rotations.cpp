#include <gridmorph/casefile/facet_map.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace gridmorph {

namespace {

Mat3 from_columns(Vec3 const& a, Vec3 const& b, Vec3 const& c) {
  return {{{a.x, b.x, c.x}, {a.y, b.y, c.y}, {a.z, b.z, c.z}}};
}

Vec3 row(Mat3 const& a, int r) { return {a.m[r][0], a.m[r][1], a.m[r][2]}; }

/// Inverse of a matrix whose determinant is not zero.
Mat3 inverse(Mat3 const& a) {
  Vec3 const x = row(a, 0), y = row(a, 1), z = row(a, 2);
  Vec3 const u = cross(y, z), v = cross(z, x), w = cross(x, y);
  double const scale = 1 / dot(x, u);
  return from_columns(scale * u, scale * v, scale * w);
}

/// The rotation of a deformation with a positive determinant: Newton's iteration X <- (X + X^-T) / 2 (N. J. Higham,
/// "Computing the polar decomposition - with applications", SIAM J. Sci. Stat. Comput. 7 (1986)).
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

/// Angle times axis of a rotation; the identity gives exactly zero.
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

struct Frame {
  Vec3 a, b, normal;  ///< tangents at the middle, unit normal
  double area = 0;
};

Frame frame_of(std::array<Vec3, 4> const& x, int corners) {
  Frame f;
  if (corners == 3) {
    f.a = x[1] - x[0];
    f.b = x[2] - x[0];
  } else {
    f.a = 0.5 * ((x[1] - x[0]) + (x[2] - x[3]));
    f.b = 0.5 * ((x[3] - x[0]) + (x[2] - x[1]));
  }
  Vec3 const n = cross(f.a, f.b);
  f.area = norm(n);
  if (f.area > 0) f.normal = (1 / f.area) * n;
  return f;
}

}  // namespace

std::vector<Vec3> nodal_rotations(StructuralModel const& model, std::span<Vec3 const> displacement) {
  std::vector<Vec3> rotation(model.nodes.size());
  std::vector<double> weight(model.nodes.size(), 0.0);
  for (StructuralFacet const& facet : model.facets) {
    int const n = facet.corners();
    std::array<Vec3, 4> x{}, moved{}, u{};
    for (int c = 0; c < n; ++c) {
      x[c] = model.nodes.position[facet.node[c]];
      u[c] = displacement[facet.node[c]];
      moved[c] = x[c] + u[c];
    }
    Frame const before = frame_of(x, n), after = frame_of(moved, n);
    if (before.area == 0 || after.area == 0) continue;
    // I + H with H from differences, so that no displacement gives exactly the identity. The normal is that of the moved
    // element; the tangents' changes are the displacement's own differences.
    Frame const change = frame_of(u, n);
    bool const still = change.a == Vec3{0, 0, 0} && change.b == Vec3{0, 0, 0};
    Vec3 const turned = still ? Vec3{0, 0, 0} : after.normal - before.normal;
    Mat3 f = from_columns(change.a, change.b, turned) * inverse(from_columns(before.a, before.b, before.normal));
    for (int d = 0; d < 3; ++d) f.m[d][d] += 1;
    Vec3 const w = before.area * rotation_vector(polar_rotation(f));
    for (int c = 0; c < n; ++c) {
      rotation[facet.node[c]] += w;
      weight[facet.node[c]] += before.area;
    }
  }
  for (std::size_t n = 0; n < rotation.size(); ++n)
    if (weight[n] > 0) rotation[n] = (1 / weight[n]) * rotation[n];
  return rotation;
}

}  // namespace gridmorph
