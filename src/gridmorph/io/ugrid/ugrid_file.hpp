// Meshes of AFLR3 and of what reads its files (FUN3D, ...): UGRID as text, C binary and Fortran unformatted. Internal
// to io.
//
// Format: SimCenter, "UGRID grid file type": seven counts, nodes, triangles, quadrilaterals, their surface numbers,
// tetrahedra, pyramids, prisms, hexahedra. The file does not say how it is stored; the word before its ending does:
// mesh.b8.ugrid.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <string>

namespace gridmorph::ugrid {

/// Whether a name ends in ".ugrid".
bool is_ugrid(std::string const& path);

/// The file with the names of the surfaces, beside a mesh, there or not.
std::string mapbc_of(std::string const& path);

/// Reads a mesh. Faces of one surface number are a patch, "surface 3", or with the name and kind that a file mesh.mapbc
/// beside it gives. Throws IoError and MeshError.
Mesh read(std::string const& path);

/// Copies the file and replaces the coordinates that changed, in their precision; text reads back to the same bits.
void write_morphed(std::string const& input, std::string const& output, Mesh const& mesh, Coordinates const& morphed);

}  // namespace gridmorph::ugrid
