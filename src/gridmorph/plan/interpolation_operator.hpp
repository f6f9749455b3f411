// Displacements as weighted means of other displacements: what every stage of an unstructured morph is made of.
//
// A row says: value(target) = sum over k of weight[k] * source(item[k]), the weights of a row summing to one. Rows are
// planned once on the host and applied many times (kernels/interpolation_rows.hpp).
#pragma once

#include <gridmorph/core/csr_graph.hpp>

#include <span>
#include <vector>

namespace gridmorph {

struct InterpolationOperator {
  std::vector<Index32> target;  ///< (n_rows) each once
  std::vector<Index> first{0};  ///< (n_rows + 1)
  std::vector<Index32> item;
  /// Single precision: a displacement moves by 1e-7 of the differences between its sources. The weight of a row's first
  /// item is taken to be what the others leave of one, so that equal sources give exactly their value.
  std::vector<float> weight;

  [[nodiscard]] Index size() const { return Index(target.size()); }
  /// Appends a row; `weights` need not be normalised, their sum must be positive.
  void add(Index32 row_target, std::span<Index32 const> items, std::span<double const> weights);
};

}  // namespace gridmorph
