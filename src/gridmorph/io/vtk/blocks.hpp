// Meshes in several files of VTK that a multi-block file (.vtm) names. Internal to io.
#pragma once

#include <gridmorph/io/mesh_io.hpp>

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace gridmorph::vtk {

/// Whether the first bytes of a file are those of a multi-block data set.
bool is_blocks(std::string_view head);

/// The files that it names, as far as they are there.
std::vector<std::filesystem::path> files_of_blocks(std::string const& path);

/// "mesh/mesh_3.vtu": how the files are named that stand beside an output of several.
std::filesystem::path name_beside(std::filesystem::path const& output, std::size_t number, std::string const& ending);
/// All that writing the morphed mesh of `input`, of blocks or pieces, makes beside the output.
std::vector<std::filesystem::path> files_beside(std::string const& input, std::filesystem::path const& output);

/// Reads a mesh: blocks of cells of the highest dimension (.vtu) are zones, blocks one dimension lower (.vtu, .vtp)
/// patches of the zones whose nodes lie at their points (1e-6 of the mesh size), all by the names of the blocks. Throws
/// IoError and MeshError.
Mesh read_blocks(std::string const& path);

/// The file `output` and, in the folder of its name without the ending, the files of its blocks with other points and
/// with fields; points of surfaces go along with the nodes that lie there. All appear or none, the one that names the
/// others last.
void write_morphed_blocks(std::string const& input, std::string const& output, Mesh const& mesh,
                          Coordinates const& morphed, OutputFields const& fields);

}  // namespace gridmorph::vtk
