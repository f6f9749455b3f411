// What the transpose of a morph of blocks needs besides the tables of its DevicePlan: who reads what, turned round, and
// room for the gradients that a field of its workspace has no place for.
#pragma once

#include <gridmorph/kernels/transposed_copies.hpp>
#include <gridmorph/kernels/transposed_sides.hpp>
#include <gridmorph/morph/device_plan.hpp>

#include <vector>

namespace gridmorph::detail {

/// Lines of a stage or of a pass, by groups.
template <class Exec>
struct TransposedLines {
  using Memory = typename Exec::memory_space;
  WorkList<kernels::LineGroup, Memory> groups;
  Kokkos::View<kernels::LineBundle*, Memory> bundles;
};

template <class Exec>
struct TransposedStage {
  using Memory = typename Exec::memory_space;
  TransposedLines<Exec> lines;
  kernels::CopiesOf<Memory> ends, gathers;
  Kokkos::View<kernels::SideSlab*, Memory> slabs;
  Kokkos::View<Index*, Memory> first_part;      ///< kernels::EdgeSums
  Index first_side_node = 0, n_side_nodes = 0;  ///< of its corrected chains
  kernels::Dependents<Memory> lines_of_root;    ///< of the near field
};

template <class Exec>
struct TransposedSpread {
  using Memory = typename Exec::memory_space;
  TransposedLines<Exec> lines;
  kernels::Dependents<Memory> ends_of_slot;
  Workspace<Memory> kept;  ///< displacements of its ends
};

/// How walls' rotations depend on one another.
template <class Exec>
struct TransposedTurns {
  using Memory = typename Exec::memory_space;
  kernels::CopiesOf<Memory> parts_of_slot;  ///< kernels::RawRootTurnBack
  kernels::CopiesOf<Memory> parts_of_end;   ///< kernels::NearFieldTurnBack
  kernels::Dependents<Memory> end_walls_of_slot, end_walls_of_root;
};

/// Memory: about 50 bytes per node of the skeleton, and 100 to 200 bytes per bundle of lines. The plan has room for two
/// fields.
template <class Exec>
struct TransposedPlan {
  using Memory = typename Exec::memory_space;
  std::vector<TransposedStage<Exec>> stages;
  std::vector<TransposedSpread<Exec>> spreads;
  TransposedTurns<Exec> turns;
  kernels::CopiesOf<Memory> boundary_projections, skeleton_nodes;
  Workspace<Memory> between;     ///< per side node
  Workspace<Memory> edges;       ///< parts of edges, a field per share; of one stage at a time
  Workspace<Memory> sides;       ///< per side node of a stage, a field per share, where there are several
  Workspace<Memory> turn_parts;  ///< of the walls' rotations

  TransposedPlan(Exec const& exec, DevicePlan<Exec> const& plan);
};

}  // namespace gridmorph::detail
