// What rows of nodes hand back to the turned ends of their lines: the transpose of turned_row.hpp, one loop for the
// whole row per end. Ends and sums lie in rows of their own, line by line, so that the compiler can vectorise these
// loops.
//
// Cost per node and end that turns: about 90 flops with one division, the ends and their sums from the first-level
// cache.
#pragma once

#include <gridmorph/kernels/rotation_gradient.hpp>
#include <gridmorph/kernels/row_correction.hpp>
#include <gridmorph/kernels/turned_row.hpp>

namespace gridmorph::kernels {

/// turn_weights() of one of a chain's ends, for a row: one loop per law, so that none has a choice in it.
KOKKOS_FORCEINLINE_FUNCTION void fill_turn_weights(Chain const& chain, unsigned end, double const* t, int n,
                                                   double* f) {
  auto const fill = [&](auto const& law) {
    for (int w = 0; w < n; ++w) f[w] = law(t[w]);
  };
  if (chain.turn == TurnLaw::near_field)
    fill([=](double at) { return end == 0 ? near_field_weight(at) : 1 - near_field_weight(at); });
  else
    with_turn_law(chain, end, fill);
}

/// The gradients of line ends, in arrays as those of TurnedEnds, pivots unused.
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

/// n neighbouring lines of a chain that turns, whose first ends are `lower` + w; or one line, whose nodes are added up
/// in n shares.
template <int width>
class TurnedLines {
 public:
  KOKKOS_INLINE_FUNCTION TurnedLines(TurnedEnds<double const> const& ends, Chain const& chain, Index lower, int n,
                                     bool one_line = false)
      : chain_(chain), n_(n), step_(one_line ? 0 : 1) {
    for (unsigned end = 0; end < 2; ++end)
      if ((chain.turned_ends & (1u + end)) != 0 || (end == 0 && turns_as_one(chain)))
        load(ends, lower + Index(end) * chain.section_size(), ends_[end]);
  }

  /// Adds what the first n nodes give: at fractions t, positions x in the frame of the chain, gradients g.
  KOKKOS_INLINE_FUNCTION void add(double const* t, VectorRow<width> const& x, VectorRow<width> const& g, int n) {
    double f[width];
    if (turns_as_one(chain_)) {
      fill_turn_weights(chain_, 0, t, n, f);
      chain_.turned_ends & 2u ? add_as_one<true>(f, x, g, n) : add_as_one<false>(f, x, g, n);
      return;
    }
    for (unsigned end = 0; end < 2; ++end)
      if (chain_.turned_ends & (1u + end)) {
        fill_turn_weights(chain_, end, t, n, f);
        add_end(end, f, x, g, n);
      }
  }
  /// Takes into the sums g, gradients of the rotations that the lines hand to nodes.
  KOKKOS_INLINE_FUNCTION void add_turns(double const* t, VectorRow<width> const& g, int n) {
    double f[width];
    for (unsigned end = 0; end < 2; ++end) {
      if ((chain_.turned_ends & (1u + end)) == 0) continue;
      fill_turn_weights(chain_, end, t, n, f);
      Sum& to = sums_[end];
      for (int w = 0; w < n; ++w) {
        to.turn[0][w] += f[w] * g.x[w];
        to.turn[1][w] += f[w] * g.y[w];
        to.turn[2][w] += f[w] * g.z[w];
      }
    }
  }

  /// Sets the gradients at both ends.
  KOKKOS_INLINE_FUNCTION void write(Index lower, TurnedEndGradients const& turned, Field<double> const& turns) const {
    for (unsigned end = 0; end < 2; ++end)
      for (int w = 0; w < n_; ++w) {
        Index const at = lower + Index(end) * chain_.section_size() + w;
        turned.set(at, sums_[end].rotation(w));
        turns.set(at, sums_[end].turn_of(w));
      }
  }
  /// Sets the gradients at both ends of one line, the sums over its shares.
  KOKKOS_INLINE_FUNCTION void write_sum(Index lower, TurnedEndGradients const& turned,
                                        Field<double> const& turns) const {
    for (unsigned end = 0; end < 2; ++end) {
      TurnedGradient sum;
      Vec3 of_turn;
      for (int w = 0; w < n_; ++w) {
        sum.add(1, sums_[end].rotation(w));
        of_turn += sums_[end].turn_of(w);
      }
      Index const at = lower + Index(end) * chain_.section_size();
      turned.set(at, sum);
      turns.set(at, of_turn);
    }
  }

 private:
  using Row = VectorRow<width>;
  struct End {
    double q[4][width], pivot[3][width], stretch[width];
    KOKKOS_FORCEINLINE_FUNCTION Quaternion<Vec3> quaternion(int w) const {
      return {{q[0][w], q[1][w], q[2][w]}, q[3][w]};
    }
    KOKKOS_FORCEINLINE_FUNCTION Vec3 arm(Row const& x, int w) const {
      return {x.x[w] - pivot[0][w], x.y[w] - pivot[1][w], x.z[w] - pivot[2][w]};
    }
  };
  struct Sum {
    double q[4][width] = {}, stretch[width] = {}, turn[3][width] = {};
    [[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION TurnedGradient rotation(int w) const {
      return {{q[0][w], q[1][w], q[2][w]}, q[3][w], stretch[w]};
    }
    [[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION Vec3 turn_of(int w) const { return {turn[0][w], turn[1][w], turn[2][w]}; }
    KOKKOS_FORCEINLINE_FUNCTION void add(int w, double f, TurnedGradient const& g) {
      q[0][w] += f * g.imaginary.x;
      q[1][w] += f * g.imaginary.y;
      q[2][w] += f * g.imaginary.z;
      q[3][w] += f * g.less;
    }
  };

  KOKKOS_INLINE_FUNCTION void load(TurnedEnds<double const> const& ends, Index first, End& to) {
    for (int w = 0; w < n_; ++w) {
      TurnedEnd<Vec3> const e = ends[first + step_ * w];
      to.q[0][w] = e.q.imaginary.x;
      to.q[1][w] = e.q.imaginary.y;
      to.q[2][w] = e.q.imaginary.z;
      to.q[3][w] = e.q.less;
      to.pivot[0][w] = e.pivot.x;
      to.pivot[1][w] = e.pivot.y;
      to.pivot[2][w] = e.pivot.z;
      to.stretch[w] = e.stretch;
    }
  }

  KOKKOS_INLINE_FUNCTION void add_end(unsigned end, double const* f, Row const& x, Row const& g, int n) {
    End const& end_of = ends_[end];
    Sum& to = sums_[end];
    for (int w = 0; w < n; ++w) {
      double scale = 0, along = 0;
      TurnedGradient const of = turned_gradient(Quaternion<Vec3>::share(end_of.quaternion(w), f[w]), end_of.arm(x, w),
                                                {g.x[w], g.y[w], g.z[w]}, scale, along);
      to.add(w, f[w] * scale, of);
    }
  }
  /// Outer: whether the other end turns too.
  template <bool Outer>
  KOKKOS_INLINE_FUNCTION void add_as_one(double const* f, Row const& x, Row const& g, int n) {
    using Q = Quaternion<Vec3>;
    End const &wall = ends_[0], &edge = ends_[1];
    Sum &first = sums_[0], &last = sums_[1];
    for (int w = 0; w < n; ++w) {
      Q const own = wall.quaternion(w), q = Outer ? Q::between(edge.quaternion(w), own, f[w]) : Q::share(own, f[w]);
      Vec3 const arm = wall.arm(x, w), gradient{g.x[w], g.y[w], g.z[w]};
      double scale = 0, along = 0;
      TurnedGradient const of = turned_gradient(q, arm, gradient, scale, along);
      double const stretched = scale * (1 + f[w] * wall.stretch[w]), share = f[w] * stretched;
      first.add(w, share, of);
      first.stretch[w] += f[w] * (dot(gradient, arm) + along);
      if (Outer) last.add(w, stretched - share, of);
    }
  }

  Chain const& chain_;
  int n_, step_;
  End ends_[2];
  Sum sums_[2];
};

}  // namespace gridmorph::kernels
