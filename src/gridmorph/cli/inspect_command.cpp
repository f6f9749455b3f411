#include <gridmorph/cli/commands.hpp>
#include <gridmorph/cli/inspect_text.hpp>
#include <gridmorph/cli/unstructured_mesh.hpp>
#include <gridmorph/cli/workflow.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/io/unstructured_io.hpp>
#include <gridmorph/report/quality_json.hpp>
#include <gridmorph/report/quality_table.hpp>

#include <nlohmann/json.hpp>

namespace gridmorph::cli {

namespace {

int inspect_unstructured(CommandLine const& options, Terminal& terminal) {
  terminal.progress("reading " + options.input.string());
  LoadedMesh const loaded = load_unstructured(options.input);
  terminal.progress("measuring quality");
  QualityReport const quality = measure_mesh(loaded);
  if (options.json) {
    nlohmann::json json = inspect_json(loaded);
    json["quality"] = quality_json(quality, {}, {});
    terminal.result(json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
  } else {
    terminal.result(inspect_text(loaded, format_table(quality)));
  }
  return done;
}

}  // namespace

int run_inspect_command(CommandLine const& options, Terminal& terminal) {
  if (mesh_kind(options.input.string()) == MeshKind::unstructured) return inspect_unstructured(options, terminal);
  terminal.progress("reading " + options.input.string());
  Mesh const mesh = read_mesh(options.input.string());
  terminal.progress("looking at boundaries and connections");
  MeshSummary const summary = summarize(mesh);
  terminal.progress("measuring quality");
  QualityReport const quality = measure_mesh(mesh);
  if (options.json) {
    nlohmann::json json = inspect_json(summary);
    json["quality"] = quality_json(quality, {}, {});
    terminal.result(json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
  } else {
    terminal.result(inspect_text(summary, format_table(quality)));
  }
  return done;
}

}  // namespace gridmorph::cli
