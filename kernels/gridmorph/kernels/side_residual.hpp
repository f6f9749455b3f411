// Fills the side arrays of corrected chains: residuals where the side is known, Boolean sums where it is not.
// Four launches, each over lines of surfaces only; formulas in side_correction.hpp.
#pragma once

#include <gridmorph/kernels/launch.hpp>
#include <gridmorph/kernels/skeleton_sweep.hpp>

namespace gridmorph::kernels {

/// Edge along s that borders side q at its lower (upper = 0) or upper end.
KOKKOS_INLINE_FUNCTION int edge_of_side(int q, int upper) { return q < 2 ? q + 2 * upper : upper + 2 * (q - 2); }

/// What is known at one node of a corrected chain's side.
template <class MemorySpace>
KOKKOS_INLINE_FUNCTION bool side_node_is_known(SideTable<MemorySpace> const& sides, Chain const& chain, int q, int n_w,
                                               int position, int w) {
  if (position == 0 || (position == chain.n_s - 1 && !chain.open_end)) return true;
  int m = 0;
  while (sides.junctions(chain.first_junction + m + 1).position < position) ++m;
  Junction const& next = sides.junctions(chain.first_junction + m + 1);
  bool const at_junction = next.position == position;
  unsigned const known = at_junction ? next.known_across : sides.junctions(chain.first_junction + m).known_along;
  int const category = end_category(w, n_w);
  int const bit = category == 1 ? q : 4 + edge_of_side(q, category / 2);
  return (known >> bit) & 1u;
}

/// The residual c = u - interpolant at the known nodes of a side line, 0 at the others. c comes in as the displacements
/// of the known nodes, in the chain's frame.
template <class MemorySpace>
struct SideResidual {
  Kokkos::View<Chain const*, MemorySpace> chains;
  SideTable<MemorySpace> sides;
  Kokkos::View<SideLine const*, MemorySpace> side_lines;
  Field<double const> ends;
  Field<double> c;
  double const* law_knots = nullptr;
  SkeletonTurns turns = {};

  [[nodiscard]] Index size() const { return Index(side_lines.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index item) const {
    SideLine const& on = side_lines(item);
    Side const& side = sides.sides(on.side);
    Chain const& chain = chains(side.chain);
    int const q = on.side - chain.first_side;
    int const a = q < 2 ? (q == 0 ? 0 : chain.n_a - 1) : on.w, b = q < 2 ? on.w : (q == 2 ? 0 : chain.n_b - 1);
    Index const at = side.first + Index(chain.n_s) * on.w;
    for (int position = 0; position < chain.n_s; ++position) {
      bool const end = position == 0 || (position == chain.n_s - 1 && !chain.open_end);
      Vec3 residual;
      if (!end && side_node_is_known(sides, chain, q, side.n_w, position, on.w)) {
        double const t = sides.t(at + position);
        residual = c[at + position] - between_ends(ends, law_knots, chain, a, b, t);
        if (chain.turn != TurnLaw::none)
          residual += -turned_between(turns.ends, chain, a, b, t, turns.side_position[at + position]);
      }
      c.set(at + position, residual);
    }
  }
};

/// Fills unknown stretches of the four edges along s: linear in t between the nearest known nodes, constant to an open
/// end. One item per edge; items = 4 * corrected chains, chain numbers in `corrected`.
template <class MemorySpace>
struct EdgeFill {
  Kokkos::View<Chain const*, MemorySpace> chains;
  SideTable<MemorySpace> sides;
  Kokkos::View<std::int32_t const*, MemorySpace> corrected;
  Field<double> c;

  [[nodiscard]] Index size() const { return 4 * Index(corrected.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index item) const {
    Chain const& chain = chains(corrected(item / 4));
    int const e = int(item % 4);
    int const q = e % 2, partner = 2 + e / 2;
    Side const& side = sides.sides(chain.first_side + q);
    Side const& other = sides.sides(chain.first_side + partner);
    int const w = e / 2 == 0 ? 0 : side.n_w - 1;
    Index const at = side.first + Index(chain.n_s) * w;
    Index const there = other.first + Index(chain.n_s) * (e % 2 == 0 ? 0 : other.n_w - 1);
    auto fill = [&](int from, int to, bool open) {
      Vec3 const c0 = c[at + from], c1 = open ? c0 : c[at + to];
      double const t0 = sides.t(at + from), t1 = sides.t(at + to);
      for (int p = from + 1; p < (open ? to + 1 : to); ++p) {
        double const f = t1 > t0 ? (sides.t(at + p) - t0) / (t1 - t0) : double(p - from) / (to - from);
        c.set(at + p, (1 - f) * c0 + f * c1);
      }
    };
    int last = 0;
    for (int p = 1; p < chain.n_s; ++p)
      if (side_node_is_known(sides, chain, q, side.n_w, p, w)) {
        if (p > last + 1) fill(last, p, false);
        last = p;
      }
    if (last < chain.n_s - 1) fill(last, chain.n_s - 1, true);
    for (int p = 0; p < chain.n_s; ++p) c.set(there + p, c[at + p]);
  }
};

/// Fills unknown faces of the sides, and the unknown edges across them: Boolean sum from the face's four borders. Then
/// c' = c - edges where the correction asks for that. One item per side line; nothing is done on edges.
template <class MemorySpace>
struct SideFill {
  Kokkos::View<Chain const*, MemorySpace> chains;
  SideTable<MemorySpace> sides;
  Kokkos::View<SideLine const*, MemorySpace> side_lines;
  Field<double> c;

  [[nodiscard]] Index size() const { return Index(side_lines.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index item) const {
    SideLine const& on = side_lines(item);
    Side const& side = sides.sides(on.side);
    if (end_category(on.w, side.n_w) != 1) return;
    Chain const& chain = chains(side.chain);
    int const q = on.side - chain.first_side;
    Index const line = side.first + Index(chain.n_s) * on.w;
    int const a = q == 0 ? 0 : (q == 1 ? chain.n_a - 1 : on.w);
    int const b = q == 2 ? 0 : (q == 3 ? chain.n_b - 1 : on.w);
    auto fraction_across = [&](int p) { return sides.across(chain, q < 2 ? 1 : 0, a, b, sides.t(line + p)); };
    auto between_edges = [&](int p, double f) {
      double const t = sides.t(line + p);
      return (1 - f) * sides.at(chain, q, 0, t, p) + f * sides.at(chain, q, side.n_w - 1, t, p);
    };
    for (int m = 0; m <= chain.n_blocks; ++m) {
      int const p = sides.junctions(chain.first_junction + m).position;
      if (!side_node_is_known(sides, chain, q, side.n_w, p, on.w))
        c.set(line + p, between_edges(p, fraction_across(p)));
    }
    for (int m = 0; m < chain.n_blocks; ++m) {
      Junction const& j = sides.junctions(chain.first_junction + m);
      if ((j.known_along >> q) & 1u) continue;
      int const p0 = j.position, p1 = sides.junctions(chain.first_junction + m + 1).position;
      double const t0 = sides.t(line + p0), t1 = sides.t(line + p1);
      // Residual of the borders along s against the borders across: added between the edges.
      Vec3 const r0 = c[line + p0] - between_edges(p0, fraction_across(p0));
      Vec3 const r1 = c[line + p1] - between_edges(p1, fraction_across(p1));
      for (int p = p0 + 1; p < p1; ++p) {
        double const f = t1 > t0 ? (sides.t(line + p) - t0) / (t1 - t0) : double(p - p0) / (p1 - p0);
        c.set(line + p, between_edges(p, fraction_across(p)) + (1 - f) * r0 + f * r1);
      }
    }
    // Where all pairs of sides are blended, the volume wants what a side has beyond its edges (side_correction.hpp).
    if (chain.blends_along(0) || chain.blends_along(1)) return;
    for (int p = 0; p < chain.n_s; ++p) c.set(line + p, c[line + p] - between_edges(p, fraction_across(p)));
  }
};
/// Copies sides with their nodes in the other order (Side::across): rows of nodes that run from line to line read
/// neighbours there. One item per piece of a side.
template <class MemorySpace>
struct SidesAcross {
  static constexpr int lines = 16;  ///< of a piece, from that of its entry on

  Kokkos::View<Chain const*, MemorySpace> chains;
  SideTable<MemorySpace> sides;
  Kokkos::View<SideLine const*, MemorySpace> pieces;
  Field<double> c;

  [[nodiscard]] Index size() const { return Index(pieces.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index item) const {
    SideLine const& piece = pieces(item);
    Side const& side = sides.sides(piece.side);
    int const n_s = chains(side.chain).n_s, end = piece.w + lines < side.n_w ? piece.w + lines : side.n_w;
    for (int p = 0; p < n_s; ++p)
      for (int w = piece.w; w < end; ++w)
        c.set(side.across + Index(side.n_w) * p + w, c[side.first + Index(n_s) * w + p]);
  }
};

/// Sides of the chains in `corrected`. c comes in as the displacements of the known nodes, in the chain's frame; it is
/// the array that `sides` reads.
template <class Exec>
void fill_sides(Exec const& exec, Kokkos::View<Chain const*, typename Exec::memory_space> const& chains,
                SideTable<typename Exec::memory_space> const& sides,
                Kokkos::View<SideLine const*, typename Exec::memory_space> const& side_lines,
                Kokkos::View<std::int32_t const*, typename Exec::memory_space> const& corrected,
                Kokkos::View<SideLine const*, typename Exec::memory_space> const& across,
                Field<double const> const& ends, Field<double> const& c, double const* law_knots = nullptr,
                SkeletonTurns const& turns = {}) {
  using MemorySpace = typename Exec::memory_space;
  launch("gridmorph::side_residual", exec,
         SideResidual<MemorySpace>{chains, sides, side_lines, ends, c, law_knots, turns});
  launch("gridmorph::side_residual::edges", exec, EdgeFill<MemorySpace>{chains, sides, corrected, c});
  launch("gridmorph::side_residual::sides", exec, SideFill<MemorySpace>{chains, sides, side_lines, c});
  launch("gridmorph::side_residual::across", exec, SidesAcross<MemorySpace>{chains, sides, across, c});
}

}  // namespace gridmorph::kernels
