// All files of a run, looked at together before any work: no output may take the place of an input or of another
// output.
#pragma once

#include <gridmorph/run/loaded_mesh.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace gridmorph::cli {

struct RunFile {
  std::string what;  ///< for messages: "input mesh", "report"
  std::filesystem::path path;
  bool folder_is_made = false;     ///< of an output: its folder need not be there
  std::string_view format = {};    ///< of the input mesh
  std::vector<double> times = {};  ///< of an output that is a series
};
using RunFiles = std::vector<RunFile>;

/// A mesh and what is read with it: its side file (the one beside it when none is given), and files that it links to.
RunFiles inputs_of_mesh(MeshSource const& mesh, std::optional<std::filesystem::path> const& side_file = {});

/// The case file, its mesh, and every file that it names to be read.
RunFiles inputs_of(CaseFile const& case_file, MeshSource const& mesh);

/// The meshes that a run writes and, where they are asked for, its report and page.
RunFiles outputs_of(RunFiles meshes, OutputOptions const& options);

/// Throws one ConfigError for all outputs that cannot be: in a folder that does not exist; a folder, device or pipe; an
/// input, another file that has been read (io::FilesRead) or another output, by whatever name (io::identity_of); or
/// named with the ending of another format than it is written in. An output mesh counts with all files that it is
/// written to. Cost O(n log n) in the number of files.
void check_run_files(RunFiles const& inputs, RunFiles const& outputs);

}  // namespace gridmorph::cli
