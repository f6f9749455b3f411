// Rows of nodes whose displacement comes from the ends of one line each, or of two: read once, summed and written in
// one loop, where a row of buffers between the terms would be walked through four times per component.
//
//   out = x + u,   u = u0 + w(t) (u1 - u0) [+ the same of a second chain],   or out = u
//
// The sums are those of the pass through the volume term by term, and so are their bits.
//
// Cost per node: what is read and written; on a CPU two instructions of each kind per component and term.
#pragma once

#include <gridmorph/kernels/field.hpp>
#include <gridmorph/kernels/grid_line.hpp>
#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/kernels/node_copy.hpp>
#include <gridmorph/kernels/tile.hpp>

#include <type_traits>

namespace gridmorph::kernels {

/// The two ends of the lines through a row of nodes, and where the nodes lie on them.
struct RowEnds {
  Field<double const> e;
  Index lower;    ///< of the first node's line; that of the next one is `step` further
  Index section;  ///< from the lower ends to the upper ones
  Index step;
  double const* t;
  int n;
};

/// Nodes of a row: their baseline (not read where the displacement itself is asked for), and where they go. Both may be
/// the same arrays.
struct FusedRow {
  double const *from_x = nullptr, *from_y = nullptr, *from_z = nullptr;
  double *x = nullptr, *y = nullptr, *z = nullptr;
};

/// A law without numbers of its own, known to the compiler.
template <LineLaw law>
struct LawWeight {
  KOKKOS_FORCEINLINE_FUNCTION double operator()(double t) const { return law_weight(law, t); }
};

/// What a line gives to node w of a row: u0 + weight(t) (u1 - u0). Step: RowEnds::step, as a number that the compiler
/// knows or not.
template <class Weight, class Step>
struct LineTerm {
  double const *x0, *y0, *z0, *x1, *y1, *z1, *t;
  Weight weight;
  Step step;

  KOKKOS_INLINE_FUNCTION LineTerm(RowEnds const& row, Weight const& weight_, Step step_)
      : x0(row.e.x + row.lower),
        y0(row.e.y + row.lower),
        z0(row.e.z + row.lower),
        x1(x0 + row.section),
        y1(y0 + row.section),
        z1(z0 + row.section),
        t(row.t),
        weight(weight_),
        step(step_) {}

  KOKKOS_FORCEINLINE_FUNCTION Vec3 at(int w) const {
    auto const e = w * step;
    if constexpr (std::is_same_v<Weight, LawWeight<LineLaw::constant>>) {
      return {x0[e], y0[e], z0[e]};
    } else {
      double const f = weight(t[w]);
      return {x0[e] + f * (x1[e] - x0[e]), y0[e] + f * (y1[e] - y0[e]), z0[e] + f * (z1[e] - z0[e])};
    }
  }
};

/// Calls body(weight) with a law that the compiler knows; false where it is none of those that chains mostly have.
template <class Body>
KOKKOS_FORCEINLINE_FUNCTION bool with_law(LineLaw law, Body const& body) {
  if (law == LineLaw::linear)
    body(LawWeight<LineLaw::linear>());
  else if (law == LineLaw::c1)
    body(LawWeight<LineLaw::c1>());
  else if (law == LineLaw::constant)
    body(LawWeight<LineLaw::constant>());
  else
    return false;
  return true;
}

/// Whether rows of a chain have a term that can be fused.
KOKKOS_INLINE_FUNCTION bool can_fuse(LineLaw law, Index step) {
  return with_law(law, [](auto const&) {}) && (step == 0 || step == 1);
}

/// Whether the sum of two such terms can be. No plan has lines of two chains along one row, nor a second term that is
/// constant along its line: there are no loops for them.
KOKKOS_INLINE_FUNCTION bool can_fuse_both(Index step, LineLaw second, Index second_step) {
  return second != LineLaw::constant && (step != 0 || second_step != 0);
}

/// Calls body(term) with the law and the step known to the compiler. Precondition: can_fuse().
template <class Body>
KOKKOS_FORCEINLINE_FUNCTION void with_term(LineLaw law, RowEnds const& row, Body const& body) {
  with_law(law, [&](auto const& weight) {
    row.step == 0 ? body(LineTerm(row, weight, Constant<0>())) : body(LineTerm(row, weight, Constant<1>()));
  });
}

/// Every node is read before it is written, by no other: no iteration waits for another.
template <bool Move, class Value>
KOKKOS_FORCEINLINE_FUNCTION void write_row(FusedRow const& row, int n, Value const& value) {
  double const *const from_x = row.from_x, *const from_y = row.from_y, *const from_z = row.from_z;
  double *const x = row.x, *const y = row.y, *const z = row.z;
  GRIDMORPH_INDEPENDENT_LOOP
  for (int w = 0; w < n; ++w) {
    Vec3 const u = value(w);
    x[w] = Move ? moved(from_x[w], u.x) : u.x;
    y[w] = Move ? moved(from_y[w], u.y) : u.y;
    z[w] = Move ? moved(from_z[w], u.z) : u.z;
  }
}

/// Node w of n goes where value(w) moves it, or gets value(w).
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION void write_row(FusedRow const& row, bool moves, int n, Value const& value) {
  moves ? write_row<true>(row, n, value) : write_row<false>(row, n, value);
}

/// One term.
KOKKOS_INLINE_FUNCTION void write_fused(FusedRow const& row, bool moves, LineLaw law, RowEnds const& ends) {
  with_term(law, ends, [&](auto const& term) { write_row(row, moves, ends.n, [term](int w) { return term.at(w); }); });
}

/// The sum of two. Precondition: can_fuse_both().
KOKKOS_INLINE_FUNCTION void write_fused(FusedRow const& row, bool moves, LineLaw law, RowEnds const& ends,
                                        LineLaw second, RowEnds const& second_ends) {
  auto const write = [&](auto const& a, auto const& b) {
    write_row(row, moves, ends.n, [a, b](int w) { return a.at(w) + b.at(w); });
  };
  auto const of_second = [&](auto const& second_weight) {
    with_law(law, [&](auto const& weight) {
      LineTerm const across(second_ends, second_weight, Constant<1>());
      if (ends.step == 0)
        write(LineTerm(ends, weight, Constant<0>()), across);
      else if (second_ends.step == 0)
        write(LineTerm(ends, weight, Constant<1>()), LineTerm(second_ends, second_weight, Constant<0>()));
      else
        write(LineTerm(ends, weight, Constant<1>()), across);
    });
  };
  second == LineLaw::c1 ? of_second(LawWeight<LineLaw::c1>()) : of_second(LawWeight<LineLaw::linear>());
}

}  // namespace gridmorph::kernels
