// Nodes of a model that are given more than once. Internal.
#pragma once

#include <gridmorph/mapping/structural_model.hpp>

#include <vector>

namespace gridmorph::mapping {

/// Keeps the first of nodes at equal positions, in the model, its elements and all fields (fields)(nodes). A
/// quadrilateral that loses a corner so becomes a triangle. Throws ConfigError when their displacements differ by more
/// than 1e-6 of the largest of the field. Cost O(n log n).
void merge_nodes(StructuralModel& model, std::vector<std::vector<Vec3>>& fields);

}  // namespace gridmorph::mapping
