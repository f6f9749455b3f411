// A mesh summary as text for terminals and as JSON.
#pragma once

#include <gridmorph/cli/mesh_summary.hpp>

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace gridmorph::cli {

/// `quality`: the quality table of the mesh, printed before the case file; may be empty.
std::string inspect_text(MeshSummary const& summary, std::string const& quality = {});

/// A case file to start from: it names every boundary, moves nothing, and runs as it stands on meshes without problems.
std::string case_snippet(MeshSummary const& summary);

nlohmann::json inspect_json(MeshSummary const& summary);

}  // namespace gridmorph::cli
