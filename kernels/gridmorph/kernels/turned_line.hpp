// Lines whose ends turn. An end at p that turns by R moves what is near it by (R - I)(x - p) besides its own displacement,
//
//   u(x) = u0 + w(t) (u1 - u0) + f0(t) (M0 x + b0) + f1(t) (M1 x + b1),   M = R - I, b = -M p
//
// with t the line parameter, w the law of displacements and f the law of rotations:
//
//   near_field  f0 = (1 - t)^3, f1 = 1 - f0: from the wall's rotation to that of the outer edge, both about the wall node
//   square      f0 = (1 - t)^2, f1 = t^2
//   c1          f0 = 1 - f1,    f1 = 3 t^2 - 2 t^3
//
// M and b are made once per line end and morph (turned_ends.hpp), so nodes cost no trigonometry. Nothing is added where
// x = p and where nothing turns. The rotation vector itself goes on as f0 w0 + f1 w1.
//
// Cost per node and turned end: about 24 multiply-adds, 96 bytes from cache.
#pragma once

#include <gridmorph/kernels/field.hpp>

namespace gridmorph::kernels {

struct TurnWeights {
  double lower, upper;
};

KOKKOS_INLINE_FUNCTION TurnWeights turn_weights(TurnLaw law, double t) {
  double const r = 1 - t;
  switch (law) {
    case TurnLaw::near_field: return {r * r * r, 1 - r * r * r};
    case TurnLaw::square: return {r * r, t * t};
    case TurnLaw::c1: return {1 - t * t * (3 - 2 * t), t * t * (3 - 2 * t)};
    case TurnLaw::none: return {0, 0};
  }
  return {0, 0};
}

/// M and b of line ends: twelve arrays one after another, M row by row.
template <class T>
struct TurnedEnds {
  static constexpr int components = 12;
  T* first = nullptr;
  Index n = 0;

  KOKKOS_INLINE_FUNCTION T* component(int c) const { return first + c * n; }
  /// M x + b.
  KOKKOS_INLINE_FUNCTION Vec3 operator()(Index end, Vec3 const& x) const {
    auto const m = [&](int c) { return component(c)[end]; };
    return {m(0) * x.x + m(1) * x.y + m(2) * x.z + m(9), m(3) * x.x + m(4) * x.y + m(5) * x.z + m(10),
            m(6) * x.x + m(7) * x.y + m(8) * x.z + m(11)};
  }
  /// Columns of M.
  KOKKOS_INLINE_FUNCTION void set(Index end, Vec3 const& mx, Vec3 const& my, Vec3 const& mz, Vec3 const& b) const {
    double const values[components] = {mx.x, my.x, mz.x, mx.y, my.y, mz.y, mx.z, my.z, mz.z, b.x, b.y, b.z};
    for (int c = 0; c < components; ++c) component(c)[end] = values[c];
  }
};

/// What the rotations of its ends add to a node of line (a, b) at x, chain frame. The chain turns.
KOKKOS_INLINE_FUNCTION Vec3 turned_between(TurnedEnds<double const> const& ends, Chain const& chain, Index a, Index b,
                                           double t, Vec3 const& x) {
  Index const at = chain.first_end_value + a + chain.n_a * b;
  TurnWeights const f = turn_weights(chain.turn, t);
  Vec3 sum;
  if (chain.turned_ends & 1u) sum += f.lower * ends(at, x);
  if (chain.turned_ends & 2u) sum += f.upper * ends(at + chain.section_size(), x);
  return sum;
}

/// The rotation vector there.
KOKKOS_INLINE_FUNCTION Vec3 turn_between_ends(Field<double const> const& turns, Chain const& chain, Index a, Index b,
                                              double t) {
  Index const at = chain.first_end_value + a + chain.n_a * b;
  TurnWeights const f = turn_weights(chain.turn, t);
  Vec3 sum;
  if (chain.turned_ends & 1u) sum += f.lower * turns[at];
  if (chain.turned_ends & 2u) sum += f.upper * turns[at + chain.section_size()];
  return sum;
}

}  // namespace gridmorph::kernels
