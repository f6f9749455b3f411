// Lists of indices in compressed sparse rows: the elements around each node, the nodes of each element, ...
#pragma once

#include <gridmorph/core/index.hpp>
#include <gridmorph/kernels/kokkos_compat.hpp>

#include <Kokkos_Core.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace gridmorph {

/// A node, an element or an entry of a list in compressed lists: half the memory of an Index, enough for 2 thousand
/// million.
using Index32 = std::int32_t;

/// A graph in compressed sparse rows: row n is item[first[n]] ... item[first[n + 1] - 1].
struct CsrGraph {
  std::vector<Index> first{0};  ///< (n_rows + 1)
  std::vector<Index32> item;

  /// Number of rows.
  [[nodiscard]] Index size() const { return Index(first.size()) - 1; }
  [[nodiscard]] std::span<Index32 const> operator[](Index n) const {
    return {item.data() + first[n], std::size_t(first[n + 1] - first[n])};
  }
  void add(std::span<Index32 const> row) {
    item.insert(item.end(), row.begin(), row.end());
    first.push_back(Index(item.size()));
  }
};

/// CsrGraph in a memory space, for kernels.
template <class MemorySpace>
struct CsrViews {
  Kokkos::View<Index const*, MemorySpace> first;
  Kokkos::View<Index32 const*, MemorySpace> item;

  [[nodiscard]] KOKKOS_INLINE_FUNCTION Index size() const { return Index(first.extent(0)) - 1; }
};

namespace detail {

template <class Exec, class T>
Kokkos::View<T const*, typename Exec::memory_space> view_of([[maybe_unused]] Exec const& exec,
                                                            std::vector<T> const& list,
                                                            [[maybe_unused]] char const* label) {
  using MemorySpace = typename Exec::memory_space;
  Kokkos::View<T const*, Kokkos::HostSpace> const host(list.data(), list.size());
  if constexpr (std::is_same_v<MemorySpace, Kokkos::HostSpace>) {
    return host;
  } else {
    Kokkos::View<T*, MemorySpace> device(Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, std::string(label)),
                                         list.size());
    Kokkos::deep_copy(exec, device, host);
    compat::fence(exec, "gridmorph::view_of (the list may go)");
    return device;
  }
}

}  // namespace detail

/// The lists in a memory space that kernels can read: copied, unless that is the host's, where the Views only look at
/// them (the lists must then outlive the Views). Fences `exec` when it copies.
template <class Exec>
CsrViews<typename Exec::memory_space> views(Exec const& exec, CsrGraph const& lists) {
  return {detail::view_of(exec, lists.first, "gridmorph::CsrGraph::first"),
          detail::view_of(exec, lists.item, "gridmorph::CsrGraph::item")};
}

}  // namespace gridmorph
