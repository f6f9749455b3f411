// What the shape of a boundary says about its role, for files whose names do not.
#pragma once

#include <gridmorph/cli/mesh_summary.hpp>

namespace gridmorph::cli {

/// Fills BoundarySummary::guess of every boundary from its nodes: planes, surfaces of revolution, thin first cells, the
/// outer hull. Suggestions for the reader, never used for morphing. Cost: O(boundary nodes log boundary nodes).
void guess_roles(Mesh const& mesh, MeshSummary& summary);

}  // namespace gridmorph::cli
