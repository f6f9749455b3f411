// Meshes in VTK's XML format for unstructured grids (.vtu). Internal to io.
#pragma once

#include <gridmorph/io/mesh_io.hpp>

#include <string>
#include <string_view>

namespace gridmorph::vtk {

/// Whether the first bytes of a file are those of an unstructured grid in XML.
bool is_vtu(std::string_view head);

/// Reads a mesh: the cells of the highest dimension with the points that they use, in the order of the file. Cells one
/// dimension lower are patches by the number that a cell array gives them; faces that none covers are the patch
/// `boundary`. Throws IoError and MeshError.
Mesh read(std::string const& path);

/// Copies the file, replaces its points where they changed, and adds fields to PointData and CellData. `morphed` and
/// fields are numbered as the mesh.
void write_morphed(std::string const& input, std::string const& output, Mesh const& mesh, Coordinates const& morphed,
                   OutputFields const& fields);

}  // namespace gridmorph::vtk
