// Fillets between blades and end walls in meshes of elements.
#pragma once

#include <gridmorph/fillet/fillet.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>

namespace gridmorph {

struct ElementFillet : FilletFacts {
  Mesh mesh;               ///< with new coordinates, and where elements were cut new elements
  Index cut_elements = 0;  ///< hexahedra that became two prisms; 0: the elements are those that there were
};

/// The mesh of elements with a fillet along all edges in which faces of `blade` and of `end_wall` meet.
///
/// Where one hexahedron takes the whole angle between the walls it would be flat, so hexahedra are cut along the mitre
/// (find_mitre(), cut_corners()); layers of two walls that meet in a mitre already stay as they are. Then space goes
/// from the sharp corner to the round one, in the plane across the corner through each node: a node at the distances x
/// and y from the walls, a along its own wall, goes to
///
///     W(t) + h n(t),   t = (a - d s(a / R)) (1 - u^2),   u = g(x) / g(y),   h = x (g(x) / x)^(1 - s(t / (b / 2))),
///
/// W the new wall over the way t from the middle of the arc and n its normal, d what the fillet is shorter than the
/// corner, R the reach, s the C1 step, b the arc; g how high a layer is where it comes to the mitre (MitreRelations:
/// g(x) = x where both walls have the same layers). From 0.3 to 0.9 radii off the new wall that fades out. Nodes of the
/// walls come onto arcs and walls exactly. Nodes farther along the walls than R, three contact distances, stay bit for
/// bit.
///
/// Throws MeshError for walls that do not meet and elements that cannot be cut, MotionError for a radius that does not
/// fit, with one that would. Cost O(nodes), O(log facets) per node near the corner.
ElementFillet make_fillet(Mesh const& mesh, UnstructuredTopology const& topology,
                          BoundaryFacePatches const& face_patches, FilletOptions const& options);

}  // namespace gridmorph
