// Transpose of the correction of line sweeps: side_correction.hpp, and the residuals of side_residual.hpp in reverse.
//
// What side line w of a side gives to the chain is read by the nodes (s, a, w) or (s, w, b) of one slab of it, so one
// work item has the slab and the line to itself; on GPUs it has a share of the slab and a copy of the line, and copies
// are added up after. The four edges are read by all nodes of the chain: each slab across b adds up its own part, and
// the parts are added up after. Sums come in one order whatever the number of threads.
//
// Cost per node of a chain whose sides are known: 32 bytes read and one or two lookups in a side table for each of the
// two directions across that its correction blends; nothing is written but on sides.
#pragma once

#include <gridmorph/kernels/side_residual.hpp>
#include <gridmorph/kernels/transposed_lines.hpp>
#include <gridmorph/kernels/volume_pass.hpp>

namespace gridmorph::kernels {

/// A slab of a corrected chain: b == w (direction 0, for sides 0 and 1), or a == w (direction 1, for sides 2 and 3).
struct SideSlab {
  std::int32_t chain, direction, w;
  std::int32_t first_group, n_groups;  ///< of the chain
  Index edges = -1;                    ///< where its parts of the four edges start, (4, n_s); -1: it has none
};

/// How many shares a long sum is made in: on GPUs enough to keep them busy.
template <class Exec>
inline constexpr int shares_of_sums = TileShape<Exec>::host ? 1 : 32;

/// Sums in the making: one of `of` per share of what is added up, from the side node `first` on.
struct SumShares {
  FieldBatch<double> of;
  Index first = 0;
};

/// to(first + n) += the shares of n, from `begin` on, one after another.
template <int Shares>
struct AddShares {
  SumShares from;
  int begin;
  Field<double> to;

  KOKKOS_INLINE_FUNCTION void operator()(Index n) const {
    Vec3 sum = to[from.first + n];
    for (int share = begin; share < Shares; ++share) sum += from.of[share][n];
    to.set(from.first + n, sum);
  }
};

/// The part of n things, from the first to the one past the last, that a share has.
template <int Shares>
struct ShareRange {
  int begin, end;
  KOKKOS_INLINE_FUNCTION ShareRange(int n, int share)
      : begin(int(Index(n) * share / Shares)), end(int(Index(n) * (share + 1) / Shares)) {}
};

/// Gradients of the values that SideTable::at() reads, `g` that of what it gives.
template <class MemorySpace>
KOKKOS_INLINE_FUNCTION void add_at(SideTable<MemorySpace> const& table, Chain const& chain, Index line, double t_line,
                                   int guess, Vec3 const& g, Field<double> const& to, Index to_line) {
  if (table.t(line + guess) == t_line) {
    to.set(to_line + guess, to[to_line + guess] + g);
    return;
  }
  int const lo = table.interval(line, chain.n_s - 1, t_line, guess);
  double const f = (t_line - table.t(line + lo)) * table.per_t(line + lo);
  to.set(to_line + lo, to[to_line + lo] + (1 - f) * g);
  to.set(to_line + lo + 1, to[to_line + lo + 1] + f * g);
}

template <class MemorySpace>
KOKKOS_INLINE_FUNCTION Index side_line(SideTable<MemorySpace> const& table, Chain const& chain, int q, int w) {
  return table.sides(chain.first_side + q).first + Index(chain.n_s) * w;
}

/// The gradients of side nodes from those of what the correction gives the nodes of a slab. One item per slab and
/// share.
template <class MemorySpace, int Shares>
struct SideGradients {
  Kokkos::View<SideSlab const*, MemorySpace> slabs;
  Kokkos::View<LineGroup const*, MemorySpace> groups;
  Kokkos::View<Chain const*, MemorySpace> chains;
  SideTable<MemorySpace> sides;
  BundleGradients<MemorySpace> from;
  SumShares c;               ///< per side node
  FieldBatch<double> edges;  ///< parts

  [[nodiscard]] Index size() const { return Index(slabs.extent(0)) * Shares; }
  KOKKOS_INLINE_FUNCTION void operator()(Index item) const {
    SideSlab const& slab = slabs(item / Shares);
    int const share = int(item % Shares);
    Chain const& chain = chains(slab.chain);
    for (int m = 0; m < slab.n_groups; ++m) {
      LineGroup const& group = groups(slab.first_group + m);
      int const first = slab.direction == 0 ? group.b : group.a, n = slab.direction == 0 ? group.n_b : group.n_a;
      if (slab.w < first || slab.w >= first + n) continue;
      ShareRange<Shares> const along(slab.direction == 0 ? group.n_a : group.n_b, share);
      for (int p = 0; p < group.n_bundles; ++p) {
        LineBundle const& bundle = from.bundles(group.first_bundle + p);
        for (int s = 0; s < bundle.n_s; ++s)
          for (int k = along.begin; k < along.end; ++k)
            add(share, slab, chain, bundle, s, slab.direction == 0 ? k : slab.w - first,
                slab.direction == 0 ? slab.w - first : k, group);
      }
    }
  }

 private:
  /// Node (s, a, b) counted from the first of its bundle.
  KOKKOS_INLINE_FUNCTION void add(int share, SideSlab const& slab, Chain const& chain, LineBundle const& bundle, int s,
                                  int a, int b, LineGroup const& group) const {
    Vec3 const g = from.gradient(bundle, s, a, b);
    double const t = from.parameter(bundle, s, a, b);
    int const on_a = group.a + a, on_b = group.b + b, on_s = bundle.s + s;
    bool const across_a = slab.direction == 0, one_pair = chain.blends_along(0) || chain.blends_along(1);
    if (one_pair && !chain.blends_along(slab.direction)) return;
    double const own = sides.across(chain, slab.direction, on_a, on_b, t);
    int const q = across_a ? 0 : 2, n_w = across_a ? chain.n_b : chain.n_a;
    bool const inside = slab.w > 0 && slab.w < n_w - 1;
    for (int m = 0; m < 2; ++m) {
      bool const counts = one_pair ? chain.side_matters(q + m) : inside && ((chain.known_sides >> (q + m)) & 1u) != 0;
      if (!counts) continue;
      Index const line = side_line(sides, chain, q + m, slab.w);
      add_at(sides, chain, line, t, on_s, (m == 0 ? 1 - own : own) * g, c.of[share], line - c.first);
    }
    if (one_pair || !across_a || (chain.known_sides >> 4) == 0) return;
    double const B = sides.across(chain, 1, on_a, on_b, t);
    for (int e = 0; e < 4; ++e) {
      if (((chain.known_sides >> (4 + e)) & 1u) == 0) continue;
      double const weight = (e % 2 == 0 ? 1 - own : own) * (e / 2 == 0 ? 1 - B : B);
      add_at(sides, chain, side_line(sides, chain, e % 2, e / 2 == 0 ? 0 : chain.n_b - 1), t, on_s, weight * g,
             edges[share], slab.edges + e * Index(chain.n_s));
    }
  }
};

/// The parts of the edges, added up: one item per corrected chain and edge.
template <class MemorySpace>
struct EdgeSums {
  Kokkos::View<Chain const*, MemorySpace> chains;
  SideTable<MemorySpace> sides;
  Kokkos::View<std::int32_t const*, MemorySpace> corrected;
  Kokkos::View<Index const*, MemorySpace> first_part;  ///< per corrected chain: of slab b == 0, or -1
  Field<double const> edges;
  Field<double> c;

  [[nodiscard]] Index size() const { return 4 * Index(corrected.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index item) const {
    Chain const& chain = chains(corrected(item / 4));
    int const e = int(item % 4);
    Index const first = first_part(item / 4);
    if (first < 0 || ((chain.known_sides >> (4 + e)) & 1u) == 0) return;
    Index const line = side_line(sides, chain, e % 2, e / 2 == 0 ? 0 : chain.n_b - 1);
    for (int p = 0; p < chain.n_s; ++p) {
      Vec3 sum = c[line + p];
      for (int b = 0; b < chain.n_b; ++b) sum += edges[first + (4 * Index(b) + e) * chain.n_s + p];
      c.set(line + p, sum);
    }
  }
};

/// Transpose of SideFill along each side line: gradients of known nodes and junctions in c, those of what lies between
/// the side's two edges in `between`. One item per side line; nothing is done on edges.
template <class MemorySpace>
struct SideFillBack {
  Kokkos::View<Chain const*, MemorySpace> chains;
  SideTable<MemorySpace> sides;
  Kokkos::View<SideLine const*, MemorySpace> side_lines;
  Field<double> c, between;

  [[nodiscard]] Index size() const { return Index(side_lines.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index item) const {
    SideLine const& on = side_lines(item);
    Side const& side = sides.sides(on.side);
    if (end_category(on.w, side.n_w) != 1) return;
    Chain const& chain = chains(side.chain);
    int const q = on.side - chain.first_side;
    Index const line = side.first + Index(chain.n_s) * on.w;
    auto const known = KnownLine<MemorySpace>::of(sides, chain, q, side.n_w, on.w);
    bool const beyond_edges = wants_beyond_edges(chain);
    for (int p = 0; p < chain.n_s; ++p) between.set(line + p, beyond_edges ? -c[line + p] : Vec3{});
    auto const add = [](Field<double> const& to, Index n, Vec3 const& v) { to.set(n, to[n] + v); };
    for (int m = 0; m < chain.n_blocks; ++m) {
      Junction const& j = sides.junctions(chain.first_junction + m);
      if ((j.known_along >> q) & 1u) continue;
      int const p0 = j.position, p1 = sides.junctions(chain.first_junction + m + 1).position;
      double const t0 = sides.t(line + p0), t1 = sides.t(line + p1);
      Vec3 r0, r1;
      for (int p = p0 + 1; p < p1; ++p) {
        double const f = t1 > t0 ? (sides.t(line + p) - t0) / (t1 - t0) : double(p - p0) / (p1 - p0);
        Vec3 const g = c[line + p];
        add(between, line + p, g);
        r0 += (1 - f) * g;
        r1 += f * g;
        c.set(line + p, {});
      }
      add(c, line + p0, r0);
      add(c, line + p1, r1);
      add(between, line + p0, -r0);
      add(between, line + p1, -r1);
    }
    for (int m = 0; m <= chain.n_blocks; ++m) {
      int const p = sides.junctions(chain.first_junction + m).position;
      if (known.is_known(p)) continue;
      add(between, line + p, c[line + p]);
      c.set(line + p, {});
    }
  }
};

/// Gradients of a side's two edges, from `between`. One item per corrected chain, side, edge and share.
template <class MemorySpace, int Shares>
struct SideEdgesBack {
  Kokkos::View<Chain const*, MemorySpace> chains;
  SideTable<MemorySpace> sides;
  Kokkos::View<std::int32_t const*, MemorySpace> corrected;
  Field<double const> between;
  SumShares c;

  [[nodiscard]] Index size() const { return 8 * Index(corrected.extent(0)) * Shares; }
  KOKKOS_INLINE_FUNCTION void operator()(Index number) const {
    Index const item = number / Shares;
    int const share = int(number % Shares);
    Chain const& chain = chains(corrected(item / 8));
    int const q = int(item / 2 % 4), upper = int(item % 2);
    Side const& side = sides.sides(chain.first_side + q);
    Index const edge = side.first + Index(chain.n_s) * (upper == 0 ? 0 : side.n_w - 1);
    if (side.n_w < 3) return;
    ShareRange<Shares> const inside(side.n_w - 2, share);
    for (int w = 1 + inside.begin; w < 1 + inside.end; ++w) {
      Index const line = side.first + Index(chain.n_s) * w;
      int const a = q == 0 ? 0 : (q == 1 ? chain.n_a - 1 : w), b = q == 2 ? 0 : (q == 3 ? chain.n_b - 1 : w);
      for (int p = 0; p < chain.n_s; ++p) {
        double const t = sides.t(line + p), f = sides.across(chain, q < 2 ? 1 : 0, a, b, t);
        add_at(sides, chain, edge, t, p, (upper == 0 ? 1 - f : f) * between[line + p], c.of[share], edge - c.first);
      }
    }
  }
};

/// Transpose of SideResidual on edges: of the known nodes of the four edges along s, in sides 0 and 1; their copies in
/// sides 2 and 3 end at zero.
template <class MemorySpace>
struct EdgeFillBack {
  Kokkos::View<Chain const*, MemorySpace> chains;
  SideTable<MemorySpace> sides;
  Kokkos::View<std::int32_t const*, MemorySpace> corrected;
  Field<double> c;

  [[nodiscard]] Index size() const { return 4 * Index(corrected.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index item) const {
    Chain const& chain = chains(corrected(item / 4));
    int const e = int(item % 4), q = e % 2, n_w = sides.sides(chain.first_side + q).n_w;
    int const w = e / 2 == 0 ? 0 : n_w - 1;
    Index const at = side_line(sides, chain, q, w);
    Index const there = side_line(sides, chain, 2 + e / 2, e % 2 == 0 ? 0 : chain.n_a - 1);
    for (int p = 0; p < chain.n_s; ++p) {
      c.set(at + p, c[at + p] + c[there + p]);
      c.set(there + p, {});
    }
    auto const fill = [&](int from, int to, bool open) {
      double const t0 = sides.t(at + from), t1 = sides.t(at + to);
      Vec3 first, last;
      for (int p = from + 1; p < (open ? to + 1 : to); ++p) {
        double const f = open ? 0 : t1 > t0 ? (sides.t(at + p) - t0) / (t1 - t0) : double(p - from) / (to - from);
        first += (1 - f) * c[at + p];
        last += f * c[at + p];
        c.set(at + p, {});
      }
      c.set(at + from, c[at + from] + first);
      if (!open) c.set(at + to, c[at + to] + last);
    };
    auto const line = KnownLine<MemorySpace>::of(sides, chain, q, n_w, w);
    int known = 0;
    for (int p = 1; p < chain.n_s; ++p)
      if (line.is_known(p)) {
        if (p > known + 1) fill(known, p, false);
        known = p;
      }
    if (known < chain.n_s - 1) fill(known, chain.n_s - 1, true);
  }
};

/// Transpose of SideResidual at known nodes: c ends as gradients of the displacements of known nodes; what the residual
/// takes off for the line goes to its ends. One item per side line; of the edges those in sides 0 and 1.
template <class MemorySpace>
struct SideResidualBack {
  Kokkos::View<Chain const*, MemorySpace> chains;
  SideTable<MemorySpace> sides;
  Kokkos::View<SideLine const*, MemorySpace> side_lines;
  Field<double> c;
  double const* law_knots;
  TurnedEnds<double const> ends;
  Field<double const> side_position;
  EndGradients to;

  [[nodiscard]] Index size() const { return Index(side_lines.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index item) const {
    SideLine const& on = side_lines(item);
    Side const& side = sides.sides(on.side);
    Chain const& chain = chains(side.chain);
    int const q = on.side - chain.first_side;
    if (q >= 2 && end_category(on.w, side.n_w) != 1) return;  // all zero
    int const a = q < 2 ? (q == 0 ? 0 : chain.n_a - 1) : on.w, b = q < 2 ? on.w : (q == 2 ? 0 : chain.n_b - 1);
    Index const at = side.first + Index(chain.n_s) * on.w;
    Index const lower = chain.first_end_value + a + Index(chain.n_a) * b, upper = lower + chain.section_size();
    auto const known = KnownLine<MemorySpace>::of(sides, chain, q, side.n_w, on.w);
    Vec3 first, last;
    TurnedGradient first_turned, last_turned;
    for (int p = 0; p < chain.n_s; ++p) {
      if (known.is_end(p) || !known.is_known(p)) {
        c.set(at + p, {});
        continue;
      }
      Vec3 const g = c[at + p];
      double const t = sides.t(at + p), w = chain.law == LineLaw::constant ? 0 : law_weight(chain, law_knots, t);
      first += (w - 1) * g;
      last += -w * g;
      if (chain.turn != TurnLaw::none)
        turned_gradient(ends, chain, lower, upper, t, side_position[at + p], -g, first_turned, last_turned);
    }
    to.u.set(lower, to.u[lower] + first);
    to.u.set(upper, to.u[upper] + last);
    if (chain.turn == TurnLaw::none) return;
    to.turned.add(lower, 1, first_turned);
    to.turned.add(upper, 1, last_turned);
  }
};

}  // namespace gridmorph::kernels
