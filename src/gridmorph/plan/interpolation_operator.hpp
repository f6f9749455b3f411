// Displacements as weighted means of other displacements: what every stage of an unstructured morph is made of.
//
// A row says: value(target) = sum over k of weight[k] * source(item[k]), the weights of a row summing to one. Rows are planned
// once on the host and applied many times; each value is written by its own row only, so that results do not depend on the
// number of threads.
#pragma once

#include <gridmorph/kernels/field.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <Kokkos_Core.hpp>

#include <span>
#include <string>
#include <vector>

namespace gridmorph {

struct InterpolationOperator {
  std::vector<Index32> target;  ///< (n_rows) each once
  std::vector<Index> first{0};  ///< (n_rows + 1)
  std::vector<Index32> item;
  /// Single precision: a displacement moves by 1e-7 of the differences between its sources. The weight of a row's first item is
  /// taken to be what the others leave of one, so that equal sources give exactly their value.
  std::vector<float> weight;

  [[nodiscard]] Index size() const { return Index(target.size()); }
  /// Appends a row; `weights` need not be normalised, their sum must be positive.
  void add(Index32 row_target, std::span<Index32 const> items, std::span<double const> weights);
};

namespace detail {

/// A list in a View of its own; fences.
template <class MemorySpace, class T>
Kokkos::View<T*, MemorySpace> copy_of(std::vector<T> const& list, char const* label) {
  Kokkos::View<T*, MemorySpace> copy(Kokkos::view_alloc(Kokkos::WithoutInitializing, std::string(label)), list.size());
  Kokkos::deep_copy(copy, view_of<Kokkos::HostSpace>(list, label));
  return copy;
}

}  // namespace detail

/// InterpolationOperator in a memory space.
template <class MemorySpace>
struct InterpolationViews {
  Kokkos::View<Index32*, MemorySpace> target;
  Kokkos::View<Index*, MemorySpace> first;
  Kokkos::View<Index32*, MemorySpace> item;
  Kokkos::View<float*, MemorySpace> weight;

  InterpolationViews() = default;
  /// Copies the rows; fences.
  explicit InterpolationViews(InterpolationOperator const& rows)
      : target(detail::copy_of<MemorySpace>(rows.target, "gridmorph::InterpolationOperator::target")),
        first(detail::copy_of<MemorySpace>(rows.first, "gridmorph::InterpolationOperator::first")),
        item(detail::copy_of<MemorySpace>(rows.item, "gridmorph::InterpolationOperator::item")),
        weight(detail::copy_of<MemorySpace>(rows.weight, "gridmorph::InterpolationOperator::weight")) {}
  [[nodiscard]] Index size() const { return Index(target.extent(0)); }
};

/// value(target[r]) = row r of `source`, for rows begin <= r < end. value and source may be the same View when no row of the
/// range names the target of another. Enqueues one kernel; per row: 12 bytes, per item: 8 bytes and a source of 24.
template <class Exec>
void gather(Exec const& exec, InterpolationViews<typename Exec::memory_space> const& rows, Index begin, Index end,
            Kokkos::View<Vec3 const*, typename Exec::memory_space> source,
            Kokkos::View<Vec3*, typename Exec::memory_space> value);

/// The same from three component arrays, for all rows.
template <class Exec>
void gather(Exec const& exec, InterpolationViews<typename Exec::memory_space> const& rows,
            kernels::Field<double const> source, Kokkos::View<Vec3*, typename Exec::memory_space> value);

}  // namespace gridmorph
