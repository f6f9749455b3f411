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
  double const *from_x, *from_y, *from_z;
  double *x, *y, *z;
  int n;
};

/// What a line gives to node w of a row.
template <LineLaw law, int step>
struct FusedTerm {
  double const *x0, *y0, *z0, *x1, *y1, *z1, *t;

  KOKKOS_INLINE_FUNCTION explicit FusedTerm(RowEnds const& row)
      : x0(row.e.x + row.lower),
        y0(row.e.y + row.lower),
        z0(row.e.z + row.lower),
        x1(x0 + row.section),
        y1(y0 + row.section),
        z1(z0 + row.section),
        t(row.t) {}

  KOKKOS_FORCEINLINE_FUNCTION Vec3 at(int w) const {
    int const e = w * step;
    if constexpr (law == LineLaw::constant) {
      return {x0[e], y0[e], z0[e]};
    } else {
      double const f = law == LineLaw::c1 ? t[w] * t[w] * (3 - 2 * t[w]) : t[w];
      return {x0[e] + f * (x1[e] - x0[e]), y0[e] + f * (y1[e] - y0[e]), z0[e] + f * (z1[e] - z0[e])};
    }
  }
};

/// Whether rows of a chain have such a term.
KOKKOS_INLINE_FUNCTION bool can_fuse(LineLaw law, Index step) {
  return (law == LineLaw::linear || law == LineLaw::c1 || law == LineLaw::constant) && (step == 0 || step == 1);
}

namespace fused {

/// Calls body(term) with the law and the step known to the compiler.
template <class Body>
KOKKOS_FORCEINLINE_FUNCTION void with_term(LineLaw law, RowEnds const& row, Body const& body) {
  auto const of_law = [&]<LineLaw of>() { row.step == 0 ? body(FusedTerm<of, 0>(row)) : body(FusedTerm<of, 1>(row)); };
  if (law == LineLaw::constant)
    of_law.template operator()<LineLaw::constant>();
  else if (law == LineLaw::c1)
    of_law.template operator()<LineLaw::c1>();
  else
    of_law.template operator()<LineLaw::linear>();
}

/// Every node is read before it is written, by no other: no iteration waits for another.
template <bool Move, class Value>
KOKKOS_FORCEINLINE_FUNCTION void write(FusedRow const& row, Value const& value) {
  double const *const from_x = row.from_x, *const from_y = row.from_y, *const from_z = row.from_z;
  double *const x = row.x, *const y = row.y, *const z = row.z;
  int const n = row.n;
  GRIDMORPH_INDEPENDENT_LOOP
  for (int w = 0; w < n; ++w) {
    Vec3 const u = value(w);
    x[w] = Move ? moved(from_x[w], u.x) : u.x;
    y[w] = Move ? moved(from_y[w], u.y) : u.y;
    z[w] = Move ? moved(from_z[w], u.z) : u.z;
  }
}

}  // namespace fused

/// One term. Precondition: can_fuse().
template <bool Move>
KOKKOS_INLINE_FUNCTION void write_fused(FusedRow const& row, LineLaw law, RowEnds const& ends) {
  fused::with_term(law, ends, [&](auto const& term) { fused::write<Move>(row, [term](int w) { return term.at(w); }); });
}

/// The sum of two.
template <bool Move>
KOKKOS_INLINE_FUNCTION void write_fused(FusedRow const& row, LineLaw law, RowEnds const& ends, LineLaw second,
                                        RowEnds const& second_ends) {
  fused::with_term(law, ends, [&](auto const& a) {
    fused::with_term(second, second_ends,
                     [&](auto const& b) { fused::write<Move>(row, [a, b](int w) { return a.at(w) + b.at(w); }); });
  });
}

}  // namespace gridmorph::kernels
