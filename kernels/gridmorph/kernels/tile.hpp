// How much one work item does: the only place where kernels for CPUs and for GPUs differ.
//
// On a CPU an item is a run or a tile of neighbouring nodes, long enough for vector instructions and small enough for
// the second-level cache; on a GPU it is one node (or one grid line), and neighbouring items touch neighbouring memory.
#pragma once

#include <gridmorph/kernels/grid_line.hpp>

#include <Kokkos_Core.hpp>

#include <cstdint>
#include <type_traits>

namespace gridmorph::kernels {

template <bool on_host>
struct TileShapeOf {
  static constexpr bool host = on_host;
  static constexpr int row = host ? 128 : 1;       ///< nodes of a surface row
  static constexpr int lines = host ? 64 : 1;      ///< neighbouring grid lines walked together
  static constexpr int volume_i = host ? 256 : 1;  ///< nodes of a volume tile along i, j, k
  static constexpr int volume_j = host ? 16 : 1;
  static constexpr int volume_k = host ? 32 : 1;
};
/// One for all execution spaces of the host, so that they share what is compiled for it.
template <class ExecutionSpace>
using TileShape = TileShapeOf<std::is_same_v<typename ExecutionSpace::memory_space, Kokkos::HostSpace>>;

/// A number that the compiler knows where a variable may stand too. (The conversion of std::integral_constant is a
/// function for the host alone.)
template <int N>
struct Constant {
  KOKKOS_INLINE_FUNCTION constexpr operator int() const { return N; }
};

/// A list of work: entry e is good for the items from first_item(e) to first_item(e + 1).
template <class T, class MemorySpace>
struct TileList {
  Kokkos::View<T const*, MemorySpace> entries;
  Kokkos::View<Index const*, MemorySpace> first_item;  ///< per entry, and one past the last
  Index n_items = 0;
};

KOKKOS_INLINE_FUNCTION constexpr Index tiles(Index n, Index width) { return (n + width - 1) / width; }

/// Nodes begin ... end - 1 of row q of an entry.
struct RowOfNodes {
  int q, begin, end;
};
/// Of an entry with rows of n_p nodes, cut into items of at most `Width` nodes; there are fewer than 2^32 of them,
/// since GPUs divide numbers of 64 bits by some hundred instructions.
template <int Width>
KOKKOS_INLINE_FUNCTION RowOfNodes row_of_nodes(int n_p, Index item) {
  std::uint32_t const number = std::uint32_t(item), per_row = std::uint32_t(tiles(n_p, Width)), q = number / per_row;
  int const begin = int(number - q * per_row) * Width;
  return {int(q), begin, begin + Width < n_p ? begin + Width : n_p};
}

/// The entry that holds an item, by bisection in the running totals `first` (one past the last included).
template <class View>
KOKKOS_INLINE_FUNCTION int entry_of(View const& first, Index item) {
  int lo = 0, hi = int(first.extent(0)) - 1;
  while (hi - lo > 1) {
    int const mid = (lo + hi) / 2;
    (first(mid) <= item ? lo : hi) = mid;
  }
  return lo;
}

}  // namespace gridmorph::kernels
