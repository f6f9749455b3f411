// How other formats number the nodes of elements, as against the CGNS standard (SIDS), whose order a Mesh has. Internal
// to io.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace gridmorph::io {

/// Elements with `nodes` nodes of a type that a mesh holds, and the order of these: node k of the SIDS is node order[k]
/// of the file; empty where the orders are the same.
struct FileShape {
  int dimension = -1;  ///< 0 point, 1 edge, 2 surface, 3 volume; -1: not read
  ElementType type = ElementType::triangle;
  int corners = 0, nodes = 0;
  std::span<std::uint8_t const> order = {};
};

/// The shape of an element type of Gmsh (reference manual, "Node ordering"), first and second order.
FileShape gmsh_shape(std::int64_t type);
/// The shape of a cell type of VTK (vtkCellType.h and the classes of cells), first and second order.
FileShape vtk_shape(std::int64_t type);

/// Turns over the nodes of a prism in SIDS order, first or second, with bottom and top seen from the other side.
void turn_prism(std::span<Index32> nodes);

/// Bottom triangles of prisms point inwards in CGNS; programs that write VTK's cell types do it either way. Turns over
/// all prisms of a mesh where that makes more of them positive; returns whether it did.
bool orient_prisms(Mesh& mesh);

}  // namespace gridmorph::io
