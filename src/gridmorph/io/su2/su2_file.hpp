// Meshes in SU2's text format (https://su2code.github.io/docs_v7/Mesh-File).
#pragma once

#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <string>

namespace gridmorph::su2 {

/// Whether a file is a text whose first keyword is one of SU2's. False for files that cannot be read.
bool is_su2(std::string const& path);

/// Reads a mesh. Throws IoError with the number of the line.
Mesh read(std::string const& path);

/// Copies the file and replaces the coordinates that changed, as text that reads back to the same bits.
void write_morphed(std::string const& input, std::string const& output, Mesh const& mesh, Coordinates const& morphed);

}  // namespace gridmorph::su2
