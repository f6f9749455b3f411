// The transfinite correction (side_correction.hpp) for a row of nodes inside a chain at once.
//
// Along a row most side lines and all four edges stay the same, and where the row runs across the chain, so does the
// fraction t at which they are read, nearly: between two nodes of the side line, or on both sides of one. Then the
// residual is one or two linear functions of t, the row needs two searches per line instead of two per node, and the
// loop over its nodes has neither branches nor indices.
//
// Cost per node of a row across the chain: about 10 flops per line that stays, a lookup per line that does not (none
// where only opposite sides are known and the row runs from one to the other, two otherwise); of a row along the chain:
// a lookup per line, next to the one before.
#pragma once

#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/kernels/side_correction.hpp>

namespace gridmorph::kernels {

template <int width>
struct VectorRow {
  double x[width], y[width], z[width];
};

/// Nodes w = 0 ... n - 1 at (s + w ds, a + w da, b + w db) of a chain and fractions t[w] of their lines; none of them
/// on a side of the chain.
template <class MemorySpace, int width>
struct RowCorrection {
  SideTable<MemorySpace> const& table;
  Chain const& chain;
  int s, ds, a, da, b, db;
  double const* t;
  int n;

  /// v += correction, in the frame of the chain.
  GRIDMORPH_CALLED_ON_HOST KOKKOS_FUNCTION void add_to(VectorRow<width>& v) const {
    Range const range = range_of_t();
    double A[width], B[width], weight[width];
    if (chain.blends_along(0) || chain.blends_along(1)) {
      int const direction = chain.blends_along(0) ? 0 : 1;
      fractions(direction, A);
      for (int w = 0; w < n; ++w) weight[w] = 1 - A[w];
      if (chain.side_matters(2 * direction)) add_side(2 * direction, weight, range, v);
      if (chain.side_matters(2 * direction + 1)) add_side(2 * direction + 1, A, range, v);
      return;
    }
    fractions(0, A);
    fractions(1, B);
    unsigned const known = chain.known_sides;
    if (known & 1u) {
      for (int w = 0; w < n; ++w) weight[w] = 1 - A[w];
      add_side(0, weight, range, v);
    }
    if (known & 2u) add_side(1, A, range, v);
    if (known & 4u) {
      for (int w = 0; w < n; ++w) weight[w] = 1 - B[w];
      add_side(2, weight, range, v);
    }
    if (known & 8u) add_side(3, B, range, v);
    // Sides have what is beyond their edges, so that edges come in once, by the products of both shares.
    for (int e = 0; e < 4; ++e) {
      if (!((known >> (4 + e)) & 1u)) continue;
      bool const upper_a = (e & 1) != 0, upper_b = (e & 2) != 0;
      for (int w = 0; w < n; ++w) weight[w] = (upper_a ? A[w] : 1 - A[w]) * (upper_b ? B[w] : 1 - B[w]);
      add_line(line(upper_a ? 1 : 0, upper_b ? chain.n_b - 1 : 0), weight, range, v);
    }
  }

 private:
  struct Range {
    double least, largest;
  };
  /// The residual between two nodes of a side line.
  struct Piece {
    double t, per_t;
    Vec3 c, rise;
  };

  KOKKOS_INLINE_FUNCTION Range range_of_t() const {
    Range r{t[0], t[0]};
    for (int w = 1; w < n; ++w) {
      r.least = t[w] < r.least ? t[w] : r.least;
      r.largest = t[w] > r.largest ? t[w] : r.largest;
    }
    return r;
  }

  /// Arc-length fractions across the chain (SideTable::across) of all nodes.
  KOKKOS_INLINE_FUNCTION void fractions(int direction, double* fraction) const {
    Index const plane = chain.section_size();
    double const* const at_lower =
        table.section.data() + chain.first_section + 2 * direction * plane + a + Index(chain.n_a) * b;
    double const* const at_upper = at_lower + plane;
    Index const step = da + Index(chain.n_a) * db;
    if (step == 0)
      for (int w = 0; w < n; ++w) fraction[w] = (1 - t[w]) * at_lower[0] + t[w] * at_upper[0];
    else if (step == 1)
      for (int w = 0; w < n; ++w) fraction[w] = (1 - t[w]) * at_lower[w] + t[w] * at_upper[w];
    else
      for (int w = 0; w < n; ++w) fraction[w] = (1 - t[w]) * at_lower[w * step] + t[w] * at_upper[w * step];
  }

  [[nodiscard]] KOKKOS_INLINE_FUNCTION Index line(int side, int w) const {
    return table.sides(chain.first_side + side).first + Index(chain.n_s) * w;
  }

  KOKKOS_INLINE_FUNCTION void add_side(int side, double const* weight, Range const& range, VectorRow<width>& v) const {
    int const first = side < 2 ? b : a, step = side < 2 ? db : da;
    if (step == 0) return add_line(line(side, first), weight, range, v);
    Index at = line(side, first);
    int guess = s;
    for (int w = 0; w < n; ++w, at += Index(chain.n_s) * step) add_node(at, w, weight, guess, v);
  }

  /// Adds the correction of a side where the whole row has one line of it.
  KOKKOS_INLINE_FUNCTION void add_line(Index at, double const* weight, Range const& range, VectorRow<width>& v) const {
    int const last = chain.n_s - 1;
    int const lower = table.interval(at, last, range.least, s);
    int const upper = ds == 0 ? table.interval(at, last, range.largest, lower) : last;
    if (upper - lower > 1) {
      int guess = s;
      for (int w = 0; w < n; ++w) add_node(at, w, weight, guess, v);
      return;
    }
    Piece const p = piece(at + lower), q = piece(at + upper);
    for (int w = 0; w < n; ++w) {
      bool const in_upper = t[w] >= q.t;
      double const f = (t[w] - (in_upper ? q.t : p.t)) * (in_upper ? q.per_t : p.per_t);
      v.x[w] += weight[w] * ((in_upper ? q.c.x : p.c.x) + f * (in_upper ? q.rise.x : p.rise.x));
      v.y[w] += weight[w] * ((in_upper ? q.c.y : p.c.y) + f * (in_upper ? q.rise.y : p.rise.y));
      v.z[w] += weight[w] * ((in_upper ? q.c.z : p.c.z) + f * (in_upper ? q.rise.z : p.rise.z));
    }
  }

  /// A node that looks for its place on a line by itself, from where the one before found its own.
  KOKKOS_INLINE_FUNCTION void add_node(Index at, int w, double const* weight, int& guess, VectorRow<width>& v) const {
    guess = table.interval(at, chain.n_s - 1, t[w], guess);
    Piece const p = piece(at + guess);
    double const f = (t[w] - p.t) * p.per_t;
    v.x[w] += weight[w] * (p.c.x + f * p.rise.x);
    v.y[w] += weight[w] * (p.c.y + f * p.rise.y);
    v.z[w] += weight[w] * (p.c.z + f * p.rise.z);
  }

  [[nodiscard]] KOKKOS_INLINE_FUNCTION Piece piece(Index at) const {
    Vec3 const c = table.c[at];
    return {table.t(at), table.per_t(at), c, table.c[at + 1] - c};
  }
};

}  // namespace gridmorph::kernels
