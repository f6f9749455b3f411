// Elements of a mesh one by one: their sides, their numbers in the file, what must hold of them.
//
// What follows from all of them (neighbours, boundary faces, coincident nodes) is in unstructured_topology.hpp.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <array>
#include <span>
#include <string>
#include <vector>

namespace gridmorph {

/// Number of sides of an element: faces in 3-D, edges in 2-D.
int n_sides(Mesh const& mesh, Index element);
/// Corner nodes of one side, the normal pointing outwards; each once, so that collapsed sides have fewer. `room` holds
/// them unless the element is a polyhedron.
std::span<Index32 const> side_nodes(Mesh const& mesh, Index element, int side,
                                    std::array<Index32, max_face_corners>& room);

/// A further node of a second-order element on one of its sides.
struct MiddleNode {
  Index32 node = 0;
  std::vector<Index32> amid;  ///< corners of the edge, or of the side, ascending
};
/// The further nodes on a side: those amid its edges, then the one amid the side where the element has such nodes.
std::vector<MiddleNode> side_middle_nodes(Mesh const& mesh, Index element, int side);

/// Unit normal along which the elements of a 2-D mesh are positive: the axis along which it is constant, otherwise the
/// mean normal of its elements. (0, 0, 1) for a 3-D mesh.
Vec3 plane_normal(Mesh const& mesh);

/// The normal of a face, summed over the fan of triangles from its first node; twice as long as its area.
Vec3 face_normal(std::span<Index32 const> nodes, Coordinates const& coordinates);

/// All nodes of a patch, ascending, each once.
std::vector<Index32> patch_nodes(Patch const& patch);

/// Elements of each type, in all zones or in one.
std::array<Index, n_element_types> count_types(Mesh const& mesh, int zone = -1);

/// The name of an element in messages: "zone 'Fluid' tetrahedron 4711", as the file counts; of a block "zone 'Box' cell
/// (i 3, j 1, k 7)".
std::string describe_element(Mesh const& mesh, Index element);
/// The numbers by which the file knows a node and an element of its zone.
Index node_number_in_file(BoundaryMesh const& mesh, Index node);
Index number_in_file(Mesh const& mesh, Index element);

/// Checks what readers and generators must guarantee: node and element ranges, node numbers inside their zone, as many
/// nodes as a type asks for, no node twice in a corner list of patches. Throws MeshError that lists all problems.
/// Linear cost.
void check_mesh(Mesh const& mesh);

}  // namespace gridmorph
