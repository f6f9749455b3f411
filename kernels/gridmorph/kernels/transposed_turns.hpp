// Gradients through rotations of line ends: the transposes of turned_line.hpp, turned_ends.hpp and root_turn.hpp, linearised where the
// walls are.
//
// What a node's displacement asks of the quaternion q = (1 - l, v) that turns its arm y: with A = v x y, B = (1 - l) A + v x A,
// N = (1 - l)^2 + v.v, c = 2 B / N and the gradient g of c,
//
//   G = 2 g / N,  n = -(g.c) / N,  a = (1 - l) G + G x v
//   dJ/dv = A x G + y x a + 2 n v,  dJ/dl = -(G.A + 2 (1 - l) n)
//
// Rotations of walls depend on few vectors each; their gradients are taken by exact rates (dual.hpp) along the three axes of every vector
// that they depend on, item by item of what is depended on: sums come in one order.
#pragma once

#include <gridmorph/kernels/turned_ends.hpp>

namespace gridmorph::kernels {

/// Of a TurnedEnd.
struct TurnedGradient {
  Vec3 imaginary;
  double less = 0, stretch = 0;

  KOKKOS_INLINE_FUNCTION void add(double f, TurnedGradient const& g) {
    imaginary += f * g.imaginary;
    less += f * g.less;
    stretch += f * g.stretch;
  }
};

/// Of line ends: arrays as those of TurnedEnds, pivots unused.
struct TurnedEndGradients {
  TurnedEnds<double> at;

  KOKKOS_INLINE_FUNCTION void set(Index end, TurnedGradient const& g) const {
    at.set(end, {{g.imaginary, g.less}, {}, g.stretch});
  }
  KOKKOS_INLINE_FUNCTION TurnedGradient operator[](Index end) const {
    TurnedEnd<Vec3> const e = TurnedEnds<double const>{at.first, at.n}[end];
    return {e.q.imaginary, e.q.less, e.stretch};
  }
  KOKKOS_INLINE_FUNCTION void add(Index end, double f, TurnedGradient const& g) const {
    TurnedGradient sum = (*this)[end];
    sum.add(f, g);
    set(end, sum);
  }
};

/// Of q.turned(y), whose gradient is g.
KOKKOS_INLINE_FUNCTION TurnedGradient turned_gradient(Quaternion<Vec3> const& q, Vec3 const& y, Vec3 const& g) {
  Vec3 const& v = q.imaginary;
  double const real = 1 - q.less, size = real * real + dot(v, v);
  Vec3 const A = cross(v, y), c = (2 / size) * (real * A + cross(v, A));
  Vec3 const G = (2 / size) * g;
  double const n = -dot(g, c) / size;
  Vec3 const a = real * G + cross(G, v);
  return {cross(A, G) + cross(y, a) + (2 * n) * v, -(dot(G, A) + 2 * real * n), 0};
}

/// Of what turned_between() gives a node at x, whose gradient is g: added to those of the two ends.
KOKKOS_INLINE_FUNCTION void turned_gradient(TurnedEnds<double const> const& ends, Chain const& chain, Index lower,
                                            Index upper, double t, Vec3 const& x, Vec3 const& g, TurnedGradient& first,
                                            TurnedGradient& last) {
  using Q = Quaternion<Vec3>;
  TurnWeights const f = turn_weights(chain, t);
  if (turns_as_one(chain)) {
    TurnedEnd<Vec3> const wall = ends[lower];
    bool const outer = (chain.turned_ends & 2u) != 0;
    Q const q = outer ? Q::between(ends[upper].q, wall.q, f.lower) : Q::share(wall.q, f.lower);
    Vec3 const arm = x - wall.pivot;
    TurnedGradient const of_q = turned_gradient(q, arm, (1 + f.lower * wall.stretch) * g);
    first.add(f.lower, of_q);
    if (outer) last.add(1 - f.lower, of_q);
    first.stretch += f.lower * dot(g, arm + q.turned(arm));
    return;
  }
  auto const add = [&](Index end, double share, TurnedGradient& to) {
    TurnedEnd<Vec3> const e = ends[end];
    to.add(share, turned_gradient(Q::share(e.q, share), x - e.pivot, g));
  };
  if (chain.turned_ends & 1u) add(lower, f.lower, first);
  if (chain.turned_ends & 2u) add(upper, f.upper, last);
}

/// Of quaternion_of(r).
KOKKOS_INLINE_FUNCTION Vec3 rotation_gradient(Vec3 const& r, TurnedGradient const& g) {
  double const square = dot(r, r), share = 2 / (1 + square);
  double const of_share = dot(g.imaginary, r) + g.less * square;
  double const of_square = g.less * share - 0.5 * of_share * share * share;
  return share * g.imaginary + (2 * of_square) * r;
}

/// Transpose of TurnEnds: gradients of rotations, from those of what was made of them.
struct TurnEndsBack {
  Field<double const> turn;             ///< rotations
  Field<double const> position, pivot;  ///< baseline, chain frame
  Field<double const> u;                ///< gradients of displacements of ends
  TurnedEndGradients turned;
  Field<double> turns;  ///< gradients of rotations
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const {
    Vec3 const arm = position[n] - pivot[n];
    TurnedGradient g = turned[n];
    if (dot(arm, arm) > 0) g.add(-1, turned_gradient(quaternion_of(turn[n]), arm, u[n]));
    turns.set(n, turns[n] + rotation_gradient(turn[n], g));
  }
};

/// What depends on what: of target n those dependents from first(n) on.
template <class MemorySpace>
struct Dependents {
  Kokkos::View<Index const*, MemorySpace> target, first, dependent;
};

/// One vector of a list that changes along a direction while the others stay.
struct SeededVectors {
  Field<double const> values;
  Index seeded = -1;
  Vec3 direction;
  KOKKOS_INLINE_FUNCTION DualVec3 operator[](Index n) const { return {values[n], n == seeded ? direction : Vec3{}}; }
};

/// gradient(target) += sum over what depends on it; of(dependent, target, direction): rate of J by way of one dependent where the target
/// changes along a direction. One item per target.
template <class MemorySpace, class Function>
struct PullBack {
  Dependents<MemorySpace> on;
  Function of;
  Field<double> gradient;

  [[nodiscard]] Index size() const { return Index(on.target.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const {
    Index const target = on.target(n);
    Vec3 sum = gradient[target];
    for (Index m = on.first(n); m < on.first(n + 1); ++m) {
      Index const d = on.dependent(m);
      sum += {of(d, target, Vec3{1, 0, 0}), of(d, target, Vec3{0, 1, 0}), of(d, target, Vec3{0, 0, 1})};
    }
    gradient.set(target, sum);
  }
};
template <class Exec, class Function>
void pull_back(char const* label, Exec const& exec, Dependents<typename Exec::memory_space> const& on,
               Function const& of, Field<double> const& gradient) {
  launch(label, exec, PullBack<typename Exec::memory_space, Function>{on, of, gradient});
}

/// Root r by the displacement of a slot.
template <class MemorySpace>
struct RawTurnBySlot {
  RawRootTurn<MemorySpace, DualVec3> turn;
  Field<double const> u, raw;  ///< displacements; gradients
  KOKKOS_INLINE_FUNCTION double operator()(Index r, Index slot, Vec3 const& direction) const {
    return dot(turn.at(r, SeededVectors{u, slot, direction}).rate, raw[r]);
  }
};

/// End wall e by the displacement of a slot (raw == false), or by the rotation of a root.
template <class MemorySpace, bool by_raw>
struct EndWallTurnBy {
  EndWallTurn<MemorySpace, DualVec3> turn;
  Field<double const> u, raw;
  Field<double const> at_end;  ///< gradients, 3 per end wall
  KOKKOS_INLINE_FUNCTION double operator()(Index e, Index target, Vec3 const& direction) const {
    auto const found = turn.at(e, SeededVectors{u, by_raw ? -1 : target, direction},
                               SeededVectors{raw, by_raw ? target : -1, direction});
    return dot(found.alpha.rate, at_end[3 * e]) + dot(found.before.rate, at_end[3 * e + 1]) +
           dot(found.after.rate, at_end[3 * e + 2]);
  }
};

/// Root r by its raw rotation (by_raw), or by one of the vectors of an end wall.
template <class MemorySpace, bool by_raw>
struct NearFieldTurnBy {
  NearFieldTurn<MemorySpace, DualVec3> turn;
  Field<double const> raw, at_end;
  Field<double const> inner, outer;  ///< gradients, per slot and root
  KOKKOS_INLINE_FUNCTION double operator()(Index r, Index target, Vec3 const& direction) const {
    if (turn.table.roots(r).stands == 0) return 0;
    auto const found = turn.at(r, SeededVectors{raw, by_raw ? target : -1, direction},
                               EndWallVectors<SeededVectors>{{at_end, by_raw ? -1 : target, direction}});
    return dot(found.inner.rate, inner[turn.table.roots(r).slot]) + dot(found.outer.rate, outer[r]);
  }
};

/// One of what a line of the near field depends on: the rotations of its root.
enum class LineInput { inner, raw, outer };
template <class MemorySpace, LineInput input>
struct NearFieldLineBy {
  TurnNearField<MemorySpace, DualVec3> turn;
  Field<double const> inner, raw, outer;
  Field<double const> turns;  ///< gradients of rotations of ends
  TurnedEndGradients turned;
  KOKKOS_INLINE_FUNCTION double operator()(Index n, Index target, Vec3 const& direction) const {
    auto const seeded = [&](LineInput which) { return which == input ? target : -1; };
    NearFieldLine const& line = turn.lines(n);
    auto const found = turn.at(line, SeededVectors{inner, seeded(LineInput::inner), direction},
                               SeededVectors{raw, seeded(LineInput::raw), direction},
                               SeededVectors{outer, seeded(LineInput::outer), direction});
    return dot(found.in.rate, turns[line.lower]) + dot(found.out.rate, turns[line.upper]) +
           rate_of(found.lower, turned[line.lower]) + rate_of(found.upper, turned[line.upper]);
  }

 private:
  KOKKOS_INLINE_FUNCTION static double rate_of(TurnedEnd<DualVec3> const& e, TurnedGradient const& g) {
    return dot(e.q.imaginary.rate, g.imaginary) + e.q.less.rate * g.less + e.stretch.rate * g.stretch;
  }
};

/// Gradients of line ends that have been handed on, or are about to be added to.
struct ClearEndGradients {
  Field<double> turns;
  TurnedEndGradients turned;
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const {
    turns.set(n, {});
    turned.set(n, {});
  }
};
/// The same for ends of the lines of the near field alone.
template <class MemorySpace>
struct ClearLineGradients {
  Kokkos::View<NearFieldLine const*, MemorySpace> lines;
  ClearEndGradients clear;
  [[nodiscard]] Index size() const { return Index(lines.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const {
    clear(lines(n).lower);
    clear(lines(n).upper);
  }
};

}  // namespace gridmorph::kernels
