// The columns on each wall node, for transposes.
#pragma once

#include <gridmorph/kernels/transposed_walls.hpp>
#include <gridmorph/morph/stages/upload.hpp>
#include <gridmorph/plan/unstructured_plan.hpp>

#include <vector>

namespace gridmorph::stages {

/// Fences.
template <class Exec>
kernels::ColumnsOf<typename Exec::memory_space> columns_of_walls(Exec const& exec, UnstructuredPlan const& plan) {
  std::vector<Index> first(plan.driving.size() + 1, 0);
  for (Index32 const r : plan.columns.root) ++first[r + 1];
  for (std::size_t r = 0; r + 1 < first.size(); ++r) first[r + 1] += first[r];
  std::vector<Index> next = first;
  std::vector<Index32> column(plan.columns.root.size());
  for (std::size_t k = 0; k < column.size(); ++k) column[next[plan.columns.root[k]]++] = Index32(k);
  kernels::ColumnsOf<typename Exec::memory_space> const out{upload(exec, first, "gridmorph::columns_of_walls::first"),
                                                            upload(exec, column, "gridmorph::columns_of_walls")};
  compat::fence(exec, "gridmorph::stages::columns_of_walls (host tables may go)");
  return out;
}

}  // namespace gridmorph::stages
