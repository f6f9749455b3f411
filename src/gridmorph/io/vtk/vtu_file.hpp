// An unstructured grid in a file of VTK (.vtu), as it stands there. Internal to io.
#pragma once

#include <gridmorph/core/csr_graph.hpp>
#include <gridmorph/io/vtk/xml_file.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace gridmorph::vtk {

/// Cell types without a fixed number of nodes (vtkCellType.h).
inline constexpr std::uint8_t poly_vertex = 2, poly_line = 4, triangle_strip = 6, polygon = 7, polyhedron = 42;

/// A Piece of a file that has cells.
struct Grid {
  Tag const* piece = nullptr;
  Tag const* points = nullptr;  ///< the array
  Index n_points = 0, n_cells = 0;
  std::vector<double> coordinates;  ///< three each
  std::vector<std::uint8_t> type;   ///< VTK's number
  CsrGraph nodes;
  /// The faces of polyhedra: their number, then for each the number of its nodes and these. faces_end: behind the last
  /// number of each cell, -1 of cells that are none.
  std::vector<std::int64_t> faces, faces_end;
};

/// All grids of a file, in its order. Polyhedra are read in the layout of VTK before 9.4 ("faces", "faceoffsets") and
/// in that since ("face_connectivity", "face_offsets", "polyhedron_to_faces", "polyhedron_offsets"). Throws IoError and
/// MeshError for numbers that do not fit one another, and for pieces with ghost cells.
std::vector<Grid> read_grids(XmlFile const& file);
/// The only grid of a file. Throws IoError where there are none, or several.
Grid read_grid(XmlFile const& file);

/// Dimension of the cells of highest dimension; 0 where there are none of surfaces or volumes.
int dimension_of(Grid const& grid);
/// The dimension of one cell: 0 to 3; -1 where its type is not read.
int dimension_of_cell(std::uint8_t type);

/// Cell array by which 2-D cells are put into patches, and names of these where the file has them: number k is the k-th
/// name.
struct Markers {
  std::string array;
  std::vector<std::int64_t> of_cell;
  std::vector<std::string> names;
};
std::optional<Markers> read_markers(XmlFile const& file, Grid const& grid);

/// The name under which names of patches stand in FieldData.
inline constexpr char const* patch_names = "PatchNames";

}  // namespace gridmorph::vtk
