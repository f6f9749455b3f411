// Unstructured grids of VTK in one piece or several: of a file (.vtu), or of the files that a parallel one (.pvtu)
// names. Internal to io.
#pragma once

#include <gridmorph/io/mesh_io.hpp>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace gridmorph::vtk {

/// Whether the first bytes of a file are those of a parallel unstructured grid.
bool is_parallel(std::string_view head);

/// The files that a parallel one names, as far as they are there.
std::vector<std::filesystem::path> files_of_pieces(std::string const& path);

/// Reads a mesh: the one piece as a zone, several as zones "piece 1", "piece 2", ... as they come. Faces whose points
/// lie in the same places, bit for bit, in two pieces join these: a connection for each two, node by node. Faces on the
/// boundary that no cell covers are the patch `boundary`. Throws IoError and MeshError; for ghost cells, too.
Mesh read_pieces(std::string const& path);

/// Writes the files of `input` with other points, and with fields: one .vtu, or a .pvtu and, in the folder of its name
/// without the ending, the files of its pieces. All appear or none; the one that names the others comes last.
void write_morphed_pieces(std::string const& input, std::string const& output, Mesh const& mesh,
                          Coordinates const& morphed, OutputFields const& fields);

}  // namespace gridmorph::vtk
