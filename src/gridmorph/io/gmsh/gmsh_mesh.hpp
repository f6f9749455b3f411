// Meshes of Gmsh: MSH 2.2 and 4.1 as text and binary, 4.0 as text. Internal to io.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <string>
#include <string_view>

namespace gridmorph::gmsh {

/// Whether the first bytes of a file are those of a Gmsh mesh of any version.
bool is_gmsh(std::string_view head);

/// Reads a mesh: the elements of the highest dimension, with the nodes that they use, in the order of the file.
/// Elements one dimension lower are patches by their physical groups (name, or "physical surface 7"), without one by
/// their piece of geometry ("surface 5"); those in several groups are patches with all of these as families. Periodic
/// links become connections. Throws IoError and MeshError.
Mesh read(std::string const& path);

/// Copies the file and replaces the coordinates that changed, text as text that reads back to the same bits, binary in
/// place.
void write_morphed(std::string const& input, std::string const& output, Mesh const& mesh, Coordinates const& morphed);

}  // namespace gridmorph::gmsh
