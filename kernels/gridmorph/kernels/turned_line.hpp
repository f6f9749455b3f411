// Lines whose ends turn. An end that turns by R about a pivot p moves what is near it by (R - I)(x - p) besides its own
// displacement,
//
//   u(x) = u0 + w(t) (u1 - u0) + (R0(f0) - I)(x - p0) + (R1(f1) - I)(x - p1)
//
// with t the line parameter, w the law of displacements, f the law of rotations and R(f) the share f of a rotation:
//
//   square      f0 = (1 - t)^2, f1 = t^2
//   c1          f0 = 1 - f1,    f1 = 3 t^2 - 2 t^3
//   far         f0 = 1 - scale (P(reach t) - 1),  P(s) = (1 + s^2 / (1 + s))^(1/8),  scale = 1 / (P(reach) - 1): about
//               like the logarithm of the distance from a body, which spreads the shear r da/dr of a turn evenly, with
//               no slope at its start. By square roots, which every machine rounds alike
//   common      one rotation about one pivot, from one end's to the other's, by c1
//   near_field  one rotation about the wall node, from the wall's to that of the outer edge, and the stretch s of the
//               wall's lines (turned_ends.hpp):
//               u0 + [(1 + f0 (s - 1)) R(f0) - I](x - p0),  f0 = (1 - 1.03 t^2 / (t + 0.03))^3
//
// Shares of rotations (rotation.hpp) are taken by unit quaternions, here from that of no rotation or of the other end,
//
//   q(f) = (q1 + f (q0 - q1)) / |q1 + f (q0 - q1)|
//
// so what is between two ends is turned and never shrunk, as it would be by a mean of matrices, and a node costs no
// trigonometry (K. Shoemake, Computer Graphics 19 (1985) 245; the angle is that of f to 2 degrees over two radians, to
// 8 over half a turn). Nothing is added where x = p and where nothing turns. The rotation itself goes on as f0 r0 + f1
// r1.
//
// Cost per node and turned end: about 50 flops with one division, 56 bytes from cache (near field 64, 96 where its
// outer edge turns).
#pragma once

#include <gridmorph/kernels/field.hpp>
#include <gridmorph/kernels/rotation.hpp>

#include <type_traits>

namespace gridmorph::kernels {

struct TurnWeights {
  double lower, upper;
};

/// The function P of the law `far`.
KOKKOS_INLINE_FUNCTION double far_growth(double s) {
  using std::sqrt;
  return sqrt(sqrt(sqrt(1 + s * s / (1 + s))));
}
struct FarLaw {
  double scale, reach;
  KOKKOS_INLINE_FUNCTION explicit FarLaw(Chain const& chain) : scale(chain.turn_scale), reach(chain.turn_reach) {}
  KOKKOS_INLINE_FUNCTION double operator()(double t) const { return 1 - scale * (far_growth(reach * t) - 1); }
};
/// The weight of the wall's rotation at t in the near field, without a slope at the wall, so that the first cells turn
/// with it whole.
KOKKOS_INLINE_FUNCTION double near_field_weight(double t) {
  constexpr double start = 0.03;
  double const left = 1 - (1 + start) * t * t / (t + start);
  return left * left * left;
}

/// What a chain that turns gives its two ends; only the first counts where there is one rotation for both.
KOKKOS_INLINE_FUNCTION TurnWeights turn_weights(Chain const& chain, double t) {
  switch (chain.turn) {
    case TurnLaw::near_field: return {near_field_weight(t), 1 - near_field_weight(t)};
    case TurnLaw::square: return {(1 - t) * (1 - t), t * t};
    case TurnLaw::c1:
    case TurnLaw::common: return {1 - law_weight(LineLaw::c1, t), 1 - law_weight(LineLaw::c1, 1 - t)};
    case TurnLaw::far: return {FarLaw(chain)(t), FarLaw(chain)(1 - t)};
    case TurnLaw::none: return {0, 0};
  }
  return {0, 0};
}

/// How a line end turns.
template <class V>
struct TurnedEnd {
  Quaternion<V> q;
  Vec3 pivot;
  typename Quaternion<V>::Scalar stretch{};  ///< s - 1; near field
};

/// How all line ends turn: eight arrays one after another.
template <class T>
struct TurnedEnds {
  static constexpr int components = 8;
  T* first = nullptr;
  Index n = 0;

  KOKKOS_FORCEINLINE_FUNCTION T* component(int c) const { return first + c * n; }
  KOKKOS_FORCEINLINE_FUNCTION TurnedEnd<Vec3> operator[](Index end) const {
    auto const at = [&](int c) { return component(c)[end]; };
    return {{{at(0), at(1), at(2)}, at(3)}, {at(4), at(5), at(6)}, at(7)};
  }
  KOKKOS_INLINE_FUNCTION void set(Index end, TurnedEnd<Vec3> const& e) const {
    double const values[components] = {e.q.imaginary.x, e.q.imaginary.y, e.q.imaginary.z, e.q.less,
                                       e.pivot.x,       e.pivot.y,       e.pivot.z,       e.stretch};
    for (int c = 0; c < components; ++c) component(c)[end] = values[c];
  }
};

/// Ends, and where rates of displacements are asked for their rates.
struct TurnedEndsWithRates {
  TurnedEnds<double const> values, rates = {};

  [[nodiscard]] KOKKOS_INLINE_FUNCTION bool has_rates() const { return rates.first != nullptr; }
  template <class V>
  KOKKOS_INLINE_FUNCTION TurnedEnd<V> at(Index end) const {
    TurnedEnd<Vec3> const e = values[end];
    if constexpr (has_rate<V>) {
      TurnedEnd<Vec3> const r = rates[end];
      return {{{e.q.imaginary, r.q.imaginary}, {e.q.less, r.q.less}}, e.pivot, {e.stretch, r.stretch}};
    } else {
      return e;
    }
  }
};

/// Whether a chain that turns has one rotation for both its ends.
KOKKOS_INLINE_FUNCTION bool turns_as_one(Chain const& chain) {
  return chain.turn == TurnLaw::near_field || chain.turn == TurnLaw::common;
}
/// What one rotation for both ends, `between` them, adds to a node at x with the share f of the first one, which
/// stretches.
template <class V>
KOKKOS_FORCEINLINE_FUNCTION V turned_as_one(Quaternion<V> const& between, TurnedEnd<V> const& wall, double f,
                                            Vec3 const& x) {
  V const r{x - wall.pivot}, change = between.turned(r);
  return change + (f * wall.stretch) * (r + change);
}

/// What the ends at `lower` and `upper` add to a node at x of a chain that turns, in its frame.
template <class V>
KOKKOS_INLINE_FUNCTION V turned_between(TurnedEndsWithRates const& all, Chain const& chain, Index lower, Index upper,
                                        double t, Vec3 const& x) {
  using Q = Quaternion<V>;
  TurnWeights const f = turn_weights(chain, t);
  if (turns_as_one(chain)) {
    TurnedEnd<V> const wall = all.at<V>(lower);
    bool const outer = (chain.turned_ends & 2u) != 0;
    return turned_as_one(outer ? Q::between(all.at<V>(upper).q, wall.q, f.lower) : Q::share(wall.q, f.lower), wall,
                         f.lower, x);
  }
  V sum{};
  auto const add = [&](Index end, double share) {
    TurnedEnd<V> const e = all.at<V>(end);
    sum = sum + Q::share(e.q, share).turned(V{x - e.pivot});
  };
  if (chain.turned_ends & 1u) add(lower, f.lower);
  if (chain.turned_ends & 2u) add(upper, f.upper);
  return sum;
}

/// Which chains a kernel is for. One that leaves out what its chains have not needs a fraction of the registers, and so
/// a GPU runs several times as many of its items at once; the host has one kernel for all.
enum class Turning {
  none,    ///< none that turns
  steady,  ///< no rates
  rates,   ///< rates alone
  any
};
/// Calls run(kernel for the chains that there are), a Turning in the type of its argument.
template <bool on_host, class Run>
void with_turning(bool turns, TurnedEndsWithRates const& ends, Run const& run) {
  auto const as = [&]<Turning Turns>() { run(std::integral_constant<Turning, Turns>()); };
  if constexpr (on_host) {
    as.template operator()<Turning::any>();
  } else {
    if (!turns) return as.template operator()<Turning::none>();
    ends.has_rates() ? as.template operator()<Turning::rates>() : as.template operator()<Turning::steady>();
  }
}

/// What the ends of line (a, b) of a chain that turns add to a node at x; the rate of that where there are rates.
template <Turning Turns = Turning::any>
KOKKOS_INLINE_FUNCTION Vec3 turned_between(TurnedEndsWithRates const& all, Chain const& chain, Index a, Index b,
                                           double t, Vec3 const& x) {
  Index const lower = chain.first_end_value + a + chain.n_a * b, upper = lower + chain.section_size();
  if constexpr (Turns != Turning::steady)
    if (Turns == Turning::rates || all.has_rates())
      return turned_between<DualVec3>(all, chain, lower, upper, t, x).rate;
  return turned_between<Vec3>(all, chain, lower, upper, t, x);
}

/// The rotation there.
KOKKOS_INLINE_FUNCTION Vec3 turn_between_ends(Field<double const> const& turns, Chain const& chain, Index a, Index b,
                                              double t) {
  Index const at = chain.first_end_value + a + chain.n_a * b;
  TurnWeights const f = turn_weights(chain, t);
  Vec3 sum;
  if (chain.turned_ends & 1u) sum += f.lower * turns[at];
  if (chain.turned_ends & 2u) sum += f.upper * turns[at + chain.section_size()];
  return sum;
}

}  // namespace gridmorph::kernels
