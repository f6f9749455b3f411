// Stable sort of keys with the numbers that belong to them, on any execution space; internal.
#pragma once

#include <gridmorph/core/csr_graph.hpp>

#include <Kokkos_Core.hpp>

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>

namespace gridmorph::detail {

template <class MemorySpace>
struct KeyedIndices {
  Kokkos::View<std::uint64_t*, MemorySpace> key;
  Kokkos::View<Index32*, MemorySpace> number;

  KeyedIndices() = default;
  KeyedIndices(std::size_t n, std::string const& label)
      : key(Kokkos::view_alloc(Kokkos::WithoutInitializing, label), n),
        number(Kokkos::view_alloc(Kokkos::WithoutInitializing, label), n) {}
};

/// The list with keys ascending, numbers of equal keys in the order they had. By counting, a byte of the keys at a time
/// (least significant first), in chunks that are counted and moved side by side: stable, so the result is the same for
/// any number of chunks. Cost: 8 times 32 bytes per key.
template <class Exec>
KeyedIndices<typename Exec::memory_space> sort_keys(Exec const& exec, KeyedIndices<typename Exec::memory_space> list) {
  using MemorySpace = typename Exec::memory_space;
  constexpr int digit_bits = 8, n_digits = 1 << digit_bits;
  using Counts = Kokkos::View<Index*, MemorySpace>;
  using Policy = Kokkos::RangePolicy<Exec, Kokkos::IndexType<Index>>;
  Index const n = Index(list.key.extent(0));
  constexpr Index smallest_chunk = 4 * n_digits;
  Index const n_chunks = std::clamp<Index>(n / smallest_chunk, 1, 4 * Index(exec.concurrency()));
  Index const chunk = (n + n_chunks - 1) / n_chunks;
  KeyedIndices<MemorySpace> other(std::size_t(n), "gridmorph::sort_keys::other");
  // Digit after digit, chunk after chunk in each: their running sum is where a chunk's keys of that digit go.
  Counts const place(Kokkos::view_alloc(Kokkos::WithoutInitializing, "gridmorph::sort_keys::place"),
                     std::size_t(n_digits * n_chunks));
  for (int shift = 0; shift < 64; shift += digit_bits) {
    auto const from = list;
    auto const to = other;
    Kokkos::parallel_for(
        "gridmorph::sort_keys::count", Policy(exec, 0, n_chunks), KOKKOS_LAMBDA(Index const c) {
          Index const end = (c + 1) * chunk < n ? (c + 1) * chunk : n;
          for (int d = 0; d < n_digits; ++d) place(d * n_chunks + c) = 0;
          for (Index k = c * chunk; k < end; ++k) {
            Index const digit = Index(from.key(k) >> shift & (n_digits - 1));
            place(digit * n_chunks + c) += 1;
          }
        });
    Kokkos::parallel_scan(
        "gridmorph::sort_keys::places", Policy(exec, 0, n_digits * n_chunks),
        KOKKOS_LAMBDA(Index const k, Index& sum, bool const final) {
          Index const count = place(k);
          if (final) place(k) = sum;
          sum += count;
        });
    Kokkos::parallel_for(
        "gridmorph::sort_keys::move", Policy(exec, 0, n_chunks), KOKKOS_LAMBDA(Index const c) {
          Index const end = (c + 1) * chunk < n ? (c + 1) * chunk : n;
          for (Index k = c * chunk; k < end; ++k) {
            Index const digit = Index(from.key(k) >> shift & (n_digits - 1));
            Index const at = place(digit * n_chunks + c)++;
            to.key(at) = from.key(k);
            to.number(at) = from.number(k);
          }
        });
    std::swap(list, other);
  }
  return list;
}

}  // namespace gridmorph::detail
