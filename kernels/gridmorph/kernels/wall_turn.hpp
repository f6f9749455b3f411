// How walls turn, and what stands on them turns with them.
//
// Rotations are vectors (rotation.hpp). The rotation of a wall at its node x, whose neighbours in the wall faces
// around it are pairs (a, b), is the smallest one that takes its normal before to its normal after,
//
//   n = sum over faces of (a - x) x (b - x)      (2-D: over edges of (b - a) x plane normal)
//
// after: of these, each as long as it is before. (At a sharp edge both faces nearly cancel: their sum would turn as
// they stretch differently, not as they turn.) About the normal it turns by what is left, the polar rotation of the
// gradient F in the wall, least squares over the nodes around,
//
//   atan2(F21 - F12, F11 + F22),   F = (sum of w q p^T) (sum of w p p^T)^-1
//
// with p their places from x before, turned by the first rotation, and q those after. On structured walls n is what
// centred differences give. On these w = 1 / |p|^2, so that every arm counts alike, whatever its length: where cells
// are thin along the wall, as beside an end wall that is resolved, the sag of a long arm is more than a short one, and
// would decide how that turns. On elements w = 1.
//
// Cost per wall node: its faces' nodes read twice (48 bytes each, from cache), about 100 flops per face, 24 bytes
// written; the motion around it 48 bytes read, 96 written.
#pragma once

#include <gridmorph/kernels/field.hpp>
#include <gridmorph/kernels/inverse_distance.hpp>
#include <gridmorph/kernels/kept_height.hpp>
#include <gridmorph/kernels/lanes.hpp>
#include <gridmorph/kernels/launch.hpp>
#include <gridmorph/kernels/rotation.hpp>

namespace gridmorph::kernels {

/// What the arms of a fan count: the inverse squares of their lengths before. Arms shorter than a ten-millionth of the
/// longest are round-off between nodes at one place, and count less.
class ArmWeights {
 public:
  /// before(k), V each.
  template <class Before>
  KOKKOS_INLINE_FUNCTION ArmWeights(Index n, Before const& before) {
    double longest = 0;
    for (Index k = 0; k < n; ++k) {
      Vec3 const arm = value_of(before(k));
      longest = larger(longest, dot(arm, arm));
    }
    round_off_ = 1e-14 * longest + 1e-300;
  }
  KOKKOS_INLINE_FUNCTION double operator()(Vec3 const& before) const { return 1 / (dot(before, before) + round_off_); }

 private:
  double round_off_;
};

/// Arms of elements, whose fans have some of any length on all sides: none is weighed.
struct UnweighedArms {
  KOKKOS_INLINE_FUNCTION double operator()(Vec3 const&) const { return 1; }
};

/// The rotation by which n arms turn about the unit vector `axis` to which a rotation `swing` has taken them: before(k)
/// and after(k), V each. Where they lie on one line, their mean angle. weight(arm before): what it counts.
template <class V, class Before, class After, class Weight>
KOKKOS_INLINE_FUNCTION V twist_about(V const& axis, V const& swing, Index n, Before const& before, After const& after,
                                     Weight const& weight) {
  using Scalar = std::decay_t<decltype(dot(axis, axis))>;
  // Any two directions across the axis serve. Not one of the arms: an arm along the axis leaves nothing but round-off.
  Vec3 const a = value_of(axis);
  double const x = a.x < 0 ? -a.x : a.x, y = a.y < 0 ? -a.y : a.y, z = a.z < 0 ? -a.z : a.z;
  V const least = V{x <= y && x <= z ? Vec3{1, 0, 0} : y <= z ? Vec3{0, 1, 0} : Vec3{0, 0, 1}};
  V const across = least - dot(least, axis) * axis;
  V const t1 = (1 / norm(across)) * across, t2 = cross(axis, t1);
  Scalar c11{}, c12{}, c22{}, b11{}, b12{}, b21{}, b22{};
  for (Index k = 0; k < n; ++k) {
    V const arm = before(k), p = arm + turned_by(swing, arm), q = after(k);
    double const w = weight(value_of(arm));
    auto const p1 = dot(p, t1), p2 = dot(p, t2), q1 = dot(q, t1), q2 = dot(q, t2);
    // Weights come last: where nothing moves b is c to the last bit, and nothing turns.
    c11 = c11 + w * (p1 * p1);
    c12 = c12 + w * (p1 * p2);
    c22 = c22 + w * (p2 * p2);
    b11 = b11 + w * (q1 * p1);
    b12 = b12 + w * (q1 * p2);
    b21 = b21 + w * (q2 * p1);
    b22 = b22 + w * (q2 * p2);
  }
  auto const size = c11 + c22, determinant = c11 * c22 - c12 * c12;
  bool const on_a_line = !((determinant - 1e-12 * (size * size)) > 0);
  if (on_a_line) return quarter_tangent(b21 - b12, b11 + b22) * axis;
  auto const f11 = b11 * c22 - b12 * c12, f12 = b12 * c11 - b11 * c12;
  auto const f21 = b21 * c22 - b22 * c12, f22 = b22 * c11 - b21 * c12;
  return quarter_tangent(f21 - f12, f11 + f22) * axis;
}

/// A face's normal after, as long as it is before.
template <class V>
KOKKOS_INLINE_FUNCTION V as_long_as(V const& before, V const& after) {
  auto const size = norm(after);
  if (!(size > 0)) return V{};
  return (norm(before) / size) * after;
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
  /// First edges of the columns on each node, unit, as the wall's normals: first_line(r) on; none of any where empty.
  Kokkos::View<Index const*, MemorySpace> first_line;
  Kokkos::View<Vec3 const*, MemorySpace> lines;

  /// The normal, not of unit length, of one of the faces around node r, `pair` the number of its first neighbour; x:
  /// the node there.
  template <class V>
  KOKKOS_INLINE_FUNCTION V face(Index pair, V const& x, Positions<V> const& at) const {
    V const a = at[around(pair)], b = at[around(pair + 1)];
    return flat ? cross(b - a, V{across}) : cross(a - x, b - x);
  }
  /// The sum of the normals of the faces around node r, weighted by area; not of unit length.
  template <class V>
  KOKKOS_INLINE_FUNCTION V normal(Index r, Positions<V> const& at) const {
    V const x = at[node(r)];
    V sum{};
    for (Index k = first(r); k < first(r + 1); k += 2) sum = sum + face(k, x, at);
    return sum;
  }
  /// That of the faces after, each as long as before.
  template <class V>
  KOKKOS_INLINE_FUNCTION V normal_after(Index r, Positions<V> const& baseline, Positions<V> const& moved) const {
    V const x = baseline[node(r)], y = moved[node(r)];
    V sum{};
    for (Index k = first(r); k < first(r + 1); k += 2) sum = sum + as_long_as(face(k, x, baseline), face(k, y, moved));
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
    V const turn = turn_of_faces(r);
    if (wall.lines.extent(0) == 0) return turn;
    V const x = baseline[wall.node(r)], y = moved[wall.node(r)];
    Index const first = wall.first(r), n_faces = (wall.first(r + 1) - first) / 2;
    V kept = turn;
    auto least = norm(turn);
    for (Index k = wall.first_line(r); k < wall.first_line(r + 1); ++k) {
      V const limited =
          share_that_keeps_height(
              wall.lines(k), turn, n_faces, [&](Index f) { return wall.face(first + 2 * f, x, baseline); },
              [&](Index f) { return wall.face(first + 2 * f, y, moved); }) *
          turn;
      auto const size = norm(limited);
      if (!((least - size) > 0)) continue;
      kept = limited;
      least = size;
    }
    return kept;
  }

  KOKKOS_INLINE_FUNCTION V turn_of_faces(Index r) const {
    V const after = wall.normal_after(r, baseline, moved);
    V const before = wall.normal(r, baseline);
    if (wall.flat) return canonical(turn_between(before, after, wall.across));
    V const swing = turn_between(before, after);
    auto const size = norm(after);
    if (!(size > 0)) return swing;
    V const axis = (1 / size) * after;
    V const x = baseline[wall.node(r)], y = moved[wall.node(r)];
    Index const first = wall.first(r);
    V const twist = twist_about(
        axis, swing, wall.first(r + 1) - first, [&](Index k) { return baseline[wall.around(first + k)] - x; },
        [&](Index k) { return moved[wall.around(first + k)] - y; }, UnweighedArms{});
    return turn_then(swing, twist);
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
    V const turn = turn_of(r);
    frame[r] = {u[wall.node(r)], matrix_of_map([&](Vec3 const& e) { return written(turned_by(turn, V{e})); })};
  }

 private:
  KOKKOS_INLINE_FUNCTION V turn_of(Index r) const {
    if constexpr (has_rate<V>)
      return {turn[r], turn_rate[r]};
    else
      return turn[r];
  }
};

}  // namespace gridmorph::kernels
