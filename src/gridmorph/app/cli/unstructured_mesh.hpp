// What inspect and quality do with unstructured meshes.
#pragma once

#include <gridmorph/app/cli/inspect_text.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>
#include <gridmorph/quality/quality.hpp>

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace gridmorph::cli {

/// A mesh, in order by position where its file scatters it, with what follows from it.
struct LoadedMesh {
  UnstructuredMesh mesh;
  UnstructuredTopology topology;
  BoundaryFacePatches face_patches;
  std::vector<signed char> signs;     ///< numbering_signs() of the mesh
  std::vector<std::string> problems;  ///< what stops a morph: open faces, ...
  std::vector<std::string> remarks;   ///< what does not: elements that are numbered inside out
};

/// As load_unstructured_mesh() of side_file.hpp.
LoadedMesh load_unstructured(std::filesystem::path const& path,
                             std::optional<std::filesystem::path> const& side_file = {},
                             std::vector<std::string> const& leave_out = {});

/// Quality at all wall patches; of `morphed` against the mesh itself where it is given.
QualityReport measure_mesh(LoadedMesh const& loaded, std::optional<Coordinates> const& morphed = {}, bool fast = false);

/// Coordinates of b, as it was read, in the order of the loaded mesh a. Throws MeshError unless both have the same zones,
/// nodes and elements.
Coordinates coordinates_of_same_mesh(UnstructuredMesh const& a, UnstructuredMesh b);

/// Boundaries by the names that rules use, what they look like and how they meet; the axis.
MeshSummary summarize(LoadedMesh const& loaded);

/// Zones, boundaries, connections, notes, remarks and problems, `quality`, and a case file to start from.
std::string inspect_text(LoadedMesh const& loaded, MeshSummary const& summary, std::string const& quality,
                         SnippetOptions const& options);
nlohmann::json inspect_json(LoadedMesh const& loaded, MeshSummary const& summary, SnippetOptions const& options);

}  // namespace gridmorph::cli
