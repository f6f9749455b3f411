// How walls turn, and what stands on them turns with them.
//
// A rotation is a vector: axis times angle [rad]. The rotation of a wall at its node x, whose neighbours in the wall faces
// around it are pairs (a, b), is the smallest one that takes its normal before to its normal after,
//
//   n = sum over faces of (a - x) x (b - x)      (2-D: over edges of (b - a) x plane normal)
//
// then about the normal the polar rotation of the gradient F in the wall, least squares over the nodes around,
//
//   atan2(F21 - F12, F11 + F22),   F = (sum of q p^T) (sum of p p^T)^-1
//
// with p their places from x before, turned by the first rotation, and q those after. On structured walls n is what centred
// differences give. All formulas are written for V = Vec3, or V = DualVec3 for their
// exact rates (dual.hpp), also where nothing turns yet.
//
// Cost per wall node: its faces' nodes read twice (48 bytes each, from cache), about 150 flops per face, 24 bytes written; the
// motion around it 48 bytes read, 96 written.
#pragma once

#include <gridmorph/kernels/dual.hpp>
#include <gridmorph/kernels/field.hpp>
#include <gridmorph/kernels/inverse_distance.hpp>
#include <gridmorph/kernels/launch.hpp>

#include <cmath>
#include <numbers>
#include <type_traits>

namespace gridmorph::kernels {

template <class V>
inline constexpr bool has_rate = std::is_same_v<V, DualVec3>;

/// A unit vector across v, which is not zero.
KOKKOS_INLINE_FUNCTION Vec3 across(Vec3 const& v) {
  bool const x_is_least = v.x * v.x <= v.y * v.y && v.x * v.x <= v.z * v.z;
  Vec3 const other = x_is_least ? Vec3{1, 0, 0} : v.y * v.y <= v.z * v.z ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
  Vec3 const c = cross(v, other);
  return (1 / norm(c)) * c;
}
KOKKOS_INLINE_FUNCTION Vec3 value_of(Vec3 const& v) { return v; }
KOKKOS_INLINE_FUNCTION Vec3 value_of(DualVec3 const& v) { return v.value; }

/// The smallest rotation that takes direction `before` to `after`; zero where either is zero and where they are the same; about
/// `half_turn_axis` (unit, across them), with no rate, where they are opposite to round-off.
template <class V>
KOKKOS_INLINE_FUNCTION V turn_between(V const& before, V const& after, Vec3 const& half_turn_axis) {
  using std::atan2;
  V const c = cross(before, after);
  auto const sine = norm(c), cosine = dot(before, after);
  double const least = 1e-8 * norm(value_of(before)) * norm(value_of(after));
  if (cosine < -least && !(sine > least)) return V{std::numbers::pi * half_turn_axis};
  if (!(sine > 0)) {
    if constexpr (has_rate<V>) return cosine > 0 ? (1 / cosine) * c : V{};
    return {};
  }
  return (atan2(sine, cosine) / sine) * c;
}

/// About some axis where they are opposite.
template <class V>
KOKKOS_INLINE_FUNCTION V turn_between(V const& before, V const& after) {
  Vec3 const v = value_of(before);
  return turn_between(before, after, dot(v, v) > 0 ? across(v) : Vec3{});
}

/// R - I of `share` of a rotation (Rodrigues), with k the axis and a the angle: exactly zero where the angle is.
///
///   R v - v = sin(a) k x v + (1 - cos(a)) k x (k x v)
template <class V>
struct Turning {
  using Scalar = std::decay_t<decltype(dot(V{}, V{}))>;
  V axis{};
  Scalar sine{}, versine{};

  KOKKOS_INLINE_FUNCTION explicit Turning(V const& turn, double share = 1) {
    using std::sin;
    auto const angle = norm(turn);
    if (angle > 0) {
      auto const a = share * angle, half = sin(0.5 * a);
      axis = (1 / angle) * turn;
      sine = sin(a);
      versine = 2 * half * half;
    } else if constexpr (has_rate<V>) {
      axis = turn;
      sine = {share, 0};
    }
  }
  KOKKOS_INLINE_FUNCTION V operator()(V const& v) const {
    V const across = cross(axis, v);
    return sine * across + versine * cross(axis, across);
  }
};
template <class V>
KOKKOS_INLINE_FUNCTION V turned_by(V const& turn, double share, V const& v) {
  return Turning<V>(turn, share)(v);
}

/// Half a turn is one rotation about either direction of its axis. Neighbours that blend theirs have to agree on one, whatever round-off
/// says of each: the direction along which z, else y, else x rises.
template <class V>
KOKKOS_INLINE_FUNCTION V settled(V const& turn) {
  double constexpr half = std::numbers::pi;
  auto const angle = norm(turn);
  if (!(angle > (1 - 1e-6) * half)) return turn;
  Vec3 const v = value_of(turn);
  auto const counts = [&](double c) { return c > 0.3 * half || c < -0.3 * half; };
  double const along = counts(v.z) ? v.z : counts(v.y) ? v.y : v.x;
  return along < 0 ? (2 * half / angle) * -turn + turn : turn;
}

/// First one rotation, then the other; exactly zero where both are. By unit quaternions.
template <class V>
KOKKOS_INLINE_FUNCTION V turn_then(V const& first, V const& next) {
  using std::atan2;
  using std::cos;
  using std::sin;
  auto const a = norm(first), b = norm(next);
  if constexpr (!has_rate<V>) {
    if (!(a > 0)) return settled(next);
    if (!(b > 0)) return settled(first);
  }
  auto const half_sine = [](auto const& angle) {  // over the angle
    return angle > 0 ? sin(0.5 * angle) / angle : std::decay_t<decltype(angle)>{0.5};
  };
  auto const p = cos(0.5 * a), q = cos(0.5 * b);
  V const v = half_sine(a) * first, w = half_sine(b) * next;
  auto real = p * q - dot(v, w);
  V imaginary = p * w + q * v + cross(w, v);
  if (real < 0) {
    real = -real;
    imaginary = -imaginary;
  }
  auto const sine = norm(imaginary);
  if (sine > 0) return settled((2 * atan2(sine, real) / sine) * imaginary);
  if constexpr (has_rate<V>) return (2 / real) * imaginary;
  return {};
}

/// The angle about the unit vector `axis` by which n arms turn that a rotation `swing` has taken to it: before(k) and after(k),
/// V each. Where they lie on one line, their mean angle.
template <class V, class Before, class After>
KOKKOS_INLINE_FUNCTION auto twist_about(V const& axis, V const& swing, Index n, Before const& before,
                                        After const& after) {
  using std::atan2;
  using Scalar = std::decay_t<decltype(dot(axis, axis))>;
  V t1{}, t2{};
  Scalar c11{}, c12{}, c22{}, b11{}, b12{}, b21{}, b22{};
  bool has_frame = false;
  Turning<V> const turning(swing);
  for (Index k = 0; k < n; ++k) {
    V const arm = before(k), p = arm + turning(arm), q = after(k);
    if (!has_frame) {
      V const across = p - dot(p, axis) * axis;
      auto const size = norm(across);
      if (!(size > 0)) continue;
      t1 = (1 / size) * across;
      t2 = cross(axis, t1);
      has_frame = true;
    }
    auto const p1 = dot(p, t1), p2 = dot(p, t2), q1 = dot(q, t1), q2 = dot(q, t2);
    c11 = c11 + p1 * p1;
    c12 = c12 + p1 * p2;
    c22 = c22 + p2 * p2;
    b11 = b11 + q1 * p1;
    b12 = b12 + q1 * p2;
    b21 = b21 + q2 * p1;
    b22 = b22 + q2 * p2;
  }
  auto const size = c11 + c22, determinant = c11 * c22 - c12 * c12;
  bool const on_a_line = !((determinant - 1e-12 * (size * size)) > 0);
  if (on_a_line) return atan2(b21 - b12, b11 + b22);
  auto const f11 = b11 * c22 - b12 * c12, f12 = b12 * c11 - b11 * c12;
  auto const f21 = b21 * c22 - b22 * c12, f22 = b22 * c11 - b21 * c12;
  return atan2(f21 - f12, f11 + f22);
}

/// Position of a node: of the baseline, or moved by what it is displaced by so far.
template <class V>
struct Positions {
  Field<double const> x;
  Vec3 const* u = nullptr;
  Vec3 const* rate = nullptr;  ///< of u, where V has rates
  KOKKOS_INLINE_FUNCTION V operator[](Index n) const {
    V at{x[n]};
    if constexpr (has_rate<V>) return u == nullptr ? at : V{at.value + u[n], rate[n]};
    return u == nullptr ? at : at + V{u[n]};
  }
};

/// The wall around its nodes.
template <class MemorySpace>
struct WallTable {
  Kokkos::View<std::int32_t const*, MemorySpace> node;    ///< (n_walls)
  Kokkos::View<Index const*, MemorySpace> first;          ///< (n_walls + 1)
  Kokkos::View<std::int32_t const*, MemorySpace> around;  ///< pairs (a, b), those of node r from first(r) on
  Kokkos::View<std::uint8_t const*, MemorySpace> turns;   ///< (n_walls) whether its rotation is followed
  bool flat = false;                                      ///< 2-D
  Vec3 across;                                            ///< the plane's normal

  /// Weighted by area.
  template <class V>
  KOKKOS_INLINE_FUNCTION V normal(Index r, Positions<V> const& at) const {
    V const x = at[node(r)];
    V sum{};
    for (Index k = first(r); k < first(r + 1); k += 2) {
      V const a = at[around(k)], b = at[around(k + 1)];
      sum = sum + (flat ? cross(b - a, V{across}) : cross(a - x, b - x));
    }
    return sum;
  }
};

template <class MemorySpace, class V>
struct WallTurn {
  WallTable<MemorySpace> wall;
  Positions<V> baseline, moved;
  Vec3* turn;  ///< with rates: their rates

  [[nodiscard]] Index size() const { return Index(wall.node.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index r) const {
    V const found = wall.turns(r) == 0 ? V{} : turn_at(r);
    if constexpr (has_rate<V>)
      turn[r] = found.rate;
    else
      turn[r] = found;
  }

 private:
  KOKKOS_INLINE_FUNCTION V turn_at(Index r) const {
    V const after = wall.normal(r, moved);
    V const before = wall.normal(r, baseline);
    if (wall.flat) return settled(turn_between(before, after, wall.across));
    V const swing = turn_between(before, after);
    auto const size = norm(after);
    if (!(size > 0)) return swing;
    V const axis = (1 / size) * after;
    V const x = baseline[wall.node(r)], y = moved[wall.node(r)];
    Index const first = wall.first(r);
    auto const angle = twist_about(
        axis, swing, wall.first(r + 1) - first, [&](Index k) { return baseline[wall.around(first + k)] - x; },
        [&](Index k) { return moved[wall.around(first + k)] - y; });
    return turn_then(swing, angle * axis);
  }
};

/// The motion of a wall around its nodes: u + (R - I)(x - node).
template <class MemorySpace, class V>
struct WallFrames {
  WallTable<MemorySpace> wall;
  Vec3 const *turn, *turn_rate;
  Vec3 const* u;  ///< with rates: their rates
  AffineMotion* frame;

  [[nodiscard]] Index size() const { return Index(wall.node.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index r) const {
    Turning<V> const turning(turn_of(r));
    auto const column = [&](Vec3 const& e) { return change(turning(V{e})); };
    Vec3 const x = column({1, 0, 0}), y = column({0, 1, 0}), z = column({0, 0, 1});
    frame[r] = {u[wall.node(r)], {{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}}};
  }

 private:
  KOKKOS_INLINE_FUNCTION V turn_of(Index r) const {
    if constexpr (has_rate<V>)
      return {turn[r], turn_rate[r]};
    else
      return turn[r];
  }
  KOKKOS_INLINE_FUNCTION static Vec3 change(Vec3 const& v) { return v; }
  KOKKOS_INLINE_FUNCTION static Vec3 change(DualVec3 const& v) { return v.rate; }
};

}  // namespace gridmorph::kernels
