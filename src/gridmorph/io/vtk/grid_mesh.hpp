// One grid of a VTK file as a mesh of one zone, and back. Internal to io.
#pragma once

#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/io/vtk/vtu_file.hpp>

#include <string>

namespace gridmorph::vtk {

/// The cells of the highest dimension, patches by cells one dimension lower. Throws MeshError.
Mesh mesh_of(XmlFile const& file, Grid const& grid);

/// Faces on the boundary that no patch has become the patch `boundary`, zone by zone.
void add_rest_of_boundary(Mesh& mesh);

/// The text of the file with other points, and with fields. `before` and `after`: coordinates, and fields, in the order of the file. Throws IoError where
/// `n_elements` and the coordinates are not those of the grid.
std::string morphed_text(XmlFile const& file, int dimension, Index n_elements, Coordinates const& before,
                         Coordinates const& after, OutputFields const& fields);

}  // namespace gridmorph::vtk
