// What line ends that turn add to a row of nodes inside a chain at once: turned_line.hpp, one loop for the whole row
// per end.
#pragma once

#include <gridmorph/kernels/row_correction.hpp>
#include <gridmorph/kernels/turned_line.hpp>

namespace gridmorph::kernels {

/// Nodes w = 0 ... n - 1 at fractions t[w] of their lines, whose first ends are `lower` + w step.
template <int width>
struct TurnedRow {
  TurnedEndsWithRates const& ends;
  Chain const& chain;
  Index lower;
  double const* t;
  int n;

  /// Adds what the ends turn a row of nodes by. x: positions in the frame of the chain.
  template <class Step>
  KOKKOS_INLINE_FUNCTION void add_to(Step step, VectorRow<width> const& x, VectorRow<width>& v) const {
    Weights f;
    if (ends.has_rates()) {
      add_rates(step, x, v);
    } else if (turns_as_one(chain)) {
      if (chain.turn == TurnLaw::near_field)
        fill([](double at) { return near_field_weight(at); }, f);
      else
        fill([](double at) { return 1 - law_weight(LineLaw::c1, at); }, f);
      chain.turned_ends & 2u ? add_as_one<true>(step, f, x, v) : add_as_one<false>(step, f, x, v);
    } else {
      for (unsigned end = 0; end < 2; ++end)
        if (chain.turned_ends & (1u + end)) {
          fill_end(end, f);
          add_end(step, f, lower + Index(end) * chain.section_size(), x, v);
        }
    }
  }

 private:
  struct Weights {
    double of[width];
  };
  template <class Law>
  KOKKOS_INLINE_FUNCTION void fill(Law const& law, Weights& f) const {
    for (int w = 0; w < n; ++w) f.of[w] = law(t[w]);
  }
  /// One loop per law, so that none has a choice in it. All laws of two rotations are the same from both ends.
  KOKKOS_INLINE_FUNCTION void fill_end(unsigned end, Weights& f) const {
    double const from = end, sign = end == 0 ? 1 : -1;
    if (chain.turn == TurnLaw::far)
      fill([&](double at) { return far_weight(chain, from + sign * at); }, f);
    else if (chain.turn == TurnLaw::c1)
      fill([&](double at) { return 1 - law_weight(LineLaw::c1, from + sign * at); }, f);
    else
      fill([&](double at) { return (1 - from - sign * at) * (1 - from - sign * at); }, f);
  }
  KOKKOS_FORCEINLINE_FUNCTION static Vec3 get(VectorRow<width> const& x, int w) { return {x.x[w], x.y[w], x.z[w]}; }
  /// Adds change(w) to v, through a row of its own: nothing that is read can lie where it is written, so that the
  /// compiler can vectorise the loop.
  template <class Change>
  KOKKOS_FORCEINLINE_FUNCTION void add(Change const& change, VectorRow<width>& v) const {
    VectorRow<width> row;
    for (int w = 0; w < n; ++w) {
      Vec3 const c = change(w);
      row.x[w] = c.x;
      row.y[w] = c.y;
      row.z[w] = c.z;
    }
    for (int w = 0; w < n; ++w) {
      v.x[w] += row.x[w];
      v.y[w] += row.y[w];
      v.z[w] += row.z[w];
    }
  }

  template <class Step>
  KOKKOS_INLINE_FUNCTION void add_end(Step step, Weights const& f, Index first, VectorRow<width> const& x,
                                      VectorRow<width>& v) const {
    TurnedEnds<double const> const at = ends.values;
    add(
        [&](int w) {
          TurnedEnd<Vec3> const e = at[first + w * step];
          return Quaternion<Vec3>::share(e.q, f.of[w]).turned(get(x, w) - e.pivot);
        },
        v);
  }
  /// Outer: whether the other end turns too.
  template <bool Outer, class Step>
  KOKKOS_INLINE_FUNCTION void add_as_one(Step step, Weights const& f, VectorRow<width> const& x,
                                         VectorRow<width>& v) const {
    TurnedEnds<double const> const at = ends.values;
    Index const first = lower, upper = lower + chain.section_size();
    add(
        [&](int w) {
          using Q = Quaternion<Vec3>;
          TurnedEnd<Vec3> const wall = at[first + w * step];
          Q const q = Outer ? Q::between(at[upper + w * step].q, wall.q, f.of[w]) : Q::share(wall.q, f.of[w]);
          return turned_as_one(q, wall, f.of[w], get(x, w));
        },
        v);
  }
  template <class Step>
  GRIDMORPH_CALLED_ON_HOST KOKKOS_FUNCTION void add_rates(Step step, VectorRow<width> const& x,
                                                          VectorRow<width>& v) const {
    add(
        [&](int w) {
          Index const at = lower + w * step;
          return turned_between<DualVec3>(ends, chain, at, at + chain.section_size(), t[w], get(x, w)).rate;
        },
        v);
  }
};

}  // namespace gridmorph::kernels
