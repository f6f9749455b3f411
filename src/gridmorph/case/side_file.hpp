// The side file of a mesh (TOML): patches, interfaces and periodicity of meshes whose own files do not say them.
//
// "wing.toml" beside "wing.p3d", or side_file in [mesh] of a case file. The keys are described in docs/formats.md.
#pragma once

#include <gridmorph/boundary/find_interfaces.hpp>
#include <gridmorph/mesh/mesh.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace gridmorph {

/// The side file that belongs to a mesh: same folder, same name with the ending .toml. Nothing when there is none, or
/// when the file of that name is a case file (has [mesh] or [[motion]]).
std::optional<std::filesystem::path> find_side_file(std::filesystem::path const& mesh);

/// Reads a mesh of any format and adds what its side file says. `side_file`: the one to use; otherwise that of
/// find_side_file(), if any. Throws the errors of read_mesh, and one ConfigError that lists every problem of the side
/// file as "file:line: what, found, what to do". `leave_out`: as in ReadOptions.
Mesh load_mesh(std::filesystem::path const& mesh, std::optional<std::filesystem::path> const& side_file = {},
               std::vector<std::string> const& leave_out = {});

/// Adds patches and interfaces of a side file's text to a mesh of blocks; to one of elements what its markers are and
/// which of them are periodic. `path` names it in messages.
void add_side_file(std::string const& text, std::filesystem::path const& path, Mesh& mesh);

/// A side file for a mesh: the interfaces that were found, and a patch for every rectangle of a zone face that is left.
/// Rectangles that continue one another have one name, for the user to change. `existing`: text of
/// the mesh's present side file, which comes first as it is.
std::string side_file_text(Mesh const& mesh, FoundInterfaces const& found, std::string const& existing = {});

}  // namespace gridmorph
