// The motion of walls carried into the volume by moving least squares: at each node x the affine motion that fits best
// what the walls do, those weighed most that are nearest at the scale of the distance d,
//
//   u(x) = u_0 + k B (x - x_0),   x_0 = sum of w_i x_i,   u_0 = sum of w_i u_i,   w_i = A_i / |x - x_i|^p, sum 1
//   B = (sum of w_i u_i (x_i - x_0)^T + m sum of w_i G_i) (sum of w_i (x_i - x_0)(x_i - x_0)^T + m I)^-1,   m = d^2
//
// with u_i where wall node i goes, G_i how the wall turns there (R_i - I), k planned: 1, or less far from walls that
// turn as wholes. A common motion of the walls is that of x for k = 1, whatever the weights; beside a wall x moves as
// the wall does, far away as all of it on average. All weights are the baseline's, so this is linear in u and G: with
// b = k (...)^-1 (x - x_0)
//
//   u(x) = sum over groups g of w_g [ (1 - x_0 . b) u_g + (Q_g + m G_g) b ],   Q = mean of u x^T
//
// far groups of wall nodes as one (P. Lancaster, K. Salkauskas, Math. Comput. 37 (1981) 141, for moving least squares;
// S. Schaefer et al., ACM Trans. Graph. 25 (2006) 533, for their use to deform).
//
// Cost per node: 60 bytes of tables, and of each group 8 bytes, 168 from cache and 42 flops.
#pragma once

#include <gridmorph/kernels/interpolation_rows.hpp>
#include <gridmorph/kernels/inverse_distance.hpp>
#include <gridmorph/kernels/transposed_rows.hpp>

namespace gridmorph::kernels {

/// Means over wall nodes, or sums: of u, u x^T (x from a common origin) and G.
struct MotionMoments {
  Vec3 u;
  double lever[3][3] = {}, turn[3][3] = {};

  KOKKOS_INLINE_FUNCTION MotionMoments& add(double w, MotionMoments const& b) {
    u += w * b.u;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        lever[i][j] += w * b.lever[i][j];
        turn[i][j] += w * b.turn[i][j];
      }
    return *this;
  }
  KOKKOS_INLINE_FUNCTION MotionMoments& operator+=(MotionMoments const& b) { return add(1, b); }
  friend KOKKOS_INLINE_FUNCTION MotionMoments operator+(MotionMoments a, MotionMoments const& b) { return a.add(1, b); }
  friend KOKKOS_INLINE_FUNCTION MotionMoments operator-(MotionMoments a, MotionMoments const& b) {
    return a.add(-1, b);
  }
  friend KOKKOS_INLINE_FUNCTION MotionMoments operator*(double w, MotionMoments const& b) {
    return MotionMoments{}.add(w, b);
  }
};

/// moment(k) of a wall node from its frame: where it goes and how the wall turns there; of all nodes, then of those of
/// each image.
template <class MemorySpace>
struct MomentsOfFrames {
  Kokkos::View<std::int32_t const*, MemorySpace> node;
  Kokkos::View<WallImage const*, MemorySpace> image;  ///< the walls themselves are none
  Field<double const> x;
  Vec3 origin;
  AffineMotion const* frame;
  MotionMoments* moment;

  [[nodiscard]] Index size() const { return Index(node.extent(0) * (1 + image.extent(0))); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    Index const n = Index(node.extent(0)), wall = k % n;
    Vec3 place = x[node(wall)];
    AffineMotion motion = frame[wall];
    if (k >= n) {
      WallImage const& to = image(k / n - 1);
      place = to.rotation * place + to.translation;
      motion = {to.rotation * motion.u, to.rotation * (motion.gradient * kernels::transpose(to.rotation))};
    }
    Vec3 const arm = place - origin;
    double const a[3] = {arm.x, arm.y, arm.z}, v[3] = {motion.u.x, motion.u.y, motion.u.z};
    MotionMoments m;
    m.u = motion.u;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        m.lever[i][j] = v[i] * a[j];
        m.turn[i][j] = motion.gradient.m[i][j];
      }
    moment[k] = m;
  }
};

/// What each node makes of the means of its groups.
template <class MemorySpace>
struct LeastSquaresTable {
  InterpolationTable<MemorySpace> rows;            ///< groups -> nodes
  Kokkos::View<Vec3 const*, MemorySpace> lean;     ///< per row: b
  Kokkos::View<double const*, MemorySpace> level;  ///< 1 - x_0 . b, x_0 from the origin
  Kokkos::View<double const*, MemorySpace> room;   ///< m

  /// The displacement of the node of row r.
  KOKKOS_INLINE_FUNCTION Vec3 at(MotionMoments const* group, Index r) const {
    Index const from = rows.first(r), to = rows.first(r + 1);
    MotionMoments sum;
    double rest = 1;
    for (Index k = from + 1; k < to; ++k) {
      double const w = rows.weight(k);
      rest -= w;
      sum.add(w, group[rows.item(k)]);
    }
    sum.add(rest, group[rows.item(from)]);
    Vec3 const b = lean(r);
    double const c[3] = {b.x, b.y, b.z}, m = room(r);
    double v[3] = {0, 0, 0};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) v[i] += (sum.lever[i][j] + m * sum.turn[i][j]) * c[j];
    return level(r) * sum.u + Vec3{v[0], v[1], v[2]};
  }
};

/// left(n) = u(n) - what the walls carry there; of all rows.
template <class MemorySpace>
struct LeastSquaresMisses {
  LeastSquaresTable<MemorySpace> table;
  MotionMoments const* group;
  Vec3 const* u;
  Vec3* left;
  KOKKOS_INLINE_FUNCTION void operator()(Index r) const {
    Index const n = table.rows.target(r);
    left[n] = u[n] - table.at(group, r);
  }
};

/// u(n) = what the walls carry there + share(r) missing(n).
template <class MemorySpace>
struct LeastSquaresAndMissing {
  LeastSquaresTable<MemorySpace> table;
  Kokkos::View<float const*, MemorySpace> share;  ///< per row
  MotionMoments const* group;
  Vec3 const* missing;
  Vec3* u;
  KOKKOS_INLINE_FUNCTION void operator()(Index r) const {
    Index const n = table.rows.target(r);
    Vec3 v = table.at(group, r);
    if (share(r) != 0) v += double(share(r)) * missing[n];
    u[n] = v;
  }
};

/// Gradients of groups from those of what nodes read; targets of the rows are rows of the table.
template <class MemorySpace>
struct GroupsFromLeastSquares {
  TransposedRows<MemorySpace> rows;
  LeastSquaresTable<MemorySpace> table;
  Vec3 const* read;  ///< by node
  MotionMoments* group;

  [[nodiscard]] Index size() const { return rows.size(); }
  KOKKOS_INLINE_FUNCTION void operator()(Index s) const {
    MotionMoments sum;
    for (Index k = rows.first(s); k < rows.first(s + 1); ++k) {
      Index const r = rows.target(k);
      Vec3 const g = rows.weight(k) * read[table.rows.target(r)], b = table.lean(r);
      sum.u += table.level(r) * g;
      double const v[3] = {g.x, g.y, g.z}, c[3] = {b.x, b.y, b.z}, m = table.room(r);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          sum.lever[i][j] += v[i] * c[j];
          sum.turn[i][j] += m * v[i] * c[j];
        }
    }
    group[rows.source(s)] += sum;
  }
};

/// Transpose of MomentsOfFrames, by wall nodes: adds to the gradients of frames.
template <class MemorySpace>
struct FramesFromMoments {
  Kokkos::View<std::int32_t const*, MemorySpace> node;
  Kokkos::View<WallImage const*, MemorySpace> image;
  Field<double const> x;
  Vec3 origin;
  MotionMoments const* moment;
  AffineMotion* frame;

  [[nodiscard]] Index size() const { return Index(node.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    AffineMotion sum = frame[k] + of_moment(moment[k], x[node(k)]);
    for (Index i = 0; i < Index(image.extent(0)); ++i) {
      WallImage const& to = image(i);
      AffineMotion const g =
          of_moment(moment[(i + 1) * Index(node.extent(0)) + k], to.rotation * x[node(k)] + to.translation);
      Mat3 const back = kernels::transpose(to.rotation);
      sum += {back * g.u, back * (g.gradient * to.rotation)};
    }
    frame[k] = sum;
  }

 private:
  KOKKOS_INLINE_FUNCTION AffineMotion of_moment(MotionMoments const& m, Vec3 const& place) const {
    Vec3 const arm = place - origin;
    double const a[3] = {arm.x, arm.y, arm.z};
    AffineMotion out;
    double v[3] = {0, 0, 0};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        v[i] += m.lever[i][j] * a[j];
        out.gradient.m[i][j] = m.turn[i][j];
      }
    out.u = m.u + Vec3{v[0], v[1], v[2]};
    return out;
  }
};

}  // namespace gridmorph::kernels
