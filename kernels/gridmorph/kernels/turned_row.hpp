// What line ends that turn add to a row of nodes inside a chain at once: turned_line.hpp, one loop for the whole row per end.
#pragma once

#include <gridmorph/kernels/row_correction.hpp>
#include <gridmorph/kernels/turned_line.hpp>

namespace gridmorph::kernels {

/// Nodes w = 0 ... n - 1 at fractions t[w] of their lines, whose first ends are `lower` + w step.
template <int width>
struct TurnedRow {
  TurnedEnds<double const> ends;
  Chain const& chain;
  Index lower;
  double const* t;
  int n;

  /// x: positions in the frame of the chain.
  template <class Step>
  KOKKOS_INLINE_FUNCTION void add_to(Step step, VectorRow<width> const& x, VectorRow<width>& v) const {
    if (chain.turned_ends & 1u) add_end(step, weights<0>(), lower, x, v);
    if (chain.turned_ends & 2u) add_end(step, weights<1>(), lower + chain.section_size(), x, v);
  }

 private:
  struct Weights {
    double of[width];
  };
  template <int end>
  KOKKOS_INLINE_FUNCTION Weights weights() const {
    Weights f;
    auto const fill = [&](TurnLaw law) {
      for (int w = 0; w < n; ++w) {
        TurnWeights const both = turn_weights(law, t[w]);
        f.of[w] = end == 0 ? both.lower : both.upper;
      }
    };
    // One loop per law, so that none has a choice in it.
    switch (chain.turn) {
      case TurnLaw::near_field: fill(TurnLaw::near_field); break;
      case TurnLaw::square: fill(TurnLaw::square); break;
      case TurnLaw::c1: fill(TurnLaw::c1); break;
      case TurnLaw::none: fill(TurnLaw::none); break;
    }
    return f;
  }
  template <class Step>
  KOKKOS_INLINE_FUNCTION void add_end(Step step, Weights const& f, Index at, VectorRow<width> const& x,
                                      VectorRow<width>& v) const {
    add_component(step, f, at, 0, x, v.x);
    add_component(step, f, at, 1, x, v.y);
    add_component(step, f, at, 2, x, v.z);
  }
  template <class Step>
  KOKKOS_INLINE_FUNCTION void add_component(Step step, Weights const& f, Index at, int row, VectorRow<width> const& x,
                                            double* v) const {
    double const *const mx = ends.component(3 * row) + at, *const my = ends.component(3 * row + 1) + at,
                        *const mz = ends.component(3 * row + 2) + at, *const b = ends.component(9 + row) + at;
    for (int w = 0; w < n; ++w)
      v[w] += f.of[w] * (mx[w * step] * x.x[w] + my[w * step] * x.y[w] + mz[w * step] * x.z[w] + b[w * step]);
  }
};

}  // namespace gridmorph::kernels
