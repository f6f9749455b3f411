// PLOT3D grid files in and out, behind read_mesh and write_morphed.
#pragma once

#include <gridmorph/io/mesh_io.hpp>

#include <string>

namespace gridmorph::plot3d {

/// Reads zones ("zone 1", ...) and coordinates; no patches and no interfaces, because the format has none.
Mesh read(std::string const& path, ReadOptions const& options);

/// Copies `input` to `output` and replaces the coordinates, in the same variant; iblank and everything else comes
/// through byte for byte, and so do coordinates that do not change.
void write(std::string const& input, std::string const& output, Mesh const& mesh, Coordinates const& morphed);

}  // namespace gridmorph::plot3d
