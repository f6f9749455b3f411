#include <gridmorph/cli/commands.hpp>
#include <gridmorph/cli/inspect_text.hpp>
#include <gridmorph/io/mesh_io.hpp>

#include <nlohmann/json.hpp>

namespace gridmorph::cli {

int run_inspect_command(CommandLine const& options, Terminal& terminal) {
  terminal.progress("reading " + options.input.string());
  Mesh const mesh = read_mesh(options.input.string());
  terminal.progress("looking at boundaries and connections");
  MeshSummary const summary = summarize(mesh);
  terminal.result(options.json ? inspect_json(summary).dump(2, ' ', false, nlohmann::json::error_handler_t::replace)
                               : inspect_text(summary));
  return done;
}

}  // namespace gridmorph::cli
