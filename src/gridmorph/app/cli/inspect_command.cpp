#include <gridmorph/app/casefile/side_file.hpp>
#include <gridmorph/app/cli/commands.hpp>
#include <gridmorph/app/cli/inspect_text.hpp>
#include <gridmorph/app/cli/output_files.hpp>
#include <gridmorph/app/cli/run_files.hpp>
#include <gridmorph/app/cli/unstructured_mesh.hpp>
#include <gridmorph/app/cli/workflow.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/io/read_file.hpp>
#include <gridmorph/io/unstructured_io.hpp>
#include <gridmorph/report/quality_json.hpp>
#include <gridmorph/report/quality_table.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

namespace gridmorph::cli {

namespace {

SnippetOptions snippet_options(CommandLine const& options) {
  SnippetOptions out;
  if (options.suggest && !options.suggest->empty())
    if (auto const folder = std::filesystem::path(*options.suggest).parent_path(); !folder.empty()) out.folder = folder;
  // What is written beside the mesh under its name is found without being told.
  auto const side = options.write_side_file ? options.write_side_file : options.side_file;
  std::error_code ignored;
  auto const own = find_side_file(options.input);
  if (side && !(own && std::filesystem::equivalent(*side, *own, ignored))) out.side_file = side;
  out.leave_out = options.leave_out;
  return out;
}

/// A first case file, printed or written.
int suggest(CommandLine const& options, MeshSummary const& summary, Terminal& terminal) {
  std::string const text = case_snippet(summary, snippet_options(options));
  if (options.suggest->empty()) {
    terminal.result(text);
  } else {
    PendingFile(*options.suggest, text).commit();
    terminal.say(fmt::format("wrote {}\n", *options.suggest));
  }
  return done;
}

int inspect_unstructured(CommandLine const& options, Terminal& terminal) {
  if (options.match || options.write_side_file)
    throw MeshError(options.input.string() +
                    ": is an unstructured mesh; --match and --write-side-file are for structured ones");
  terminal.progress("reading " + options.input.string());
  LoadedMesh const loaded = load_unstructured(options.input, options.side_file, options.leave_out);
  terminal.progress("looking at boundaries");
  MeshSummary const summary = summarize(loaded);
  if (options.suggest) return suggest(options, summary, terminal);
  terminal.progress("measuring quality");
  QualityReport const quality = measure_mesh(loaded);
  if (options.json) {
    nlohmann::json json = inspect_json(loaded, summary, snippet_options(options));
    json["quality"] = quality_json(quality, {}, {});
    terminal.document(json);
  } else {
    terminal.result(inspect_text(loaded, summary, format_table(quality), snippet_options(options)));
  }
  return done;
}

void check_files(CommandLine const& options) {
  RunFiles outputs;
  if (options.suggest && !options.suggest->empty()) outputs.push_back({"case file", *options.suggest});
  if (outputs.empty() && !options.write_side_file) return;
  check_run_files(inputs_of_mesh(options.input, options.side_file), outputs);
  if (!options.write_side_file) return;
  // A new side file begins with all of the present one, whose place it may take.
  outputs.push_back({"side file", *options.write_side_file});
  check_run_files({{"input mesh", options.input}}, outputs);
}

/// What the points say: added to the mesh, and to its side file where one is to be written.
void find_and_add(CommandLine const& options, Mesh& mesh, Terminal& terminal) {
  terminal.progress("matching points");
  FoundInterfaces const found =
      find_interfaces(mesh, {.tolerance = options.match_tolerance, .periodic = options.match_periodic});
  int const periodic = int(std::count_if(found.interfaces.begin(), found.interfaces.end(),
                                         [](auto const& f) { return f.periodic.has_value(); }));
  mesh.notes.push_back(
      fmt::format("{} interfaces found by matching points, {} of them periodic; largest distance {:.3g}",
                  found.interfaces.size(), periodic, found.mismatch));
  mesh.notes.insert(mesh.notes.end(), found.notes.begin(), found.notes.end());
  if (options.write_side_file) {
    auto const present = options.side_file ? options.side_file : find_side_file(options.input);
    PendingFile(*options.write_side_file,
                side_file_text(mesh, found, present ? io::read_file(present->string()) : std::string()))
        .commit();
  }
  mesh.interfaces.insert(mesh.interfaces.end(), found.interfaces.begin(), found.interfaces.end());
}

}  // namespace

int run_inspect_command(CommandLine const& options, Terminal& terminal) {
  check_files(options);
  if (options.suggest && options.match && !options.write_side_file)
    throw ConfigError("--suggest with --match: a case file finds the interfaces in a side file; add --write-side-file");
  if (mesh_kind(options.input.string(), options.leave_out) == MeshKind::unstructured)
    return inspect_unstructured(options, terminal);
  terminal.progress("reading " + options.input.string());
  Mesh mesh = load_mesh(options.input, options.side_file, options.leave_out);
  if (options.match || options.write_side_file) find_and_add(options, mesh, terminal);
  terminal.progress("looking at boundaries and connections");
  MeshSummary const summary = summarize(mesh);
  if (options.suggest) return suggest(options, summary, terminal);
  terminal.progress("measuring quality");
  QualityReport const quality = measure_mesh(mesh);
  if (options.json) {
    nlohmann::json json = inspect_json(summary, snippet_options(options));
    json["quality"] = quality_json(quality, {}, {});
    terminal.document(json);
  } else {
    terminal.result(inspect_text(summary, format_table(quality), snippet_options(options)));
    if (options.write_side_file) terminal.say(fmt::format("wrote {}\n", options.write_side_file->string()));
  }
  return done;
}

}  // namespace gridmorph::cli
