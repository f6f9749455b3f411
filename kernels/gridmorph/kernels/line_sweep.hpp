// Displacement along grid lines from the values at their ends: the core of the volume morph.
//
//   u(s) = (1 - w(t)) u0 + w(t) u1 + c(s, a, b),   t = arc length to node s / length of the baseline line
//
// (paper, section 3: "one simply interpolates along the grid line using a chosen distribution law, the simplest one being
// linear interpolation by grid line length"). c is the transfinite correction of side_correction.hpp; it is absent where
// no side of the chain is known. Lines of zero length (poles) use the node count instead of the arc length.
//
// Each line is summed by one work item in node order, so results do not depend on the execution space or thread count.
// Cost per node: reads 24 bytes of coordinates (twice, the second time from cache), writes 24 bytes of displacement.
#pragma once

#include <gridmorph/kernels/field.hpp>
#include <gridmorph/kernels/side_correction.hpp>

namespace gridmorph::kernels {

/// Device arrays that describe a set of independent lines.
template <class MemorySpace>
struct LineTable {
  Kokkos::View<Chain const*, MemorySpace> chains;
  Kokkos::View<Tube const*, MemorySpace> tubes;
  Kokkos::View<Segment const*, MemorySpace> segments;
  Kokkos::View<Index const*, MemorySpace> first_line;  ///< per tube, and one past the last
  Kokkos::View<Mat3 const*, MemorySpace> rotations;
  Index n_lines = 0;

  /// The tube of a line, by bisection.
  KOKKOS_INLINE_FUNCTION int tube_of(Index line) const {
    int lo = 0, hi = int(tubes.extent(0));
    while (hi - lo > 1) {
      int const mid = (lo + hi) / 2;
      if (first_line(mid) <= line) {
        lo = mid;
      } else {
        hi = mid;
      }
    }
    return lo;
  }
};

/// One line of a tube: walks its nodes in order.
template <class MemorySpace>
struct LineCursor {
  LineTable<MemorySpace> const& table;
  Tube tube;
  int a, b;

  KOKKOS_INLINE_FUNCTION LineCursor(LineTable<MemorySpace> const& t, Index line) : table(t), tube{}, a(0), b(0) {
    int const number = t.tube_of(line);
    tube = t.tubes(number);
    Index const local = line - t.first_line(number);
    a = int(local % tube.n_a);
    b = int(local / tube.n_a);
  }
  KOKKOS_INLINE_FUNCTION Segment const& segment(int m) const { return table.segments(tube.first_segment + m); }
  KOKKOS_INLINE_FUNCTION Index start(Segment const& s) const { return s.first + a * s.stride_a + b * s.stride_b; }
  KOKKOS_INLINE_FUNCTION Index first_node() const { return start(segment(0)); }
  KOKKOS_INLINE_FUNCTION Index last_node() const {
    Segment const& s = segment(tube.n_segments - 1);
    return start(s) + (s.count - 1) * s.stride_s;
  }
  /// Bits cs = 0, 1, 2 of a segment's write mask for this line.
  KOKKOS_INLINE_FUNCTION unsigned writes(Segment const& s) const {
    return (s.write_mask >> (3 * (end_category(a, tube.n_a) + 3 * end_category(b, tube.n_b)))) & 7u;
  }
  KOKKOS_INLINE_FUNCTION Vec3 to_chain_frame(Segment const& s, Vec3 const& v) const {
    return s.rotation < 0 ? v : transpose(table.rotations(s.rotation)) * v;
  }
  KOKKOS_INLINE_FUNCTION Vec3 from_chain_frame(Segment const& s, Vec3 const& v) const {
    return s.rotation < 0 ? v : table.rotations(s.rotation) * v;
  }
  /// Baseline arc length of the whole line.
  KOKKOS_INLINE_FUNCTION double length(Field<double const> const& x) const {
    double total = 0;
    for (int m = 0; m < tube.n_segments; ++m) {
      Segment const& s = segment(m);
      Index n = start(s);
      Vec3 previous = x[n];
      for (int k = 1; k < s.count; ++k) {
        n += s.stride_s;
        Vec3 const here = x[n];
        total += distance(previous, here);
        previous = here;
      }
    }
    return total;
  }
};

/// Calls visit(node, segment, position on the line, fraction of the arc length, category cs) for every node of a line;
/// nodes where segments meet are visited once per segment.
template <class MemorySpace, class Visit>
KOKKOS_INLINE_FUNCTION void walk_line(LineCursor<MemorySpace> const& line, Field<double const> const& x, int n_s,
                                      Visit const& visit) {
  double const total = line.length(x);
  double const per_length = total > 0 ? 1 / total : 0;
  double const per_node = 1 / double(n_s - 1);
  double done = 0;
  for (int m = 0; m < line.tube.n_segments; ++m) {
    Segment const& s = line.segment(m);
    bool const last = m == line.tube.n_segments - 1;
    Index n = line.start(s);
    Vec3 previous = x[n];
    for (int k = 0; k < s.count; ++k) {
      if (k > 0) {
        n += s.stride_s;
        Vec3 const here = x[n];
        done += distance(previous, here);
        previous = here;
      }
      double t = total > 0 ? done * per_length : (s.begin + k) * per_node;
      if (last && k == s.count - 1) t = 1;
      visit(n, s, s.begin + k, t, end_category(k, s.count));
    }
  }
}

/// u on every written node of the line, from u at its first and last node.
template <class MemorySpace>
struct LineSweep {
  LineTable<MemorySpace> lines;
  SideTable<MemorySpace> sides;
  Field<double const> x;
  Field<double> u;

  KOKKOS_INLINE_FUNCTION void operator()(Index item) const {
    LineCursor<MemorySpace> const line(lines, item);
    Chain const& chain = lines.chains(line.tube.chain);
    Segment const& back = line.segment(line.tube.n_segments - 1);
    Vec3 const u0 = line.to_chain_frame(line.segment(0), u[line.first_node()]);
    Vec3 const u1 = chain.open_end ? u0 : line.to_chain_frame(back, u[line.last_node()]);
    Vec3 const du = u1 - u0;
    int const a = line.tube.a_begin + line.a, b = line.tube.b_begin + line.b;
    walk_line(line, x, chain.n_s, [&](Index n, Segment const& s, int position, double t, int category) {
      if (!((line.writes(s) >> category) & 1u)) return;
      Vec3 v = u0 + law_weight(chain.law, t) * du;
      if (chain.first_side >= 0) v += sides.correction(chain, position, a, b, t);
      u.set(n, line.from_chain_frame(s, v));
    });
  }
};

/// Adds the spread of end values to u: u += (1 - w) d0 + w d1. The end values d of a chain are compact arrays:
/// (2, n_b, n_a) from chain.first_end_value on, in the chain's frame.
template <class MemorySpace>
struct LineSpread {
  LineTable<MemorySpace> lines;
  Field<double const> end_values;
  Field<double const> x;
  Field<double> u;

  KOKKOS_INLINE_FUNCTION void operator()(Index item) const {
    LineCursor<MemorySpace> const line(lines, item);
    Chain const& chain = lines.chains(line.tube.chain);
    Index const section = Index(chain.n_a) * chain.n_b;
    Index const at =
        chain.first_end_value + (line.tube.a_begin + line.a) + Index(chain.n_a) * (line.tube.b_begin + line.b);
    Vec3 const d0 = end_values[at], d1 = end_values[at + section];
    if (d0 == Vec3{} && d1 == Vec3{}) return;
    walk_line(line, x, chain.n_s, [&](Index n, Segment const& s, int, double t, int category) {
      if (!((line.writes(s) >> category) & 1u)) return;
      double const w = law_weight(chain.law, t);
      u.set(n, u[n] + line.from_chain_frame(s, (1 - w) * d0 + w * d1));
    });
  }
};

}  // namespace gridmorph::kernels
