// The loop over the cells or elements of a mesh, in chunks, with one result per chunk: how all measures of quality are
// launched.
//
// Chunks, and what is joined with what, are the same on every execution space and with any number of threads, so sums
// repeat bit for bit. On a CPU an item is a chunk, row by row; on a GPU a chunk has a team, and each of its threads a
// cell. Cost beyond that of the visits: one result written per 1024 cells.
#pragma once

#include <gridmorph/kernels/grid_line.hpp>
#include <gridmorph/kernels/lanes.hpp>
#include <gridmorph/kernels/launch.hpp>

#include <Kokkos_Core.hpp>

#include <string>

namespace gridmorph::kernels {

/// One zone as a kernel over its cells sees it.
struct ZoneCells {
  Index first_node = 0;
  Index first_cell = 0;
  int extent[3] = {0, 0, 0};  ///< cells along i, j, k
  double handedness = 1;

  KOKKOS_INLINE_FUNCTION Index node_stride(int axis) const {
    return axis == 0 ? 1 : axis == 1 ? Index(extent[0]) + 1 : (Index(extent[0]) + 1) * (Index(extent[1]) + 1);
  }
  KOKKOS_INLINE_FUNCTION Index cell_stride(int axis) const {
    return axis == 0 ? 1 : axis == 1 ? Index(extent[0]) : Index(extent[0]) * extent[1];
  }
};

/// How execution spaces differ: a work item of a CPU takes a chunk row by row, several cells at once; GPUs take one
/// cell per work item and have a team of threads for the chunk. Chunks are the same everywhere.
template <class Exec>
struct CellPolicy {
  static constexpr bool on_host =
      Kokkos::SpaceAccessibility<Kokkos::HostSpace, typename Exec::memory_space>::accessible;
  /// As many as registers of the widest copy of a kernel hold (instruction_sets.hpp).
  static constexpr int lanes = !on_host ? 1 : has_two_instruction_sets ? 4 : native_lanes;
  static constexpr int row_length = on_host ? 64 : 1;  ///< scratch arrays of rows stay in the first-level cache
  static constexpr int team_size = on_host ? 1 : 32;   ///< partial sums of a team fit into 48 KiB of scratch memory
};

/// Cells begin <= n < end of one box of cells, numbered within the box, i fastest. Sums are made chunk by chunk, so
/// they do not depend on how many threads share the chunks.
struct CellChunk {
  int zone = 0;
  int box_begin[3] = {0, 0, 0};
  int box_extent[3] = {0, 0, 0};
  Index begin = 0, end = 0;
};

inline constexpr Index cells_per_chunk = 1024;

/// `count` cells of a zone that follow one another along i from cell (i, j, k) on.
struct RowOfCells {
  int zone;
  int i, j, k;
  int count;
};

/// The cell with number n of a chunk's box.
KOKKOS_INLINE_FUNCTION RowOfCells cell_of_chunk(CellChunk const& chunk, Index n) {
  Index const ni = chunk.box_extent[0], nj = chunk.box_extent[1];
  return {chunk.zone, chunk.box_begin[0] + int(n % ni), chunk.box_begin[1] + int(n / ni % nj),
          chunk.box_begin[2] + int(n / (ni * nj)), 1};
}

/// Calls f(row) for the cells of a chunk in order, in rows of at most `length` cells.
template <class Function>
KOKKOS_INLINE_FUNCTION void for_each_row(CellChunk const& chunk, int length, Function const& f) {
  for (Index n = chunk.begin; n < chunk.end;) {
    RowOfCells row = cell_of_chunk(chunk, n);
    Index const to_end_of_row = chunk.box_begin[0] + chunk.box_extent[0] - row.i, to_end_of_chunk = chunk.end - n;
    Index const count = to_end_of_row < to_end_of_chunk ? to_end_of_row : to_end_of_chunk;
    row.count = int(count < length ? count : length);
    f(row);
    n += row.count;
  }
}

/// Number in the mesh of the first cell of a row.
KOKKOS_INLINE_FUNCTION Index first_cell(ZoneCells const& zone, RowOfCells const& r) {
  return zone.first_cell + r.i + r.j * zone.cell_stride(1) + r.k * zone.cell_stride(2);
}

/// Of visits that take CellPolicy::lanes cells at once.
inline constexpr bool by_lanes = true;

/// CPUs: one work item per chunk.
template <class Exec, class Result, class Visit, bool lanes>
struct ChunkPerItem {
  static constexpr bool two_instruction_sets = lanes;

  Kokkos::View<CellChunk const*, typename Exec::memory_space> chunks;
  Kokkos::View<Result*, typename Exec::memory_space> results;
  Visit visit;

  KOKKOS_INLINE_FUNCTION void operator()(Index c) const {
    Result result;
    for_each_row(chunks(c), CellPolicy<Exec>::row_length, [&](RowOfCells const& row) { visit(row, result); });
    results(c) = result;
  }
};

/// GPUs: one team per chunk, one cell at a time per thread; neighbouring threads read neighbouring cells. Results of
/// the threads are joined pairwise, always the same pairs, so that sums repeat bit for bit.
template <class Exec, class Result, class Visit>
struct ChunkPerTeam {
  using Team = typename Kokkos::TeamPolicy<Exec>::member_type;
  using Scratch = Kokkos::View<Result*, typename Exec::scratch_memory_space, Kokkos::MemoryUnmanaged>;

  Kokkos::View<CellChunk const*, typename Exec::memory_space> chunks;
  Kokkos::View<Result*, typename Exec::memory_space> results;
  Visit visit;

  KOKKOS_INLINE_FUNCTION void operator()(Team const& team) const {
    CellChunk const chunk = chunks(team.league_rank());
    int const rank = team.team_rank(), threads = team.team_size();
    Result result;
    for (Index n = chunk.begin + rank; n < chunk.end; n += threads) visit(cell_of_chunk(chunk, n), result);
    Scratch const partial(team.team_scratch(0), threads);
    partial(rank) = result;
    for (int reach = 1; reach < threads; reach *= 2) {
      team.team_barrier();
      if (rank % (2 * reach) == 0 && rank + reach < threads) partial(rank).join(partial(rank + reach));
    }
    if (rank == 0) results(team.league_rank()) = partial(0);
  }
};

/// Results of ChunkPerTeam with teams of `team_size`.
template <class Exec, class Result, class Visit>
void visit_chunks_by_teams(Exec const& exec, std::string const& label, int team_size,
                           ChunkPerTeam<Exec, Result, Visit> const& work) {
  using Work = ChunkPerTeam<Exec, Result, Visit>;
  Kokkos::TeamPolicy<Exec> policy(exec, int(work.chunks.extent(0)), team_size);
  Kokkos::parallel_for(label, policy.set_scratch_size(0, Kokkos::PerTeam(Work::Scratch::shmem_size(team_size))), work);
}

/// Calls visit(row, result) for every row of every chunk; results(c), one per chunk, begins as Result() and gathers the
/// rows of chunk c. Result::join(other) adds what another thread gathered. `visit` runs on the device. lanes: by_lanes,
/// or not.
template <bool lanes = false, class Exec, class Result, class Visit>
void visit_chunks(Exec const& exec, std::string const& label,
                  Kokkos::View<CellChunk*, typename Exec::memory_space> const& chunks,
                  Kokkos::View<Result*, typename Exec::memory_space> const& results, Visit const& visit) {
  if constexpr (CellPolicy<Exec>::on_host)
    launch(label.c_str(), exec, 0, Index(chunks.extent(0)),
           ChunkPerItem<Exec, Result, Visit, lanes>{chunks, results, visit});
  else
    visit_chunks_by_teams<Exec, Result, Visit>(exec, label, CellPolicy<Exec>::team_size, {chunks, results, visit});
}

}  // namespace gridmorph::kernels
