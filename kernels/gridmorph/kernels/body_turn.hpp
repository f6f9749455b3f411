// Bodies that move: the rotation, the stretch and the shift that the walls of each make as a whole, and what they do to
// every node.
//
//   u(x) += sum over bodies b of R_b(f_b) (y + f_b E_b y) - y + s_b (t_b - t_0),   y = x - c_b
//
// c_b is the mean place of the body's walls, R_b the mean of how they turn around their nodes (wall_turn.hpp), R(f) the
// share f of a rotation, t_b the mean displacement of its walls over their area, t_0 that of all other boundaries that
// are displaced by rules, E_b how the body stretches (body_stretch.hpp), nothing unless planned. f_b and s_b are shares
// planned for each node: 1 on the body and 0 on other boundaries. What walls do beyond that is carried by the rest of a
// morph; t_0 leaves a motion that all boundaries have in common to it. The mean of rotations, not the rigid motion that
// fits displacements best: a wing that bends does not pitch, although its swept tip goes up.
//
// R_b: the rotation nearest to s = sum of w R_w, w the share of a wall node in the area: the unit quaternion that is
// the eigenvector of the greatest eigenvalue of a symmetric 4x4 matrix of sums of entries of s (B. K. P. Horn,
// "Closed-form solution of absolute orientation using unit quaternions", JOSA A 4 (1987) 629). Where a body may turn
// about one axis n alone (in the plane, on a plane that its nodes slide on): by the angle with the tangent n . axial
// part of s / (trace of s - n . s n). Its rate: R' = R [p]x with
//
//   (tr(P) I - P) p = axial part of R^T s' - s'^T R,   P = R^T s
//
// A body that is not displaced turns by exactly nothing; one whose walls turn in all directions alike by nothing.
//
// R(f): the quaternion h of half of R_b, f of the chord from no rotation to h and back onto the sphere, squared. So the
// angle is f times the whole one to 2 degrees over half a turn, nothing shrinks, and a node costs no trigonometry. Half
// a turn has one axis for all nodes (canonical()).
//
// Behind periodic connections a body comes again as images: image k, moved by x' = Q x + t, adds what the body does at
// Q^T (x - t), turned by Q, with a share of its own.
//
// Cost per wall node: 24 bytes of tables and 120 of its motion read, 24 flops. Per node: 16 bytes of shares for each
// body, 24 of coordinates and 48 of displacements, about 76 flops where the shares are not zero.
#pragma once

#include <gridmorph/kernels/body_stretch.hpp>
#include <gridmorph/kernels/column_motion.hpp>
#include <gridmorph/kernels/inverse_distance.hpp>
#include <gridmorph/kernels/lanes.hpp>
#include <gridmorph/kernels/launch.hpp>
#include <gridmorph/kernels/rotation.hpp>
#include <gridmorph/kernels/symmetric_eigen.hpp>
#include <gridmorph/kernels/vector_array.hpp>

namespace gridmorph::kernels {

/// Sums of products of two vectors; zero at first, unlike Mat3.
struct VectorMoments {
  double m[3][3] = {};  ///< [a][b]: component a of the first, b of the second

  KOKKOS_INLINE_FUNCTION void add(Vec3 const& first, Vec3 const& second) {
    double const a[3] = {first.x, first.y, first.z}, b[3] = {second.x, second.y, second.z};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) m[i][j] += a[i] * b[j];
  }
  KOKKOS_INLINE_FUNCTION VectorMoments& operator+=(VectorMoments const& other) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) m[i][j] += other.m[i][j];
    return *this;
  }
  /// Sum of the cross products, first x second.
  [[nodiscard]] KOKKOS_INLINE_FUNCTION Vec3 crossed() const {
    return {m[1][2] - m[2][1], m[2][0] - m[0][2], m[0][1] - m[1][0]};
  }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION double trace() const { return m[0][0] + m[1][1] + m[2][2]; }
  /// Sum of the products of the components along n.
  [[nodiscard]] KOKKOS_INLINE_FUNCTION double along(Vec3 const& n) const {
    double const c[3] = {n.x, n.y, n.z};
    double sum = 0;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) sum += c[i] * m[i][j] * c[j];
    return sum;
  }
};

/// The quaternion (real, imaginary), real not negative, of the rotation that fits best to moments of rotated vectors,
/// with those before as first and those after as second ones; no rotation where the best one is not the only one.
KOKKOS_INLINE_FUNCTION void best_quaternion(VectorMoments const& s, double& real, Vec3& imaginary) {
  auto const& m = s.m;
  Vec3 const c = s.crossed();
  double a[4][4] = {{s.trace(), c.x, c.y, c.z},
                    {c.x, m[0][0] - m[1][1] - m[2][2], m[0][1] + m[1][0], m[2][0] + m[0][2]},
                    {c.y, m[0][1] + m[1][0], -m[0][0] + m[1][1] - m[2][2], m[1][2] + m[2][1]},
                    {c.z, m[2][0] + m[0][2], m[1][2] + m[2][1], -m[0][0] - m[1][1] + m[2][2]}};
  double v[4][4];
  diagonalise(a, v);
  int best = 0;
  double size = 0;
  for (int k = 0; k < 4; ++k) {
    if (a[k][k] > a[best][best]) best = k;
    size = larger(size, a[k][k] < 0 ? -a[k][k] : a[k][k]);
  }
  double gap = HUGE_VAL;
  for (int k = 0; k < 4; ++k)
    if (k != best) gap = smaller(gap, a[best][best] - a[k][k]);
  real = 1;
  imaginary = {};
  if (!(gap > 1e-10 * size)) return;
  double const sign = v[best][0] < 0 ? -1 : 1;
  real = sign * v[best][0];
  imaginary = {sign * v[best][1], sign * v[best][2], sign * v[best][3]};
}

/// The vector p of the head of this file: how the best rotation of moments s turns on, seen from what turns, where they
/// change by `rate`.
KOKKOS_INLINE_FUNCTION Vec3 best_rate(VectorMoments const& s, VectorMoments const& rate, Quaternion<Vec3> const& q) {
  // What R^T makes of vectors after is R^T of each row.
  Quaternion<Vec3> const back = q.back();
  auto const turned_back = [&](VectorMoments const& from) {
    VectorMoments to;
    for (int i = 0; i < 3; ++i) {
      Vec3 const row{from.m[i][0], from.m[i][1], from.m[i][2]}, r = row + back.turned(row);
      to.m[i][0] = r.x;
      to.m[i][1] = r.y;
      to.m[i][2] = r.z;
    }
    return to;
  };
  VectorMoments const p = turned_back(s);
  Vec3 const axial = turned_back(rate).crossed();
  double const trace = p.trace();
  Vec3 rows[3];
  for (int i = 0; i < 3; ++i) {
    double r[3];
    for (int j = 0; j < 3; ++j) r[j] = (i == j ? trace : 0) - 0.5 * (p.m[i][j] + p.m[j][i]);
    rows[i] = {r[0], r[1], r[2]};
  }
  Vec3 const c0 = cross(rows[1], rows[2]), c1 = cross(rows[2], rows[0]), c2 = cross(rows[0], rows[1]);
  double const determinant = dot(rows[0], c0);
  if (!(determinant > 1e-30 * trace * trace * trace)) return {};
  return (1 / determinant) * (axial.x * c0 + axial.y * c1 + axial.z * c2);
}

/// The best rotation (as in rotation.hpp) of moments s (vectors before, after), about any axis, or about the unit
/// vector `axis`, if that is not zero. rate: of s, where V has rates.
template <class V>
KOKKOS_INLINE_FUNCTION V best_turn(VectorMoments const& s, [[maybe_unused]] VectorMoments const& rate,
                                   Vec3 const& axis) {
  if (dot(axis, axis) > 0) {
    double const sine = dot(axis, s.crossed()), cosine = s.trace() - s.along(axis);
    if constexpr (has_rate<V>)
      return canonical(
          quarter_tangent(Dual{sine, dot(axis, rate.crossed())}, Dual{cosine, rate.trace() - rate.along(axis)}) *
          V{axis});
    else
      return canonical(quarter_tangent(sine, cosine) * axis);
  }
  double real;
  Vec3 imaginary;
  best_quaternion(s, real, imaginary);
  if constexpr (has_rate<V>) {
    Vec3 const p = best_rate(s, rate, {imaginary, 1 - real});
    Dual const whole{1 + real, -0.5 * dot(imaginary, p)};
    return canonical((1 / whole) * V{imaginary, 0.5 * (real * p + cross(imaginary, p))});
  } else {
    return canonical((1 / (1 + real)) * imaginary);
  }
}

/// The unit quaternion of half of a rotation.
template <class V>
KOKKOS_INLINE_FUNCTION Quaternion<V> quaternion_of_half(V const& r) {
  using std::sqrt;
  using Scalar = typename Quaternion<V>::Scalar;
  auto const square = dot(r, r), size = sqrt(Scalar{1} + square);
  return {(1 / size) * r, square / (size * (Scalar{1} + size))};
}

/// The quaternion of the rotation whose half, or a share of it, is h: its square.
template <class V>
KOKKOS_INLINE_FUNCTION Quaternion<V> twice(Quaternion<V> const& h) {
  using Scalar = typename Quaternion<V>::Scalar;
  Scalar const square = dot(h.imaginary, h.imaginary), double_less = 2 * h.less;
  return {(Scalar{2} - double_less) * h.imaginary, double_less - h.less * h.less + square};
}

/// The walls of bodies that turn.
template <class MemorySpace>
struct BodyWalls {
  Kokkos::View<std::int32_t const*, MemorySpace>
      wall;  ///< wall nodes, numbers in the list of those that drive, body after body
  Kokkos::View<std::int32_t const*, MemorySpace> slot;  ///< of the wall nodes, then of the nodes of other boundaries
  Kokkos::View<double const*, MemorySpace> weight;      ///< likewise: share in the area of its body, or of the others
  Kokkos::View<Index const*, MemorySpace> first;        ///< first slot of each chunk, and the end
  Kokkos::View<Index const*, MemorySpace> first_chunk;  ///< of each body, of the others, and the end
  Kokkos::View<Vec3 const*, MemorySpace> axis;          ///< (n_bodies)
  Index n_wall_chunks = 0;                              ///< chunks of bodies
  Kokkos::View<Vec3 const*, MemorySpace> lever{};       ///< per wall node, of its body's stretch; empty: none stretches
  Kokkos::View<StretchLimits const*, MemorySpace> limits{};  ///< (n_bodies), where bodies stretch
};

/// The gradients R - I around the nodes that drive, by their motion; or the rates of these.
struct FrameGradients {
  AffineMotion const* frame;
  KOKKOS_INLINE_FUNCTION Mat3 const& operator[](Index n) const { return frame[n].gradient; }
};
/// The gradients R - I around the nodes that drive, by their rotations.
struct TurnGradients {
  Field<double const> turn;
  KOKKOS_INLINE_FUNCTION Mat3 operator[](Index n) const {
    return matrix_of_map([r = turn[n]](Vec3 const& e) { return turned_by(r, e); });
  }
};

/// The sum of w (R - I)^T of each chunk of wall nodes. Chunks are those of the plan, so that sums do not depend on
/// threads.
template <class MemorySpace, class Gradients>
struct SumBodyWalls {
  BodyWalls<MemorySpace> walls;
  Gradients gradient;
  VectorMoments* sum;

  [[nodiscard]] Index size() const { return walls.n_wall_chunks; }
  KOKKOS_INLINE_FUNCTION void operator()(Index c) const {
    VectorMoments s;
    for (Index k = walls.first(c); k < walls.first(c + 1); ++k) {
      Mat3 const& g = gradient[walls.wall(k)];
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) s.m[i][j] += walls.weight(k) * g.m[j][i];
    }
    sum[c] = s;
  }
};

/// The rotation of a body, from the sums of its chunks.
template <class V, class MemorySpace>
KOKKOS_INLINE_FUNCTION V mean_turn(BodyWalls<MemorySpace> const& walls, Index body, VectorMoments const* sum,
                                   [[maybe_unused]] VectorMoments const* sum_rate = nullptr) {
  VectorMoments s, rate;
  for (int i = 0; i < 3; ++i) s.m[i][i] = 1;
  for (Index c = walls.first_chunk(body); c < walls.first_chunk(body + 1); ++c) {
    s += sum[c];
    if constexpr (has_rate<V>) rate += sum_rate[c];
  }
  return best_turn<V>(s, rate, walls.axis(body));
}

/// The rotation of each body.
template <class MemorySpace>
struct MeanTurns {
  BodyWalls<MemorySpace> walls;
  VectorMoments const* sum;
  Field<double> turn;

  [[nodiscard]] Index size() const { return Index(walls.axis.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index b) const { turn.set(b, mean_turn<Vec3>(walls, b, sum)); }
};

/// The quaternion of half the rotation of each body; with rates the rate of that.
template <class MemorySpace, class V>
struct TurnBodies {
  BodyWalls<MemorySpace> walls;
  VectorMoments const *sum, *sum_rate;
  Quaternion<Vec3>* half;

  [[nodiscard]] Index size() const { return Index(walls.axis.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index b) const {
    auto const q = quaternion_of_half(mean_turn<V>(walls, b, sum, sum_rate));
    if constexpr (has_rate<V>)
      half[b] = {q.imaginary.rate, q.less.rate};
    else
      half[b] = q;
  }
};

/// The sum of w u of each chunk of slots, those of other boundaries included.
template <class MemorySpace>
struct SumBodyShifts {
  BodyWalls<MemorySpace> walls;
  VectorArray boundary;  ///< displacements, or their rates
  Vec3* sum;

  [[nodiscard]] Index size() const { return Index(walls.first.extent(0)) - 1; }
  KOKKOS_INLINE_FUNCTION void operator()(Index c) const {
    Vec3 s;
    for (Index k = walls.first(c); k < walls.first(c + 1); ++k) s += walls.weight(k) * boundary[walls.slot(k)];
    sum[c] = s;
  }
};

/// The shift of each body: its mean displacement less that of the other boundaries; or the rate of that.
template <class MemorySpace>
struct ShiftBodies {
  BodyWalls<MemorySpace> walls;
  Vec3 const* sum;
  Vec3* shift;

  [[nodiscard]] Index size() const { return Index(walls.axis.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index b) const { shift[b] = total(b) - total(Index(walls.axis.extent(0))); }

 private:
  [[nodiscard]] KOKKOS_INLINE_FUNCTION Vec3 total(Index b) const {
    Vec3 s;
    for (Index c = walls.first_chunk(b); c < walls.first_chunk(b + 1); ++c) s += sum[c];
    return s;
  }
};

/// A quaternion of V from values, and rates where V has them.
template <class V>
KOKKOS_INLINE_FUNCTION Quaternion<V> with_rate(Quaternion<Vec3> const* value,
                                               [[maybe_unused]] Quaternion<Vec3> const* rate, Index n) {
  if constexpr (has_rate<V>)
    return {{value[n].imaginary, rate[n].imaginary}, {value[n].less, rate[n].less}};
  else
    return value[n];
}

/// N of a body, from the sums of its chunks.
template <class MemorySpace>
KOKKOS_INLINE_FUNCTION StretchMap stretch_moments(BodyWalls<MemorySpace> const& walls, Index body,
                                                  StretchMap const* sum) {
  StretchMap s;
  for (Index c = walls.first_chunk(body); c < walls.first_chunk(body + 1); ++c) s += sum[c];
  return in_plane(s, walls.axis(body));
}

/// How each body stretches; with rates the rate of that.
template <class MemorySpace, class V>
struct StretchBodies {
  BodyWalls<MemorySpace> walls;
  Quaternion<Vec3> const *half, *half_rate;
  StretchMap const *sum, *sum_rate;
  StretchMap* stretch;

  [[nodiscard]] Index size() const { return Index(walls.axis.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index b) const {
    StretchMap const n = stretch_moments(walls, b, sum);
    auto const whole = twice(with_rate<V>(half, half_rate, b));
    StretchMap out;
    if constexpr (has_rate<V>) {
      StretchMap const rate = stretch_moments(walls, b, sum_rate);
      for (int a = 0; a < 3; ++a)
        out.column[a] = stretched(walls.limits(b), whole, a, V{n.column[a], rate.column[a]}).rate;
    } else {
      for (int a = 0; a < 3; ++a) out.column[a] = stretched(walls.limits(b), whole, a, n.column[a]);
    }
    stretch[b] = walls.limits(b).even ? evened(out, walls.axis(b)) : out;
  }
};

/// A body itself, or as it comes again.
struct BodyImage : WallImage {
  std::int32_t body;
};

/// What the turns, stretches and shifts of all bodies add to a node, and turns to the motion around a body's walls.
template <class MemorySpace, class V>
struct BodyTurnField {
  Kokkos::View<double const*, MemorySpace> share;        ///< (n_images, n_nodes)
  Kokkos::View<double const*, MemorySpace> shift_share;  ///< (n_bodies, n_nodes)
  Kokkos::View<BodyImage const*, MemorySpace> images;    ///< first the bodies themselves
  Kokkos::View<Vec3 const*, MemorySpace> centre;         ///< (n_bodies)
  Quaternion<Vec3> const *half, *half_rate;              ///< (n_bodies)
  Vec3 const *shift, *shift_rate;                        ///< (n_bodies)
  Field<double const> x;
  StretchMap const *stretch = nullptr, *stretch_rate = nullptr;  ///< (n_bodies); null: none stretches

  /// What R y - y is for the share f of body b's rotation.
  KOKKOS_INLINE_FUNCTION V turned(Index b, double f, V const& y) const {
    return twice(Quaternion<V>::share(with_rate<V>(half, half_rate, b), f)).turned(y);
  }
  /// What R E y is for body b.
  KOKKOS_INLINE_FUNCTION V stretched(Index b, Vec3 const& y) const {
    V const more = stretched_by(b, y);
    return more + turned(b, 1, more);
  }
  /// What R (y + E y) - y is for the share f of body b's rotation and stretch.
  KOKKOS_INLINE_FUNCTION V moved(Index b, double f, Vec3 const& y) const {
    if (stretch == nullptr) return turned(b, f, V{y});
    V const more = f * stretched_by(b, y);
    return more + turned(b, f, V{y} + more);
  }
  KOKKOS_INLINE_FUNCTION V operator()(Index n) const {
    V sum{};
    Index const n_bodies = Index(centre.extent(0)), n_nodes = Index(shift_share.extent(0)) / n_bodies;
    for (Index b = 0; b < n_bodies; ++b) {
      if (double const f = share(b * n_nodes + n); f != 0) sum = sum + moved(b, f, x[n] - centre(b));
      if (double const s = shift_share(b * n_nodes + n); s != 0) sum = sum + s * shift_of_body(b);
    }
    for (Index k = n_bodies; k < Index(images.extent(0)); ++k)
      if (double const f = share(k * n_nodes + n); f != 0) sum = sum + moved_by_image(images(k), f, x[n]);
    return sum;
  }

 private:
  KOKKOS_INLINE_FUNCTION V moved_by_image(BodyImage const& image, double f, Vec3 const& at) const {
    V const own = moved(image.body, f, transpose(image.rotation) * (at - image.translation) - centre(image.body));
    if constexpr (has_rate<V>)
      return {image.rotation * own.value, image.rotation * own.rate};
    else
      return image.rotation * own;
  }
  KOKKOS_INLINE_FUNCTION V shift_of_body(Index b) const {
    if constexpr (has_rate<V>)
      return {shift[b], shift_rate[b]};
    else
      return shift[b];
  }
  KOKKOS_INLINE_FUNCTION V stretched_by(Index b, Vec3 const& y) const {
    if constexpr (has_rate<V>)
      return {stretch[b] * y, stretch_rate[b] * y};
    else
      return stretch[b] * y;
  }
};

/// u(node) loses what bodies add to it as wholes.
template <class MemorySpace, class V>
struct TakeBodyTurns {
  BodyTurnField<MemorySpace, V> field;
  Kokkos::View<std::int32_t const*, MemorySpace> node;
  Vec3* u;  ///< with rates: their rates

  [[nodiscard]] Index size() const { return Index(node.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const { u[node(k)] = u[node(k)] - written(field(node(k))); }
};

/// The columns on wall nodes, and how much of their bodies' stretch they make.
template <class MemorySpace>
struct StretchedColumns {
  ColumnsOf<MemorySpace> of;                               ///< empty: none
  Kokkos::View<std::int32_t const*, MemorySpace> node;     ///< of each column
  Kokkos::View<Vec3 const*, MemorySpace> arm;              ///< h of each column
  Kokkos::View<StretchLimits const*, MemorySpace> limits;  ///< (bodies)
};

/// The motion around wall nodes becomes what it is beyond their body's turn, in the places of the baseline, and where
/// bodies stretch as much of that as the stretch leaves: G = R_n - R_b becomes (1 - q) G, and the nodes of their
/// columns, which have lost all that their body does, get (R_b E - q G) h back.
template <class MemorySpace, class V>
struct TakeTurnsFromFrames {
  BodyTurnField<MemorySpace, V> field;
  Kokkos::View<std::int32_t const*, MemorySpace> node, body;  ///< per wall node; body -1: none
  StretchedColumns<MemorySpace> columns;
  Vec3* u;  ///< with rates: their rates
  AffineMotion* frame;

  [[nodiscard]] Index size() const { return Index(node.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index r) const {
    Index const b = body(r);
    if (b < 0) return;
    AffineMotion motion =
        frame[r] - AffineMotion{{}, matrix_of_map([&](Vec3 const& e) { return written(field.turned(b, 1, V{e})); })};
    if (columns.of.first.extent(0) > 0) {
      double const q = columns.limits(b).share;
      for (Index k = columns.of.first(r); k < columns.of.first(r + 1); ++k) {
        Index const c = columns.of.column(k);
        Vec3 const h = columns.arm(c);
        u[columns.node(c)] += written(field.stretched(b, h)) - q * (motion.gradient * h);
      }
      motion = (1 - q) * motion;
    }
    motion.u = u[node(r)];
    frame[r] = motion;
  }
};

/// Adds to the displacement of all nodes what bodies give them as wholes.
template <class MemorySpace, class V>
struct AddBodyTurns {
  BodyTurnField<MemorySpace, V> field;
  Vec3* u;  ///< with rates: their rates
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const { u[n] += written(field(n)); }
};

}  // namespace gridmorph::kernels
