// Fills the side arrays of corrected chains: residuals where the side is known, Boolean sums where it is not.
// Two launches over the nodes of sides, edges first; formulas in side_correction.hpp.
#pragma once

#include <gridmorph/kernels/launch.hpp>
#include <gridmorph/kernels/skeleton_sweep.hpp>

namespace gridmorph::kernels {

/// Edge along s that borders side q at its lower (upper = 0) or upper end.
KOKKOS_INLINE_FUNCTION int edge_of_side(int q, int upper) { return q < 2 ? q + 2 * upper : upper + 2 * (q - 2); }

/// A line on a side of a corrected chain, and which of its nodes are known.
template <class MemorySpace>
struct KnownLine {
  Kokkos::View<Junction const*, MemorySpace> const& junctions;
  Chain const& chain;
  int bit;  ///< of Junction: its side, or 4 + its edge

  KOKKOS_INLINE_FUNCTION static KnownLine of(SideTable<MemorySpace> const& sides, Chain const& chain, int q, int n_w,
                                             int w) {
    int const category = end_category(w, n_w);
    return {sides.junctions, chain, category == 1 ? q : 4 + edge_of_side(q, category / 2)};
  }

  KOKKOS_INLINE_FUNCTION Junction const& junction(int m) const { return junctions(chain.first_junction + m); }
  /// The block that ends with a node, or has it inside; 0 for the first node. m: one not above it.
  KOKKOS_INLINE_FUNCTION int block(int position, int m = 0) const {
    while (junction(m + 1).position < position) ++m;
    return m;
  }
  KOKKOS_INLINE_FUNCTION bool is_end(int position) const {
    return position == 0 || (position == chain.n_s - 1 && !chain.open_end);
  }
  KOKKOS_INLINE_FUNCTION bool is_known(int position) const { return is_known(position, block(position)); }
  /// m: its block.
  KOKKOS_INLINE_FUNCTION bool is_known(int position, int m) const {
    if (is_end(position)) return true;
    Junction const& next = junction(m + 1);
    unsigned const known = next.position == position ? next.known_across : junction(m).known_along;
    return (known >> bit) & 1u;
  }
  /// The known node that is nearest to an unknown one, above it (step 1) or below (-1); n_s where an open end comes
  /// first. Of a block all nodes inside are known, or none.
  KOKKOS_INLINE_FUNCTION int nearest_known(int position, int step) const {
    while (position < chain.n_s && !is_known(position)) {
      int const m = block(position);
      position = junction(m + 1).position == position ? position + step : junction(step > 0 ? m + 1 : m).position;
    }
    return position;
  }
};

/// Whether the volume wants what sides have beyond their edges: where all pairs of sides are blended
/// (side_correction.hpp).
KOKKOS_INLINE_FUNCTION bool wants_beyond_edges(Chain const& chain) {
  return !chain.blends_along(0) && !chain.blends_along(1);
}
/// Whether residuals of known nodes are where they stay before SideFill runs, so that there is less to do. Not where an
/// item is one node: the choice takes registers.
template <int Width>
KOKKOS_INLINE_FUNCTION bool stay_in_place(Chain const& chain) {
  return Width > 1 && !wants_beyond_edges(chain);
}

/// The nodes of one side of a corrected chain, as work.
struct SideNodes {
  std::int32_t side;
  std::int32_t n_s, n_w;  ///< nodes along its lines, lines
};

/// The residuals c = u - interpolant on edges along s, all of them: where an edge is not known linear in t between the
/// nearest known nodes, constant to an open end. Elsewhere on sides those of known nodes, 0 for the others; these
/// go in place of the displacements, so that SideFill changes no node that others read, unless they stay in place.
/// One item per row of at most `Width` nodes.
template <class MemorySpace, int Width, Turning Turns = Turning::any>
struct SideResidual {
  Kokkos::View<SideNodes const*, MemorySpace> nodes;
  Kokkos::View<Index const*, MemorySpace> first_item;  ///< per side, and one past the last
  Kokkos::View<Chain const*, MemorySpace> chains;
  SideTable<MemorySpace> sides;
  Field<double const> ends;
  Field<double> known;  ///< displacements of known nodes, chain frame
  Field<double> c;
  double const* law_knots = nullptr;
  SkeletonTurns turns = {};

  static Index items(SideNodes const& on) { return tiles(on.n_s, Width) * on.n_w; }

  KOKKOS_INLINE_FUNCTION void operator()(Index item) const {
    int const entry = entry_of(first_item, item);
    Side const& side = sides.sides(nodes(entry).side);
    auto const [w, begin, end] = row_of_nodes<Width>(nodes(entry).n_s, item - first_item(entry));
    Chain const& chain = chains(side.chain);
    int const q = nodes(entry).side - chain.first_side, category = end_category(w, side.n_w);
    // An edge lies on two sides: the first of them has what is known of it.
    bool const edge = category != 1;
    int const first = edge && q >= 2 ? category / 2 : q;
    Line const line(*this, chain, first, first == q ? w : q == 2 ? 0 : sides.sides(chain.first_side + first).n_w - 1);
    Index const at = side.first + Index(chain.n_s) * w;
    Field<double> const& to = edge || stay_in_place<Width>(chain) ? c : known;
    for (int p = begin, m = 0; p < end; ++p) {
      m = line.known.block(p, m);
      to.set(at + p, value(line, p, line.known.is_known(p, m), edge));
    }
  }

 private:
  struct Line {
    KnownLine<MemorySpace> known;
    Index at;  ///< its first node in side arrays
    int a, b;
    KOKKOS_INLINE_FUNCTION Line(SideResidual const& on, Chain const& chain, int q, int w)
        : known(KnownLine<MemorySpace>::of(on.sides, chain, q, on.sides.sides(chain.first_side + q).n_w, w)),
          at(on.sides.sides(chain.first_side + q).first + Index(chain.n_s) * w),
          a(q < 2 ? (q == 0 ? 0 : chain.n_a - 1) : w),
          b(q < 2 ? w : (q == 2 ? 0 : chain.n_b - 1)) {}
  };

  /// Of a known node.
  KOKKOS_INLINE_FUNCTION Vec3 residual(Line const& line, int position) const {
    if (line.known.is_end(position)) return {};
    Chain const& chain = line.known.chain;
    Index const n = line.at + position;
    double const t = sides.t(n);
    Vec3 r = known[n] - between_ends(ends, law_knots, chain, line.a, line.b, t);
    if constexpr (Turns != Turning::none)
      if (chain.turn != TurnLaw::none)
        r += -turned_between<Turns>(turns.ends, chain, line.a, line.b, t, turns.side_position[n]);
    return r;
  }
  /// Of any node; those that are not known have one on edges only.
  KOKKOS_INLINE_FUNCTION Vec3 value(Line const& line, int position, bool is_known, bool edge) const {
    if (!is_known && !edge) return {};
    int const from = is_known ? position : line.known.nearest_known(position, -1);
    Vec3 const c0 = residual(line, from);
    if (is_known) return c0;
    int const n_s = line.known.chain.n_s, above = line.known.nearest_known(position, 1);
    int const to = above < n_s ? above : n_s - 1;
    Vec3 const c1 = above < n_s ? residual(line, to) : c0;
    double const t0 = sides.t(line.at + from), t1 = sides.t(line.at + to);
    double const f = t1 > t0 ? (sides.t(line.at + position) - t0) / (t1 - t0) : double(position - from) / (to - from);
    return (1 - f) * c0 + f * c1;
  }
};

/// Residuals of the nodes between the edges of sides: Boolean sums of the borders of faces that are not known, and of
/// edges across that are not. Then c' = c - edges where the correction asks for that. One item per row of at most
/// `Width` nodes; nothing is done on edges.
template <class MemorySpace, int Width>
struct SideFill {
  Kokkos::View<SideNodes const*, MemorySpace> nodes;
  Kokkos::View<Index const*, MemorySpace> first_item;  ///< per side, and one past the last
  Kokkos::View<Chain const*, MemorySpace> chains;
  SideTable<MemorySpace> sides;  ///< of edges
  Field<double const> known;     ///< residuals of known nodes, unless they stay in place
  Field<double> c;

  KOKKOS_INLINE_FUNCTION void operator()(Index item) const {
    int const entry = entry_of(first_item, item);
    Side const& side = sides.sides(nodes(entry).side);
    int const n_s = nodes(entry).n_s;
    auto const [w, begin, end] = row_of_nodes<Width>(n_s, item - first_item(entry));
    if (end_category(w, side.n_w) != 1) return;
    Chain const& chain = chains(side.chain);
    int const q = nodes(entry).side - chain.first_side;
    int const a = q == 0 ? 0 : (q == 1 ? chain.n_a - 1 : w), b = q == 2 ? 0 : (q == 3 ? chain.n_b - 1 : w);
    Index const at = side.first + Index(n_s) * w;
    auto const line = KnownLine<MemorySpace>::of(sides, chain, q, side.n_w, w);
    auto between_edges = [&](int p) {
      double const t = sides.t(at + p), f = sides.across(chain, q < 2 ? 1 : 0, a, b, t);
      return (1 - f) * sides.at(chain, q, 0, t, p) + f * sides.at(chain, q, side.n_w - 1, t, p);
    };
    // Of the borders across, what they have beyond what is between the borders along s: added between the edges.
    bool const less_edges = wants_beyond_edges(chain), in_place = stay_in_place<Width>(chain);
    Field<double const> const residual = in_place ? Field<double const>{c.x, c.y, c.z, c.stride} : known;
    auto beyond_edges = [&](int p) { return line.is_known(p) ? residual[at + p] - between_edges(p) : Vec3{}; };
    int filled[2] = {-1, -1};  // borders that `beyond` is of
    Vec3 beyond[2];
    for (int p = begin, m = 0; p < end; ++p) {
      m = line.block(p, m);
      bool const is_known = line.is_known(p, m);
      if (is_known && !less_edges) {
        if (!in_place)
          c.set(at + p, residual[at + p]);
        else if (p > 0 && p < line.junction(m + 1).position)
          p = line.junction(m + 1).position - 1;  // all of its block is known
        continue;
      }
      Vec3 const between = between_edges(p);
      Vec3 v = between;
      if (is_known) {
        v = residual[at + p];
      } else if (p < line.junction(m + 1).position) {
        int const borders[2] = {line.junction(m).position, line.junction(m + 1).position};
        double const t0 = sides.t(at + borders[0]), t1 = sides.t(at + borders[1]);
        double const f =
            t1 > t0 ? (sides.t(at + p) - t0) / (t1 - t0) : double(p - borders[0]) / (borders[1] - borders[0]);
        for (int upper = 0; upper < 2; ++upper) {
          if (filled[upper] != borders[upper]) beyond[upper] = beyond_edges(borders[upper]);
          filled[upper] = borders[upper];
          v = v + (upper == 0 ? 1 - f : f) * beyond[upper];
        }
      }
      c.set(at + p, less_edges ? v - between : v);
    }
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

/// Sides listed in `nodes`. known: the displacements of their known nodes, in the chain's frame, on which residuals are
/// worked out in place; c is the array that `sides` reads. with_turns: whether chains turn.
template <class Exec>
void fill_sides(Exec const& exec, TileList<SideNodes, typename Exec::memory_space> const& nodes,
                Kokkos::View<Chain const*, typename Exec::memory_space> const& chains,
                SideTable<typename Exec::memory_space> const& sides,
                Kokkos::View<SideLine const*, typename Exec::memory_space> const& across,
                Field<double const> const& ends, Field<double> const& known, Field<double> const& c,
                double const* law_knots, SkeletonTurns const& turns, bool with_turns) {
  using MemorySpace = typename Exec::memory_space;
  constexpr int width = TileShape<Exec>::row;
  with_turning<TileShape<Exec>::host>(with_turns, turns.ends, [&](auto kind) {
    launch("gridmorph::side_residual", exec, 0, nodes.n_items,
           SideResidual<MemorySpace, width, decltype(kind)::value>{nodes.entries, nodes.first_item, chains, sides, ends,
                                                                   known, c, law_knots, turns});
  });
  launch("gridmorph::side_residual::sides", exec, 0, nodes.n_items,
         SideFill<MemorySpace, width>{
             nodes.entries, nodes.first_item, chains, sides, {known.x, known.y, known.z, known.stride}, c});
  launch("gridmorph::side_residual::across", exec, SidesAcross<MemorySpace>{chains, sides, across, c});
}

}  // namespace gridmorph::kernels
