// The affine displacement that a part of a mesh has in common: taken off what its boundary is given, added to all of
// its nodes.
//
//   A(x) = a_0 + sum over i of a_i y_i(x),   y_i(x) = axis_i . (x - centre)
//   a = P s,   s_0 = sum over boundary nodes of w u,   s_i = sum of w y_i u
//
// P, twelve by twelve, is what a fit by least squares among the displacements that the part may make leaves of the
// moments s (plan/common_motion.hpp). The fit is linear in u, and P is symmetric, so that the transpose takes the
// moments of gradients through the same P. What is left is seen from the mesh that A has moved: with F = I + grad A and
// the displacement v that the stages give to what is left,
//
//   v = F^-1 (u - A(x)) at the boundary,   u = v + A(x + v) everywhere
//
// so that what turns and bends does so as if nothing were in common; where all stages are linear that is the same as v
// = u - A(x), u = v + A(x). Where F has no inverse (share 0), that is what is done. Sums run over chunks of nodes, one
// work item each, then over the chunks in their order: the same bits for any number of threads.
//
// Cost: 56 bytes per boundary node for the moments and 72 for what is left; 24 of coordinates and 48 of displacements
// per node of the part.
#pragma once

#include <gridmorph/kernels/field.hpp>
#include <gridmorph/kernels/launch.hpp>
#include <gridmorph/kernels/vector_array.hpp>

#include <cstdint>

namespace gridmorph::kernels {

/// The coordinates y in which moments are taken: along the principal axes of the boundary, of size one; an axis along
/// which it does not extend is zero.
struct CommonFrame {
  Vec3 centre;
  Vec3 axis[3];

  KOKKOS_INLINE_FUNCTION double y(int i, Vec3 const& x) const { return dot(axis[i], x - centre); }
};

/// Coefficients a of an affine displacement, or moments s.
struct CommonMap {
  Vec3 a[4];

  KOKKOS_INLINE_FUNCTION Vec3 operator()(CommonFrame const& frame, Vec3 const& x) const {
    return a[0] + frame.y(0, x) * a[1] + frame.y(1, x) * a[2] + frame.y(2, x) * a[3];
  }
  /// The moments of u at x.
  KOKKOS_INLINE_FUNCTION void add(CommonFrame const& frame, Vec3 const& x, Vec3 const& u) {
    a[0] += u;
    for (int i = 0; i < 3; ++i) a[i + 1] += frame.y(i, x) * u;
  }
};

/// P, row after row; entry 3 i + c belongs to component c of a_i.
struct CommonProjection {
  double p[12][12];

  KOKKOS_INLINE_FUNCTION CommonMap operator*(CommonMap const& s) const {
    double from[12], to[12];
    for (int i = 0; i < 4; ++i) {
      from[3 * i] = s.a[i].x;
      from[3 * i + 1] = s.a[i].y;
      from[3 * i + 2] = s.a[i].z;
    }
    for (int r = 0; r < 12; ++r) {
      to[r] = 0;
      for (int c = 0; c < 12; ++c) to[r] += p[r][c] * from[c];
    }
    CommonMap out;
    for (int i = 0; i < 4; ++i) out.a[i] = {to[3 * i], to[3 * i + 1], to[3 * i + 2]};
    return out;
  }
};

constexpr Index common_chunk = 512;  ///< nodes that are summed in one go

KOKKOS_INLINE_FUNCTION Index common_chunks(Index n) { return (n + common_chunk - 1) / common_chunk; }

/// A, and how what is left of displacements is seen from there.
struct CommonMove {
  CommonMap map;
  Mat3 forward, back;  ///< F and its inverse
  double share;        ///< 1, or 0: both are I
};

/// The move by A, with F and its inverse; both are I where `pulls` is not set or F nearly has no inverse.
KOKKOS_INLINE_FUNCTION CommonMove common_move(CommonFrame const& frame, CommonMap const& map, bool pulls) {
  CommonMove out{map, {}, {}, 0};
  Mat3 f, inverse;
  double size = 0;
  Vec3 const identity[3]{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  Vec3 column[3];
  for (int c = 0; c < 3; ++c) {
    column[c] = identity[c];
    for (int i = 0; i < 3; ++i) column[c] += dot(frame.axis[i], identity[c]) * map.a[i + 1];
    double const length = norm(column[c]);
    size = length > size ? length : size;
  }
  Vec3 const row[3]{cross(column[1], column[2]), cross(column[2], column[0]), cross(column[0], column[1])};
  double const det = dot(column[0], row[0]);
  constexpr double flat = 1e-9;
  if (!pulls || !((det < 0 ? -det : det) > flat * size * size * size)) return out;
  for (int c = 0; c < 3; ++c) {
    f.m[0][c] = column[c].x;
    f.m[1][c] = column[c].y;
    f.m[2][c] = column[c].z;
    inverse.m[c][0] = row[c].x / det;
    inverse.m[c][1] = row[c].y / det;
    inverse.m[c][2] = row[c].z / det;
  }
  return {map, f, inverse, 1};
}

/// An item: the moments of vectors at one chunk of a list of places, displaced ones where there are any.
template <class MemorySpace>
struct CommonMoments {
  CommonFrame frame;
  Kokkos::View<Vec3 const*, MemorySpace> position;
  Kokkos::View<double const*, MemorySpace> weight;  ///< empty: 1 each
  Vec3 const* vectors;
  Vec3 const* displaced;  ///< null: by nothing
  CommonMove const* move;
  double sign;
  CommonMap* partial;

  [[nodiscard]] Index size() const { return common_chunks(Index(position.extent(0))); }
  KOKKOS_INLINE_FUNCTION void operator()(Index chunk) const {
    Index const first = chunk * common_chunk, n = Index(position.extent(0));
    Index const end = first + common_chunk < n ? first + common_chunk : n;
    bool const weighted = weight.extent(0) > 0;
    CommonMap sum;
    for (Index k = first; k < end; ++k) {
      Vec3 const x = displaced == nullptr ? position(k) : position(k) + move->share * displaced[k];
      sum.add(frame, x, (weighted ? sign * weight(k) : sign) * vectors[k]);
    }
    partial[chunk] = sum;
  }
};

/// The one item: P times the sum of the parts, with `Adds` besides the map that is there.
template <bool Adds>
struct SumCommonMoments {
  CommonFrame frame;
  CommonMap const* partial;
  Index n_chunks;
  CommonProjection const* projection;
  bool pulls;
  CommonMove* move;

  [[nodiscard]] static Index size() { return 1; }
  KOKKOS_INLINE_FUNCTION void operator()(Index /*item*/) const {
    CommonMap sum;
    for (Index c = 0; c < n_chunks; ++c)
      for (int i = 0; i < 4; ++i) sum.a[i] += partial[c].a[i];
    CommonMap map = *projection * sum;
    for (int i = 0; Adds && i < 4; ++i) map.a[i] += move->map.a[i];
    *move = common_move(frame, map, pulls);
  }
};

/// What boundary nodes are given beyond A, to `rest`. What is no more than the rounding of the fit is none: walls with
/// short edges would turn by it.
template <class MemorySpace>
struct TakeCommonMotion {
  CommonFrame frame;
  Kokkos::View<Vec3 const*, MemorySpace> position;
  CommonMove const* move;
  Vec3 const* given;
  Vec3* rest;

  [[nodiscard]] Index size() const { return Index(position.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    constexpr double rounding = 1e-13;
    CommonMap const& map = move->map;
    Vec3 const x = position(k), left = given[k] - map(frame, x);
    double size = norm(given[k]) + norm(map.a[0]);
    for (int i = 0; i < 3; ++i) {
      double const y = frame.y(i, x);
      size += (y < 0 ? -y : y) * norm(map.a[i + 1]);
    }
    rest[k] = norm(left) > rounding * size ? move->back * left : Vec3{};
  }
};
/// The rate of what TakeCommonMotion leaves, where A changes by the map of `rate`.
template <class MemorySpace>
struct TakeCommonRate {
  CommonFrame frame;
  Kokkos::View<Vec3 const*, MemorySpace> position;
  CommonMove const *move, *rate;
  Vec3 const *given, *rest;  ///< rate of what is given; what is left
  Vec3* rest_rate;

  [[nodiscard]] Index size() const { return Index(position.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    rest_rate[k] = move->back * (given[k] - rate->map(frame, position(k) + move->share * rest[k]));
  }
};

/// Adds the motion in common to the displacement v of all nodes, which becomes v + A(x + v).
struct AddCommonMotion {
  CommonFrame frame;
  Field<double const> x;
  CommonMove const* move;
  Vec3* u;

  KOKKOS_INLINE_FUNCTION void operator()(Index n) const { u[n] += move->map(frame, x[n] + move->share * u[n]); }
};
/// The rate of what AddCommonMotion makes of u; u is still what it was before.
struct AddCommonRate {
  CommonFrame frame;
  Field<double const> x;
  CommonMove const *move, *rate;
  Vec3 const* u;
  Vec3* v;

  KOKKOS_INLINE_FUNCTION void operator()(Index n) const {
    v[n] = move->forward * v[n] + rate->map(frame, x[n] + move->share * u[n]);
  }
};

/// Transpose of AddCommonMotion for u, or with `Inverse` of TakeCommonMotion for what is given: g becomes F^T g, or
/// F^-T g.
template <bool Inverse>
struct PullCommonGradient {
  CommonMove const* move;
  Vec3* g;
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const {
    g[n] = transpose(Inverse ? move->back : move->forward) * g[n];
  }
};

/// Transpose of the fit: to(k) += w A'(x(k)), A' being P times the moments of gradients.
template <class MemorySpace>
struct CommonMotionBack {
  CommonFrame frame;
  Kokkos::View<Vec3 const*, MemorySpace> position;
  Kokkos::View<double const*, MemorySpace> weight;
  CommonMove const* move;
  Vec3* to;

  [[nodiscard]] Index size() const { return Index(position.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const { to[k] += weight(k) * move->map(frame, position(k)); }
};

/// What rows of weighted means, kept in single precision, miss of y at their targets.
template <class MemorySpace>
struct CommonDefects {
  CommonFrame frame;
  Kokkos::View<std::int32_t const*, MemorySpace> target;
  Field<double const> x;
  Vec3 const* means;  ///< of y, by node
  Vec3* defect;       ///< by row

  [[nodiscard]] Index size() const { return Index(target.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index r) const {
    Vec3 const at = x[target(r)];
    defect[r] = Vec3{frame.y(0, at), frame.y(1, at), frame.y(2, at)} - means[target(r)];
  }
};
/// The coordinates y of all nodes in a CommonFrame.
struct CommonCoordinates {
  CommonFrame frame;
  Field<double const> x;
  Vec3* y;
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const {
    y[n] = {frame.y(0, x[n]), frame.y(1, x[n]), frame.y(2, x[n])};
  }
};
/// An item: what a chunk of targets, which get what their rows miss of A, hands back to A.
template <class MemorySpace>
struct CommonDefectsBack {
  Kokkos::View<std::int32_t const*, MemorySpace> target;
  Kokkos::View<Vec3 const*, MemorySpace> defect;
  Vec3 const* g;
  CommonMap* partial;

  [[nodiscard]] Index size() const { return common_chunks(Index(defect.extent(0))); }
  KOKKOS_INLINE_FUNCTION void operator()(Index chunk) const {
    Index const first = chunk * common_chunk, n = Index(defect.extent(0));
    Index const end = first + common_chunk < n ? first + common_chunk : n;
    CommonMap sum;
    for (Index r = first; r < end; ++r) {
      Vec3 const d = defect(r), v = g[target(r)];
      sum.a[1] += d.x * v;
      sum.a[2] += d.y * v;
      sum.a[3] += d.z * v;
    }
    partial[chunk] = sum;
  }
};

}  // namespace gridmorph::kernels
