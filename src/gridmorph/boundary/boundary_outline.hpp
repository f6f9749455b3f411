// The boundary of an unstructured mesh in the form that motion rules are resolved and evaluated on.
#pragma once

#include <gridmorph/boundary/patch_faces.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>

#include <cstdint>
#include <vector>

namespace gridmorph {

/// A structured mesh with one zone per patch, its nodes side by side along i, and one per connection: names, families, kinds and
/// positions of the boundary, but no faces. Patch p and interface c are those of the unstructured mesh.
///
/// Selectors, defaults, conflicts and everything that follows from the positions of a patch's nodes (planes, profiles of
/// revolution, formulas) are then the structured engine's own. A patch of a 2-D mesh, a line, has a second row of nodes across
/// the mesh's plane, so that it has a plane of its own. Cost O(boundary nodes).
Mesh boundary_outline(Mesh const& mesh, std::vector<std::vector<Index32>> const& nodes_of_patch);

/// The faces of the patches that `wanted` marks (per patch) on the nodes of the outline, fans of triangles where they have more than four
/// corners. Cost O(their nodes, log).
PatchFaces patch_faces(Mesh const& mesh, UnstructuredTopology const& topology, BoundaryFacePatches const& face_patches,
                       std::vector<std::vector<Index32>> const& nodes_of_patch,
                       std::vector<std::uint8_t> const& wanted);

/// Nodes of each patch, ascending: those of the boundary faces it got, or all it lists where it got none.
std::vector<std::vector<Index32>> nodes_of_patches(Mesh const& mesh, UnstructuredTopology const& topology,
                                                   BoundaryFacePatches const& face_patches);

}  // namespace gridmorph
