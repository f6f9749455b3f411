// One grid of a VTK file as a mesh of one zone, and back. Internal to io.
#pragma once

#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/io/vtk/vtu_file.hpp>

#include <span>
#include <string>
#include <vector>

namespace gridmorph::vtk {

/// The mesh of a grid: its cells of the highest dimension, patches by cells one dimension lower. Throws MeshError.
Mesh mesh_of(XmlFile const& file, Grid const& grid);

/// Meshes of one zone each as one mesh of zones with those names.
Mesh joined(std::vector<std::string> const& names, std::vector<Mesh> const& meshes);

/// A zone's own part of what all zones have.
Coordinates part(Coordinates const& all, Zone const& zone);
OutputFields part(OutputFields const& all, Zone const& zone);

/// Fields in the order of the mesh that was read, before it was put in another order.
OutputFields in_order_of_the_file(Mesh const& mesh, OutputFields const& fields);

/// What goes before the names of fields, "Morph" where one of them is taken in a piece.
struct FieldPrefixes {
  std::string points, cells;
};
FieldPrefixes field_prefixes(std::span<Grid const* const> grids, OutputFields const& fields);

/// What gives a grid other points, and fields. `before` and `after`: its coordinates, and fields, in the order of the
/// file. Throws IoError where `n_elements` and the coordinates are not those of the grid.
void morph_grid(XmlFile const& file, Grid const& grid, int dimension, Index n_elements, Coordinates const& before,
                Coordinates const& after, OutputFields const& fields, FieldPrefixes const& prefixes,
                std::vector<Edit>& edits);
/// The text of a file with one grid, with other points and fields.
std::string morphed_text(XmlFile const& file, int dimension, Index n_elements, Coordinates const& before,
                         Coordinates const& after, OutputFields const& fields);

/// Puts text at the end of what a tag of a name holds in `parent`; where there is none it is made.
void append_inside(Tag const& parent, std::string const& name, std::string const& text, std::vector<Edit>& edits);

}  // namespace gridmorph::vtk
