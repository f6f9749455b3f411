// Grid lines as plain data: which nodes follow one another, and who writes them.
//
// A chain is one cuboid of nodes (s, a, b): s along the grid lines, a and b across. It is cut into tubes (one piece of
// a zone across), a tube into segments (one piece of a zone along). A line is one (a, b) of a tube; it runs through all
// segments of the tube. Everything is flat and trivially copyable, so that one launch can take any set of independent
// lines from all zones of a mesh.
#pragma once

#include <Kokkos_Core.hpp>

#include <cstdint>

namespace gridmorph::kernels {

using Index = std::int64_t;

/// Nodes of one piece of a zone along the lines of a tube. Node (s, a, b) of the segment is
/// first + s * stride_s + a * stride_a + b * stride_b; the last node of a segment coincides with the first of the next.
struct Segment {
  Index first;
  Index stride_s, stride_a, stride_b;
  std::int32_t count;       ///< nodes along the line, both ends included (>= 2)
  std::int32_t begin;       ///< position of the first node on the chain's lines
  std::int32_t target[27];  ///< cs + 3 (ca + 3 cb): where the line parameters of the nodes at the lower end (0), inside
                            ///< (1) or at the upper end (2) of the segment along s, a, b go; -1: not needed
};

/// Where line parameters are kept: node (s, a, b) of a segment at first + s * stride_s + a * stride_a + b * stride_b.
struct ParameterTarget {
  Index first;
  Index stride_s, stride_a, stride_b;
};

struct Tube {
  std::int32_t chain;
  std::int32_t a_begin, b_begin;  ///< position of the tube in the chain's cross-section
  std::int32_t n_a, n_b;          ///< nodes across, both sides included
  std::int32_t first_segment, n_segments;
};

/// How displacement varies along a line, as a function of the fraction of its baseline arc length.
enum class LineLaw : std::int32_t { linear, c1, c2, constant, cubic, table };

/// How rotations of the ends of a line fade along it: see turned_line.hpp.
enum class TurnLaw : std::int32_t { none, near_field, square, c1, far, common };

struct Chain {
  std::int32_t n_s, n_a, n_b;  ///< nodes
  LineLaw law;
  std::int32_t open_end;        ///< the last node of the lines is not known and is written too (constant law)
  std::int32_t first_side;      ///< in the side tables, -1: no side is known, plain sweep
  std::int32_t first_junction;  ///< of the correction's block limits
  std::int32_t n_blocks;
  std::uint32_t known_sides;      ///< bit q: side q is known somewhere beyond its edges; bit 4 + e: edge e along s is
  Index first_end_value;          ///< where the displacements of the chain's two ends start: (2, n_b, n_a), chain frame
  Index first_section;            ///< correction: where the chain's cross-section parameters start
  TurnLaw turn = TurnLaw::none;   ///< none: its ends carry no rotation
  std::uint32_t turned_ends = 0;  ///< bit 0: the first end carries one; bit 1: the last
  double slope[2] = {1, 1};       ///< cubic: dw/dt at the two ends
  std::int32_t first_knot = 0;    ///< table: see table_weight()
  std::int32_t n_intervals = 0;
  double turn_reach = 0;  ///< TurnLaw::far: length of its lines over the size of the body
  double turn_scale = 0;  ///< TurnLaw::far: see turned_line.hpp

  /// Whether anything asks for the arc lengths of its lines.
  [[nodiscard]] KOKKOS_INLINE_FUNCTION bool has_parameters() const {
    return law != LineLaw::constant || first_side >= 0 || turn != TurnLaw::none;
  }
  /// Whether of the sides only the two across a (direction 0) or across b (1) are known beyond their edges.
  [[nodiscard]] KOKKOS_INLINE_FUNCTION bool blends_along(int direction) const {
    unsigned const across_a = known_sides & 3u, across_b = known_sides & 12u;
    return direction == 0 ? across_a != 0 && across_b == 0 : across_b != 0 && across_a == 0;
  }
  /// Whether a side or one of its edges is known anywhere.
  [[nodiscard]] KOKKOS_INLINE_FUNCTION bool side_matters(int q) const {
    unsigned const edges[4] = {1u | 4u, 2u | 8u, 1u | 2u, 4u | 8u};
    return ((known_sides >> q) & 1u) != 0 || ((known_sides >> 4) & edges[q]) != 0;
  }
  KOKKOS_INLINE_FUNCTION Index section_size() const { return Index(n_a) * n_b; }
};

/// Category of position p among n nodes: 0 at the lower end, 2 at the upper end, 1 inside.
KOKKOS_INLINE_FUNCTION int end_category(int p, int n) { return p == 0 ? 0 : (p == n - 1 ? 2 : 1); }

/// Weight of the far end at fraction s of the arc length; 0 at s = 0 and 1 at s = 1.
KOKKOS_INLINE_FUNCTION double law_weight(LineLaw law, double s) {
  switch (law) {
    case LineLaw::linear: return s;
    case LineLaw::c1: return s * s * (3 - 2 * s);
    case LineLaw::c2: return s * s * s * (10 + s * (6 * s - 15));
    case LineLaw::constant: return 0;
    case LineLaw::cubic:
    case LineLaw::table: break;  // have numbers of their own
  }
  return s;
}

/// The cubic with slopes a and b at its ends (Hermite): linear where both are 1, c1 where both are 0.
KOKKOS_INLINE_FUNCTION double cubic_weight(double a, double b, double s) {
  double const r = 1 - s;
  return s * s * (3 - 2 * s) + s * r * (a * r - b * s);
}

/// Where a law is given by its values and slopes at n + 1 knots s = m / n: the cubic between two of them (Hermite).
/// knots: w and (dw/ds) / n of each, one after another.
KOKKOS_INLINE_FUNCTION double table_weight(double const* knots, int n, double s) {
  double const place = s * n;
  int const m = place < n - 1 ? int(place) : n - 1;
  double const* const k = knots + 2 * m;
  double const f = place - m, r = 1 - f;
  return k[0] + f * f * (3 - 2 * f) * (k[2] - k[0]) + f * r * (k[1] * r - k[3] * f);
}

/// knots: of all laws that are tables.
KOKKOS_INLINE_FUNCTION double law_weight(Chain const& chain, double const* knots, double s) {
  if (chain.law == LineLaw::cubic) return cubic_weight(chain.slope[0], chain.slope[1], s);
  if (chain.law == LineLaw::table) return table_weight(knots + chain.first_knot, chain.n_intervals, s);
  return law_weight(chain.law, s);
}

}  // namespace gridmorph::kernels
