// Meshes of OpenFOAM: folders polyMesh with points, faces, owner, neighbour and boundary. Internal to io.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <filesystem>
#include <optional>
#include <string>

namespace gridmorph::foam {

/// The polyMesh folder that a path stands for: a case, a folder above polyMesh, polyMesh itself, an empty file case.foam in a case.
/// Nothing where there is none.
std::optional<std::filesystem::path> poly_mesh(std::filesystem::path const& path);

/// Reads the mesh of a path as poly_mesh() takes it. Cells with the faces of a usual shape become one, the others polyhedra. Patches keep
/// their names, and their type as BC type; groups beside that of the type are families. Matching cyclics become connections; planes of
/// type `empty` are symmetry planes, one patch for each. Throws IoError and MeshError.
Mesh read(std::string const& path);

/// Copies the polyMesh folder of `input` to that of `output`, which is made and must not hold another mesh, and replaces the points that
/// changed, in their format and precision; text reads back to the same bits. points go into place last.
void write_morphed(std::string const& input, std::string const& output, Mesh const& mesh, Coordinates const& morphed);

}  // namespace gridmorph::foam
