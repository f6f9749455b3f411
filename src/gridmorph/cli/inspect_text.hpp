// A mesh summary as text for terminals and as JSON.
#pragma once

#include <gridmorph/cli/mesh_summary.hpp>

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace gridmorph::cli {

std::string inspect_text(MeshSummary const& summary);

/// A case file to start from: it names every boundary, moves nothing, and runs as it stands on meshes without problems.
std::string case_snippet(MeshSummary const& summary);

nlohmann::json inspect_json(MeshSummary const& summary);

}  // namespace gridmorph::cli
