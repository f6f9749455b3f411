// Transfinite correction of a line sweep where sides or edges of the chain are already known.
//
// On the four sides of a chain (0: a = 0, 1: a = n_a - 1, 2: b = 0, 3: b = n_b - 1) the residual
//
//   c = u_known - (line interpolant)
//
// is blended across the chain by the Boolean sum of Gordon and Hall (Int. J. Num. Meth. Eng. 7, 1973), dimension by
// dimension: first the four edges along s, then the four sides, then the volume
//
//   c(s,a,b) = (1-A) c0' + A c1' + (1-B) c2' + B c3' + (1-A)(1-B) e00 + A(1-B) e10 + (1-A)B e01 + AB e11
//
// with A, B the arc-length fractions across the chain, interpolated linearly along the line between its two ends, and
// c' the residual of a side beyond what its two edges give it, c' = c - (1-f) e_lower - f e_upper with f the fraction
// across that side. Where only opposite sides are known beyond their edges, this is their linear blend, c = (1-A) c0 +
// A c1.
//
// All values on the right are taken where the side lines and edges have the same fraction of *their* length as node
// (s, a, b) has of its line. (Not the same index: where a side is spaced evenly and the lines beside it are clustered
// at a wall, its residual would be pushed between the wall's first nodes.)
//
// What is unknown on an edge is filled linearly between the nearest known nodes (zero at the ends of the chain), what
// is unknown on a side by the same Boolean sum from its borders. With all residuals zero this is the plain sweep.
//
// Cost per node: one or two lookups in a side table where opposite sides are known, eight at most; each reads two
// parameters and two residuals, from cache. Volumes take whole rows at once (row_correction.hpp).
#pragma once

#include <gridmorph/kernels/field.hpp>

namespace gridmorph::kernels {

/// One side of a corrected chain. Line w of a side starts at first + n_s * w in the side arrays.
struct Side {
  std::int32_t chain;
  std::int32_t n_w;  ///< lines on it: n_b for sides 0 and 1, n_a for sides 2 and 3
  Index first;
  Index across = -1;  ///< where a second copy starts, node (p, w) at across + n_w * p + w; -1: there is none
};

/// Limits of a chain's blocks and what is known there. Block m lies between junctions m and m + 1.
struct Junction {
  std::int32_t position;       ///< on the lines
  std::uint32_t known_across;  ///< bit q: the edge across side q at this junction; bit 4 + e: corner e
  std::uint32_t known_along;   ///< block after this junction: bit q: face of side q; bit 4 + e: edge e along s
};

/// Edge e = (a at upper end ? 1 : 0) + (b at upper end ? 2 : 0). Each edge belongs to side 0/1 and side 2/3.
template <class MemorySpace>
struct SideTable {
  Kokkos::View<Side const*, MemorySpace> sides;          ///< four per corrected chain
  Kokkos::View<Junction const*, MemorySpace> junctions;  ///< n_blocks + 1 per corrected chain
  Kokkos::View<double const*, MemorySpace> t;            ///< arc-length fraction along s, per side node
  Kokkos::View<double const*, MemorySpace> per_t;        ///< 1 / (t(next) - t), 0 where they are equal
  Kokkos::View<double const*, MemorySpace> section;      ///< per chain (4, n_b, n_a): A at s = 0, A at s = 1, B, B
  Field<double const> c;                                 ///< residual per side node, chain frame

  /// Residual of line w of a side at fraction `t_line` of its length, linear between nodes. `guess`: the node of the
  /// side line that is tried first. Cost: two comparisons where it is right, a search away from it otherwise.
  KOKKOS_INLINE_FUNCTION Vec3 at(Chain const& chain, int side, int w, double t_line, int guess) const {
    Index const line = sides(chain.first_side + side).first + Index(chain.n_s) * w;
    if (t(line + guess) == t_line) return c[line + guess];
    int const lo = interval(line, chain.n_s - 1, t_line, guess);
    double const f = (t_line - t(line + lo)) * per_t(line + lo);
    return (1 - f) * c[line + lo] + f * c[line + lo + 1];
  }
  /// The largest p < last with t(line + p * along) <= t_line, found by steps that double away from the guess.
  KOKKOS_INLINE_FUNCTION int interval(Index line, int last, double t_line, int guess, Index along = 1) const {
    int lo = guess < last ? guess : last - 1, hi = lo + 1;
    int step = 1;
    if (t(line + lo * along) <= t_line) {
      while (hi < last && t(line + hi * along) <= t_line) {
        lo = hi;
        hi = hi + step < last ? hi + step : last;
        step *= 2;
      }
    } else {
      while (lo > 0 && t(line + lo * along) > t_line) {
        hi = lo;
        lo = lo - step > 0 ? lo - step : 0;
        step *= 2;
      }
    }
    while (hi - lo > 1) {
      int const mid = (lo + hi) / 2;
      (t(line + mid * along) <= t_line ? lo : hi) = mid;
    }
    return lo;
  }
  /// Arc-length fraction across the chain: direction 0 along a, 1 along b.
  KOKKOS_INLINE_FUNCTION double across(Chain const& chain, int direction, int a, int b, double t_line) const {
    Index const plane = Index(chain.n_a) * chain.n_b;
    Index const n = chain.first_section + 2 * direction * plane + a + Index(chain.n_a) * b;
    return (1 - t_line) * section(n) + t_line * section(n + plane);
  }
  KOKKOS_INLINE_FUNCTION Vec3 correction(Chain const& chain, int s, int a, int b, double t_line) const {
    auto side = [&](int q, int w) { return at(chain, q, w, t_line, s); };
    if (chain.blends_along(0)) {
      double const A = across(chain, 0, a, b, t_line);
      Vec3 sum;
      if (chain.side_matters(0)) sum += (1 - A) * side(0, b);
      if (chain.side_matters(1)) sum += A * side(1, b);
      return sum;
    }
    if (chain.blends_along(1)) {
      double const B = across(chain, 1, a, b, t_line);
      Vec3 sum;
      if (chain.side_matters(2)) sum += (1 - B) * side(2, a);
      if (chain.side_matters(3)) sum += B * side(3, a);
      return sum;
    }
    // Sides have what is beyond their edges, so that edges come in once, by the products of both shares.
    double const A = across(chain, 0, a, b, t_line), B = across(chain, 1, a, b, t_line);
    int const last_a = chain.n_a - 1, last_b = chain.n_b - 1;
    Vec3 sum;
    if (b > 0 && b < last_b) {
      if (chain.known_sides & 1u) sum += (1 - A) * side(0, b);
      if (chain.known_sides & 2u) sum += A * side(1, b);
    }
    if (a > 0 && a < last_a) {
      if (chain.known_sides & 4u) sum += (1 - B) * side(2, a);
      if (chain.known_sides & 8u) sum += B * side(3, a);
    }
    if (chain.known_sides & 16u) sum += ((1 - A) * (1 - B)) * side(0, 0);
    if (chain.known_sides & 32u) sum += (A * (1 - B)) * side(1, 0);
    if (chain.known_sides & 64u) sum += ((1 - A) * B) * side(0, last_b);
    if (chain.known_sides & 128u) sum += (A * B) * side(1, last_b);
    return sum;
  }
};

/// A line on a side of its chain.
struct SideLine {
  std::int32_t side;
  std::int32_t w;  ///< position of the line on the side
};

}  // namespace gridmorph::kernels
