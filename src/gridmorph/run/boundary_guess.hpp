// What the shape of boundaries suggests about their role.
#pragma once

#include <gridmorph/run/mesh_summary.hpp>

#include <vector>

namespace gridmorph::cli {

/// What a guess is made from.
struct BoundaryShape {
  std::vector<std::vector<Vec3>> patches;  ///< nodes of each patch of the boundary
  bool side_of_two_dimensions = false;     ///< one cell thick away from it: a side of a 2-D mesh
};

/// The nodes of each boundary of a structured mesh, patch by patch; none for ranges outside their zone.
std::vector<BoundaryShape> shapes_of(Mesh const& mesh, MeshSummary const& summary);

/// Fills BoundarySummary::guess, flat and enclosed. shapes[b] belongs to boundary b. Lines of a 2-D mesh in a plane x,
/// y or z = constant are looked at as walls across their plane. Cost: O(nodes).
void guess_roles(Coordinates const& coordinates, std::vector<BoundaryShape> const& shapes, MeshSummary& summary);

}  // namespace gridmorph::cli
