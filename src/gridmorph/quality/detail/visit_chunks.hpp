// The loop over chunks of cells, with one result per chunk; internal to the quality part.
#pragma once

#include <gridmorph/quality/detail/zone_cells.hpp>

#include <Kokkos_Core.hpp>

#include <string>
#include <type_traits>

namespace gridmorph::detail {

/// For visits that leave their results elsewhere: nothing is gathered, and the View of results may be empty.
struct NoResult {};

/// CPUs: one work item per chunk.
template <class Exec, class Result, class Visit>
struct ChunkPerItem {
  Kokkos::View<CellChunk const*, typename Exec::memory_space> chunks;
  Kokkos::View<Result*, typename Exec::memory_space> results;
  Visit visit;

  KOKKOS_INLINE_FUNCTION void operator()(int c) const {
    Result result;
    for_each_row(chunks(c), CellPolicy<Exec>::row_length, [&](RowOfCells const& row) { visit(row, result); });
    if constexpr (!std::is_empty_v<Result>) results(c) = result;
  }
};

/// GPUs: one team per chunk, one cell at a time per thread; neighbouring threads read neighbouring cells. Results of the
/// threads are joined pairwise, always the same pairs, so that sums repeat bit for bit.
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
    if constexpr (!std::is_empty_v<Result>) {
      Scratch const partial(team.team_scratch(0), threads);
      partial(rank) = result;
      for (int reach = 1; reach < threads; reach *= 2) {
        team.team_barrier();
        if (rank % (2 * reach) == 0 && rank + reach < threads) partial(rank).join(partial(rank + reach));
      }
      if (rank == 0) results(team.league_rank()) = partial(0);
    }
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
/// rows of chunk c. Result::join(other) adds what another thread gathered. `visit` runs on the device.
template <class Exec, class Result, class Visit>
void visit_chunks(Exec const& exec, std::string const& label,
                  Kokkos::View<CellChunk*, typename Exec::memory_space> const& chunks,
                  Kokkos::View<Result*, typename Exec::memory_space> const& results, Visit const& visit) {
  if constexpr (CellPolicy<Exec>::on_host)
    Kokkos::parallel_for(label, Kokkos::RangePolicy<Exec>(exec, 0, int(chunks.extent(0))),
                         ChunkPerItem<Exec, Result, Visit>{chunks, results, visit});
  else
    visit_chunks_by_teams<Exec, Result, Visit>(exec, label, CellPolicy<Exec>::team_size, {chunks, results, visit});
}

}  // namespace gridmorph::detail
