// Unstructured meshes around bodies, cut and joined from simpler ones.
#pragma once

#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <functional>
#include <string>

namespace gridmorph::test {

/// The elements whose centre (mean of the corners) is kept, with their nodes in the order they had; one zone. Boundary
/// faces that no patch had become the patch `cut`; patches that lose all faces go.
Mesh part_of(Mesh const& mesh, std::function<bool(Vec3 const& centre)> const& keep, std::string const& cut,
             PatchKind kind);

/// The same mesh in two zones: elements whose centre is not `first` make up the second one. Both have their copies of
/// the nodes between them, which a connection and its counterpart list.
Mesh in_two_zones(Mesh const& mesh, std::function<bool(Vec3 const& centre)> const& first);

/// The same elements of second order: with a node in the middle of each edge and, where wanted, of each quadrilateral
/// face and hexahedron. `to` then moves all nodes, so that edges are curved as it curves them.
Mesh second_order(Mesh const& mesh, bool all_nodes = false, std::function<Vec3(Vec3 const&)> const& to = {});

/// The same elements as polyhedra, their faces listed one by one.
Mesh as_polyhedra(Mesh const& mesh);

/// The same nodes with polyhedra among the elements: two of three pairs of elements that meet across side `side` of the
/// first are one.
Mesh with_joined_elements(Mesh const& mesh, int side);

/// A box of n cells of size 1 without those whose centre is in the body, of hexahedra, or of tetrahedra. Patch "body"
/// (a wall), the six sides "i_min" ... "k_max" as farfield.
Mesh box_around(Index3 n, std::function<bool(Vec3 const& centre)> const& body, bool tetrahedra = false);

/// A symmetric wing section (NACA 0012, chord 1 from the origin along x) in a circle of radius `far`: `around` columns,
/// of quadrilaterals for the first `layers` cells and of triangles beyond, the first one `first` high, each `growth`
/// times the one below. Patches "airfoil", "farfield".
Mesh airfoil(int around, int layers, double first, double growth, double far);

}  // namespace gridmorph::test
