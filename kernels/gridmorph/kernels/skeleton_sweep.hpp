// Displacement along grid lines from the values at their ends, on the skeleton: the faces, edges and corners of all
// pieces.
//
//   u(s) = u0 + w(t) (u1 - u0) + c(s, a, b)
//
// (paper, section 3: "one simply interpolates along the grid line using a chosen distribution law, the simplest one
// being linear interpolation by grid line length"), t from line_parameter.hpp, c the transfinite correction of
// side_correction.hpp; it is absent where no side of the chain is known. Stages depend on one another through the
// skeleton alone, so it goes through the stages first and the volume follows in one pass (volume_pass.hpp).
//
// Where the ends of a chain turn, what turned_line.hpp says is added.
//
// The skeleton keeps one displacement per slot; nodes that coincide, also through a periodic interface, share a slot.
#pragma once

#include <gridmorph/kernels/launch.hpp>
#include <gridmorph/kernels/side_correction.hpp>
#include <gridmorph/kernels/tile.hpp>
#include <gridmorph/kernels/turned_line.hpp>

namespace gridmorph::kernels {

/// Nodes (p, q) of one face, edge or corner: where they lie on their chain, where their displacement goes.
struct SkeletonSweep {
  std::int32_t chain;
  std::int32_t matrix;  ///< chain frame -> frame of the slots (onto the axis where they lie on it), -1: the same
  std::int32_t n_p, n_q;
  Index slot, slot_q;             ///< slots of a row follow one another
  Index t, t_p, t_q;              ///< line parameters; t < 0: none needed
  std::int32_t s[3], a[3], b[3];  ///< position on the chain of node (0, 0), and what a step along p and q adds
  Index x = -1;                   ///< where its baseline positions start, row by row; needed where the chain turns
};

/// u0 + w (u1 - u0): exactly u0 where both ends move alike.
KOKKOS_INLINE_FUNCTION Vec3 between_ends(Field<double const> const& ends, double const* law_knots, Chain const& chain,
                                         Index a, Index b, double t) {
  Index const at = chain.first_end_value + a + chain.n_a * b;
  Vec3 const u0 = ends[at];
  if (chain.law == LineLaw::constant) return u0;
  return u0 + law_weight(chain, law_knots, t) * (ends[at + chain.section_size()] - u0);
}

/// What rotations at the ends of chains need on the skeleton; nothing where none turn.
struct SkeletonTurns {
  TurnedEndsWithRates ends;
  Field<double const> end_turns;  ///< rotations of line ends
  Field<double> slot_turns;       ///< of slots, written by sweeps
  Field<double const> position;   ///< of what SkeletonSweep::x counts, chain frames
  Field<double const> side_position;
};

/// One item per row of at most `Width` nodes. With `Add` the value is added to what is there. Sides: whether chains may
/// have some that are known.
template <class MemorySpace, int Width, bool Add, Turning Turns = Turning::any, bool Sides = true>
struct SweepSkeleton {
  Kokkos::View<SkeletonSweep const*, MemorySpace> sweeps;
  Kokkos::View<Index const*, MemorySpace> first_item;  ///< per sweep, and one past the last
  Kokkos::View<Chain const*, MemorySpace> chains;
  Kokkos::View<Mat3 const*, MemorySpace> matrices;
  SideTable<MemorySpace> sides;
  double const* t;
  Field<double const> ends;
  Field<double> u;
  double const* law_knots = nullptr;  ///< of laws that are tables
  SkeletonTurns turns = {};

  static Index items(SkeletonSweep const& s) { return tiles(s.n_p, Width) * s.n_q; }

  KOKKOS_INLINE_FUNCTION void operator()(Index item) const {
    int const entry = entry_of(first_item, item);
    SkeletonSweep const& sweep = sweeps(entry);
    Chain const& chain = chains(sweep.chain);
    auto const [q, begin, end] = row_of_nodes<Width>(sweep.n_p, item - first_item(entry));
    for (int p = begin; p < end; ++p) {
      int const a = sweep.a[0] + p * sweep.a[1] + q * sweep.a[2], b = sweep.b[0] + p * sweep.b[1] + q * sweep.b[2];
      double const f = sweep.t < 0 ? 0 : t[sweep.t + p * sweep.t_p + q * sweep.t_q];
      Vec3 v = between_ends(ends, law_knots, chain, a, b, f);
      Index const slot = sweep.slot + p + q * sweep.slot_q;
      if constexpr (Turns != Turning::none)
        if (chain.turn != TurnLaw::none) {
          v += turned_between<Turns>(turns.ends, chain, a, b, f, turns.position[sweep.x + p + q * sweep.n_p]);
          Vec3 const turn = turn_between_ends(turns.end_turns, chain, a, b, f);
          turns.slot_turns.set(slot, sweep.matrix >= 0 ? matrices(sweep.matrix) * turn : turn);
        }
      if (Sides && chain.first_side >= 0)
        v += sides.correction(chain, sweep.s[0] + p * sweep.s[1] + q * sweep.s[2], a, b, f);
      if (sweep.matrix >= 0) v = matrices(sweep.matrix) * v;
      if constexpr (Add) v = u[slot] + v;
      u.set(slot, v);
    }
  }
};
/// Finds u of the slots that the sweeps name, or with `Add`, where chains neither turn nor have known sides, what is
/// added to it. ends: of the chains' lines; t: line parameters. with_turns, with_sides: what chains have.
template <bool Add, class Exec>
void sweep_skeleton(Exec const& exec, TileList<SkeletonSweep, typename Exec::memory_space> const& sweeps,
                    Kokkos::View<Chain const*, typename Exec::memory_space> const& chains,
                    Kokkos::View<Mat3 const*, typename Exec::memory_space> const& matrices,
                    SideTable<typename Exec::memory_space> const& sides, double const* t,
                    Field<double const> const& ends, Field<double> const& u, double const* law_knots,
                    SkeletonTurns const& turns, bool with_turns, bool with_sides) {
  auto const run = [&]<Turning Turns, bool Sides>() {
    launch(Add ? "gridmorph::skeleton_spread" : "gridmorph::skeleton_sweep", exec, 0, sweeps.n_items,
           SweepSkeleton<typename Exec::memory_space, TileShape<Exec>::row, Add, Turns, Sides>{
               sweeps.entries, sweeps.first_item, chains, matrices, sides, t, ends, u, law_knots, turns});
  };
  constexpr bool host = TileShape<Exec>::host;
  if constexpr (Add)
    run.template operator()<Turning::none, false>();
  else
    with_turning<host>(with_turns, turns.ends, [&](auto kind) {
      if (host || with_sides)
        run.template operator()<decltype(kind)::value, true>();
      else
        run.template operator()<decltype(kind)::value, host>();
    });
}

}  // namespace gridmorph::kernels
