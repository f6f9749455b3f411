// One case file from an unstructured mesh to its morphed copy, quality and pictures of the stages.
#pragma once

#include <gridmorph/app/casefile/case_file.hpp>
#include <gridmorph/app/cli/terminal.hpp>

namespace gridmorph::cli {

/// `gridmorph morph` on an unstructured mesh; returns the exit status. Throws what reading, planning and writing throw; writes
/// nothing then.
int morph_unstructured(CaseFile const& case_file, Terminal& terminal);

/// `gridmorph plan`, and `morph --dry-run`: what the walls, regions, layers and the background mesh are, notes first.
/// `json` has what is known without the mesh.
void print_unstructured_plan(CaseFile const& case_file, nlohmann::json json, Terminal& terminal);

}  // namespace gridmorph::cli
