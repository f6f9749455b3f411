// Whether the tables of a plan that came from outside can be handed to kernels.
#pragma once

#include <gridmorph/plan/plan.hpp>

namespace gridmorph::detail {

/// Throws Damaged (archive.hpp), naming the table, unless every node, slot, value, parameter and entry that kernels
/// reach by the numbers of the plan exists, every node is written, and no table asks for more memory than its mesh
/// needs. Displacements that a wrong plan gives are not looked at. Cost: O(entries).
void check_plan(Plan const& plan, Index n_nodes);

}  // namespace gridmorph::detail
