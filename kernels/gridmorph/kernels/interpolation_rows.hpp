// Values as weighted means of other values: rows of an interpolation operator in CSR form.
//
//   value(target_r) = sum over k of w_k source(item_k),   first(r) <= k < first(r + 1),   sum of w_k = 1
//
// Written in differences from the first source, so that equal sources give exactly their value; the weight of the first
// item is never read. Each value is written by its own row alone: results do not depend on the number of threads.
//
// Cost: 12 bytes per row, 8 and a source per item read, a value per row written; sources in cache where rows follow one
// another in space.
#pragma once

#include <gridmorph/kernels/field.hpp>
#include <gridmorph/kernels/launch.hpp>
#include <gridmorph/kernels/packed_vec3.hpp>

#include <type_traits>
#include <vector>

namespace gridmorph::kernels {

template <class MemorySpace>
struct InterpolationTable {
  Kokkos::View<std::int32_t const*, MemorySpace> target;  ///< (n_rows) each once
  Kokkos::View<Index const*, MemorySpace> first;          ///< (n_rows + 1)
  Kokkos::View<std::int32_t const*, MemorySpace> item;
  Kokkos::View<float const*, MemorySpace> weight;

  [[nodiscard]] Index size() const { return Index(target.extent(0)); }
};

/// Layers of rows, each made of values of the ones before. The host keeps where each begins.
template <class MemorySpace>
struct LayerTable {
  InterpolationTable<MemorySpace> rows;
  std::vector<Index> level{0};  ///< first row of each layer, and the end
};

/// The weighted mean that row r makes of source[item].
template <class MemorySpace, class Source>
KOKKOS_INLINE_FUNCTION auto mean_of_row(InterpolationTable<MemorySpace> const& rows, Source const& source, Index r) {
  Index const from = rows.first(r), to = rows.first(r + 1);
  auto const base = as<Vec3>(source[rows.item(from)]);
  std::remove_const_t<decltype(base)> sum{};
  for (Index k = from + 1; k < to; ++k) sum += double(rows.weight(k)) * (as<Vec3>(source[rows.item(k)]) - base);
  return base + sum;
}

/// Source: what source[item] is read from. Value has +, -, and a number times it; Value{} is zero.
template <class MemorySpace, class Source, class Value>
struct InterpolateRows {
  InterpolationTable<MemorySpace> rows;
  Source source;
  Value* value;
  KOKKOS_INLINE_FUNCTION void operator()(Index r) const { put(value[rows.target(r)], mean_of_row(rows, source, r)); }
};

/// Rows begin <= r < end. `source` and `value` may be the same array where no row of them names the target of another.
template <class Exec, class Source, class Value>
void interpolate(char const* label, Exec const& exec, InterpolationTable<typename Exec::memory_space> const& rows,
                 Index begin, Index end, Source const& source, Value* value) {
  launch(label, exec, begin, end, InterpolateRows<typename Exec::memory_space, Source, Value>{rows, source, value});
}
template <class Exec, class Source, class Value>
void interpolate(char const* label, Exec const& exec, InterpolationTable<typename Exec::memory_space> const& rows,
                 Source const& source, Value* value) {
  interpolate(label, exec, rows, 0, rows.size(), source, value);
}

/// Interpolates in place, layer after layer, one launch per layer.
template <class Exec, class Value>
void interpolate_layers(char const* label, Exec const& exec, LayerTable<typename Exec::memory_space> const& layers,
                        Value* value) {
  for (std::size_t l = 0; l + 1 < layers.level.size(); ++l)
    interpolate(label, exec, layers.rows, layers.level[l], layers.level[l + 1], static_cast<Value const*>(value),
                value);
}

}  // namespace gridmorph::kernels
