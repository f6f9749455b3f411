// What inspect and quality do with unstructured meshes.
#pragma once

#include <gridmorph/cli/mesh_summary.hpp>
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
  BoundaryClaims claims;
  std::vector<signed char> signs;     ///< numbering_signs() of the mesh
  std::vector<std::string> problems;  ///< open faces, elements that are numbered inside out, ...
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

/// Zones, boundaries, connections, notes and problems; `quality` is printed last.
std::string inspect_text(LoadedMesh const& loaded, std::string const& quality);
nlohmann::json inspect_json(LoadedMesh const& loaded);

/// What a first case file needs to know: boundaries by the names that rules use, which of them are flat, the axis.
MeshSummary summarize(LoadedMesh const& loaded);

}  // namespace gridmorph::cli
