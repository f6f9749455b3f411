#include <gridmorph/case/side_file.hpp>
#include <gridmorph/command/commands.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/io/files_read.hpp>
#include <gridmorph/io/read_file.hpp>
#include <gridmorph/report/quality_json.hpp>
#include <gridmorph/report/quality_table.hpp>
#include <gridmorph/run/loaded_mesh.hpp>
#include <gridmorph/run/output_files.hpp>
#include <gridmorph/run/run_files.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <optional>
#include <string>

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
  if (auto const why = why_no_case(summary); !why.empty())
    throw MeshError(options.input.string() + ": there is no case file to suggest: " + why);
  std::string const text = case_snippet(summary, snippet_options(options));
  if (options.suggest->empty()) {
    terminal.result(text);
  } else {
    PendingFile(*options.suggest, text).commit();
    terminal.say(fmt::format("wrote {}\n", *options.suggest));
  }
  return done;
}

void check_files(CommandLine const& options, MeshSource const& file) {
  RunFiles outputs;
  if (options.suggest && !options.suggest->empty()) outputs.push_back({"case file", *options.suggest});
  if (outputs.empty() && !options.write_side_file) return;
  check_run_files(inputs_of_mesh(file, options.side_file), outputs);
  if (!options.write_side_file) return;
  // A new side file begins with all of the present one, whose place it may take.
  outputs.push_back({"side file", *options.write_side_file});
  RunFiles inputs = inputs_of_mesh(file, options.side_file);
  if (auto const present = options.side_file ? options.side_file : find_side_file(options.input)) {
    std::erase_if(inputs, [](RunFile const& input) { return input.what == "side file"; });
    io::FilesRead::release(*present);
  }
  check_run_files(inputs, outputs);
}

}  // namespace

int run_inspect_command(CommandLine const& options, Terminal& terminal) {
  MeshSource const file = look_at(options.input, options.leave_out);
  check_files(options, file);
  if (options.suggest && options.match && !options.write_side_file)
    throw ConfigError("--suggest with --match: a case file finds the interfaces in a side file; add --write-side-file");
  terminal.progress("reading " + options.input.string());
  LoadedMesh mesh(file.path, options.side_file, file.leave_out);
  if (options.match || options.write_side_file) {
    terminal.progress("matching points");
    auto const present = options.side_file ? options.side_file : find_side_file(options.input);
    std::string const before = options.write_side_file && present ? io::read_file(present->string()) : std::string();
    if (present) io::FilesRead::release(*present);
    mesh.match({options.match_tolerance, options.match_periodic, options.write_side_file, before});
  }
  terminal.progress("looking at boundaries and connections");
  MeshSummary const summary = mesh.summary();
  if (options.suggest) return suggest(options, summary, terminal);
  terminal.progress("measuring quality");
  QualityReport const quality = mesh.measure({});
  if (options.json) {
    nlohmann::json json = mesh.json(summary, snippet_options(options));
    json["quality"] = quality_json(quality, {}, {});
    terminal.document(json);
  } else {
    terminal.result(mesh.text(summary, format_table(quality), snippet_options(options)));
    if (options.write_side_file) terminal.say(fmt::format("wrote {}\n", options.write_side_file->string()));
  }
  return done;
}

}  // namespace gridmorph::cli
