// A mesh summary as text for terminals and as JSON.
#pragma once

#include <gridmorph/run/mesh_summary.hpp>

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace gridmorph::cli {

/// What a suggested case file needs to know beside the mesh.
struct SnippetOptions {
  std::filesystem::path folder = ".";              ///< where it will be: paths in it start there
  std::optional<std::filesystem::path> side_file;  ///< where the mesh's own is not the one
  std::vector<std::string> leave_out;              ///< as the mesh was read
};

/// `quality`: the quality table of the mesh, printed before the case file; may be empty.
std::string inspect_text(MeshSummary const& summary, std::string const& quality, SnippetOptions const& options);

/// A case file to start from: it names every boundary and moves nothing. It runs as it stands on meshes whose problems
/// it can remedy, and again when one of the motions in it is given numbers: walls that touch move as one, boundaries
/// that moving walls end on let their nodes slide.
std::string case_snippet(MeshSummary const& summary, SnippetOptions const& options = {});
/// Why there is no such case file: nothing in the mesh could be moved; empty where there is one.
std::string why_no_case(MeshSummary const& summary);

/// The table of boundaries, and what is to say about each.
std::string boundaries_text(MeshSummary const& summary);

nlohmann::json inspect_json(MeshSummary const& summary, SnippetOptions const& options);

}  // namespace gridmorph::cli
