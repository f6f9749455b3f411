#include <gridmorph/casefile/suggest.hpp>
#include <gridmorph/cli/commands.hpp>
#include <gridmorph/cli/morph_command.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/demo/passage_demo.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace gridmorph::cli {

int run_demo_command(CommandLine const& options, Terminal& terminal) {
  if (options.demo_name != "passage")
    throw ConfigError(
        fmt::format("there is no demo '{}'{}", options.demo_name, suggestion(options.demo_name, {"passage"})));
  std::vector<PassageMotion> motions;
  if (options.demo_motion == "all")
    motions = {rotated_sections(), chord_redesign()};
  else
    motions = {passage_motion(options.demo_motion)};
  auto const folder = options.demo_folder.empty() ? std::filesystem::path("demo_passage") : options.demo_folder;

  PassageOptions passage;
  passage.nodes = options.demo_nodes;
  int status = done;
  for (std::size_t m = 0; m < motions.size(); ++m) {
    terminal.progress(fmt::format("making the passage mesh with {} nodes", options.demo_nodes));
    // The mesh is dropped before the morph reads it from its file: large demos need the memory.
    PassageFiles const files = [&] {
      Mesh const mesh = make_passage(passage);
      return write_passage_demo(folder, passage, motions[m], mesh, m == 0 ? MeshFile::write : MeshFile::keep);
    }();
    terminal.say(fmt::format("{}\n== {} ==\n", m == 0 ? "" : "\n", files.case_file.string()));
    CaseFile case_file = read_case_file(files.case_file);
    auto report = files.morphed;
    case_file.output_options.report = report.replace_extension(".json");
    status = std::max(status, morph_and_write(case_file, terminal));
  }
  return status;
}

}  // namespace gridmorph::cli
