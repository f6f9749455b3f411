// How far the corner of a cell is from the shape that it has in the baseline.
//
// With E the three edges at the corner as columns, E0 those of the baseline and F = E E0^-1:
//
//   N = |F|^2,   d = det F,   h = (d + sqrt(d^2 + 4 delta^2)) / 2,   f = N^3 / (27 h^2)
//
// f is 1 for rigid motions with any uniform scale and grows without bound towards inversion (delta = 0): the inverse
// mean ratio, cubed, of the baseline's corner as target (Knupp, "Algebraic mesh quality metrics", SIAM J. Sci. Comput.
// 23 (2001)); delta > 0 makes it finite and smooth for inverted corners (Escobar et al., "Simultaneous untangling and
// smoothing of tetrahedral meshes", Comput. Methods Appl. Mech. Engrg. 192 (2003)).
//
// With b_i the rows of E0^-1 and G_ij = b_i . b_j, N = sum G_ij e_i . e_j and d = det E / det E0: six numbers and one
// of the baseline's corner are enough. A node's move v changes E0^-1-weighted edges by v a^T, where a is b_i for the
// node at the end of edge i and -(b_0 + b_1 + b_2) for the corner's own node; so N and d change exactly by 2 v.Fa +
// |a|^2 v^2 and v.cof(F)a.
//
// Cost of corner_change: about 90 flops.
#pragma once

#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/kernels/vec3.hpp>

#include <cmath>

namespace gridmorph::kernels {

/// What the shape needs of a baseline corner.
struct BaselineCorner {
  double gram[3][3] = {};  ///< b_i . b_j [1 / length^2]
  double inverse_det = 0;  ///< 1 / det E0 [1 / length^3]; 0: collapsed in the baseline, left out

  /// Edges whose box is flatter than `collapsed` give a corner that is left out.
  KOKKOS_INLINE_FUNCTION static BaselineCorner of(Vec3 const (&edge)[3], double collapsed = 1e-12) {
    using std::sqrt;
    BaselineCorner corner;
    double const det = dot(cross(edge[0], edge[1]), edge[2]);
    double const box = sqrt(dot(edge[0], edge[0]) * dot(edge[1], edge[1]) * dot(edge[2], edge[2]));
    if (!(det > collapsed * box || -det > collapsed * box)) return corner;
    Vec3 row[3];
    for (int i = 0; i < 3; ++i) row[i] = (1 / det) * cross(edge[(i + 1) % 3], edge[(i + 2) % 3]);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) corner.gram[i][j] = dot(row[i], row[j]);
    corner.inverse_det = 1 / det;
    return corner;
  }
};

/// N and d of a corner, and how they change with a move v of one point.
struct CornerChange {
  double n = 0, d = 0;
  Vec3 half_slope;    ///< F a: N changes by 2 v . half_slope + bend v . v
  double bend = 0;    ///< |a|^2
  Vec3 volume_slope;  ///< cof(F) a

  [[nodiscard]] KOKKOS_INLINE_FUNCTION double n_after(Vec3 const& v) const {
    return n + 2 * dot(v, half_slope) + bend * dot(v, v);
  }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION double d_after(Vec3 const& v) const { return d + dot(v, volume_slope); }
};

/// How N and d of a corner change where edge i changes by share[i] v: a = sum of share[i] b_i.
KOKKOS_INLINE_FUNCTION CornerChange corner_change(BaselineCorner const& baseline, Vec3 const (&edge)[3],
                                                  double const (&share)[3]) {
  CornerChange c;
  Vec3 const face[3] = {cross(edge[1], edge[2]), cross(edge[2], edge[0]), cross(edge[0], edge[1])};
  c.d = baseline.inverse_det * dot(face[0], edge[0]);
  for (int i = 0; i < 3; ++i) {
    Vec3 const dual = baseline.gram[i][0] * edge[0] + baseline.gram[i][1] * edge[1] + baseline.gram[i][2] * edge[2];
    c.n += dot(dual, edge[i]);
    c.half_slope += share[i] * dual;
    c.volume_slope += (baseline.inverse_det * share[i]) * face[i];
    for (int j = 0; j < 3; ++j) c.bend += share[i] * share[j] * baseline.gram[i][j];
  }
  return c;
}

/// h of a corner and its derivatives with respect to d.
struct SmoothedVolume {
  double value, slope, bend;

  KOKKOS_INLINE_FUNCTION SmoothedVolume(double d, double delta) {
    using std::sqrt;
    double const root = sqrt(d * d + 4 * delta * delta);
    // (d + root) / 2, without cancellation where d is negative.
    value = d > 0 ? 0.5 * (d + root) : (delta > 0 ? 2 * delta * delta / (root - d) : 0);
    slope = root > 0 ? value / root : 0;
    bend = root > 0 ? 2 * delta * delta / (root * root * root) : 0;
  }
};

/// The measure f; infinite where delta is zero and d not positive.
KOKKOS_INLINE_FUNCTION double relative_shape(double n, double d, double delta) {
  double const h = SmoothedVolume(d, delta).value;
  return h > 0 ? n * n * n / (27 * h * h) : HUGE_VAL;
}

/// Value, gradient and Hessian of a sum of f over corners, with respect to the move of one point.
struct ShapeSum {
  double value = 0;
  Vec3 gradient;
  double hessian[3][3] = {};

  KOKKOS_INLINE_FUNCTION void add(CornerChange const& c, double delta) {
    SmoothedVolume const h(c.d, delta);
    double const f = relative_shape(c.n, c.d, delta);
    value += f;
    // With N' = 2 F a, d' = cof(F) a: f' = f p, f'' = f (p p + 6 |a|^2 / N - 3 N' N' / N^2 + 2 (h'^2 - h h'') / h^2 d'
    // d').
    Vec3 const along = (2 / c.n) * c.half_slope;
    double const volume = h.slope / h.value;
    Vec3 const p = 3 * along - (2 * volume) * c.volume_slope;
    gradient += f * p;
    double const of_volume = 2 * f * (volume * volume - h.bend / h.value), of_size = 6 * f * c.bend / c.n;
    double const ps[3] = {p.x, p.y, p.z}, as[3] = {along.x, along.y, along.z},
                 vs[3] = {c.volume_slope.x, c.volume_slope.y, c.volume_slope.z};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) hessian[i][j] += f * (ps[i] * ps[j] - 3 * as[i] * as[j]) + of_volume * vs[i] * vs[j];
      hessian[i][i] += of_size;
    }
  }
};

/// The step of Newton's method where the Hessian is positive definite (3x3, by its Cholesky factors), otherwise against
/// the gradient, as long as the Hessian's size says; zero where there is neither.
KOKKOS_INLINE_FUNCTION Vec3 descent_step(ShapeSum const& sum) {
  using std::sqrt;
  double const(&h)[3][3] = sum.hessian;
  Vec3 const& g = sum.gradient;
  double size = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) size += h[i][j] * h[i][j];
  size = sqrt(size);
  if (!(size > 0)) return {};
  double const least = 1e-12 * size;
  double const p0 = h[0][0];
  if (p0 > least) {
    double const l10 = h[1][0] / p0, l20 = h[2][0] / p0, p1 = h[1][1] - l10 * h[1][0];
    if (p1 > least) {
      double const r21 = h[2][1] - l20 * h[1][0], l21 = r21 / p1, p2 = h[2][2] - l20 * h[2][0] - l21 * r21;
      if (p2 > least) {
        double const y0 = -g.x, y1 = -g.y - l10 * y0, y2 = -g.z - l20 * y0 - l21 * y1;
        double const z = y2 / p2, y = y1 / p1 - l21 * z, x = y0 / p0 - l10 * y - l20 * z;
        return {x, y, z};
      }
    }
  }
  return (-1 / size) * g;
}

/// Gradient and Hessian without what points across `count` directions (unit, at right angles), along which a step is
/// zero.
KOKKOS_INLINE_FUNCTION void restrict_to_tangents(ShapeSum& sum, Vec3 const* across, int count) {
  double const trace = sum.hessian[0][0] + sum.hessian[1][1] + sum.hessian[2][2];
  double const size = trace > 0 ? trace : 1;
  for (int k = 0; k < count; ++k) {
    Vec3 const& n = across[k];
    double const ns[3] = {n.x, n.y, n.z};
    sum.gradient = sum.gradient - dot(sum.gradient, n) * n;
    double hn[3], nhn = 0;
    for (int i = 0; i < 3; ++i)
      hn[i] = sum.hessian[i][0] * ns[0] + sum.hessian[i][1] * ns[1] + sum.hessian[i][2] * ns[2];
    for (int i = 0; i < 3; ++i) nhn += ns[i] * hn[i];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) sum.hessian[i][j] += (nhn + size) * ns[i] * ns[j] - ns[i] * hn[j] - hn[i] * ns[j];
  }
}

}  // namespace gridmorph::kernels
