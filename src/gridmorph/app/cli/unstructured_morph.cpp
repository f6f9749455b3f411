#include <gridmorph/app/cli/commands.hpp>
#include <gridmorph/app/cli/diagnosis.hpp>
#include <gridmorph/app/cli/morph_command.hpp>
#include <gridmorph/app/cli/output_files.hpp>
#include <gridmorph/app/cli/run_files.hpp>
#include <gridmorph/app/cli/unstructured_morph.hpp>
#include <gridmorph/app/cli/unstructured_run.hpp>
#include <gridmorph/app/cli/workflow.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/stopwatch.hpp>
#include <gridmorph/guard/guard.hpp>
#include <gridmorph/io/unstructured_io.hpp>
#include <gridmorph/morph/unstructured_morpher.hpp>

#include <fmt/format.h>
#include <Kokkos_Core.hpp>
#include <nlohmann/json.hpp>

#include <array>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

namespace gridmorph::cli {

namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;

void move_nodes(UnstructuredRun& out, Terminal& terminal, bool keep_background) {
  Stopwatch watch;
  auto const boundary = out.prepared->boundary_displacement(out.loaded.mesh);
  out.times.push_back({"boundary", watch.lap(), false});
  terminal.progress("morphing");
  UnstructuredMorpher<Exec> const morpher(Exec(), out.prepared->plan, out.loaded.mesh.coordinates);
  out.result.morphed = Coordinates(out.loaded.mesh.n_nodes());
  out.times.push_back({"upload", watch.lap(), true});
  apply_on_host(morpher, boundary, out.result.morphed);
  out.times.push_back({"morph", watch.lap(), true});
  if (!keep_background || !out.prepared->plan.background) return;
  Coordinates const& x = out.prepared->plan.background->mesh.coordinates;
  auto const u = morpher.background_displacement();
  out.background = Coordinates(x.size());
  for (Index n = 0; n < x.size(); ++n) out.background->set(n, x[n] + u[n]);
}

/// Smooths around elements that came out bad, and says so.
void relax(UnstructuredRun& out, Terminal& terminal) {
  terminal.progress("looking for bad elements");
  Stopwatch watch;
  RelaxReport const report = relax_bad_elements(out.loaded.mesh, out.loaded.topology, *out.prepared, out.result.morphed,
                                                {.signs = out.loaded.signs});
  if (report.before > 0)
    out.notes.push_back(fmt::format(
        "{} elements had lost four fifths of their determinant or more; displacements around them are smoothed in {} "
        "rounds, {} are left",
        report.before, report.rounds, report.after));
  out.times.push_back({"guard", watch.lap(), true});
}

void morph_in_steps_if_needed(CaseFile const& case_file, UnstructuredRun& out, Terminal& terminal) {
  if (newly_inverted(out.result.after) == 0) return;
  Stopwatch watch;
  terminal.expect({});  // how many steps it will take is not known
  auto const tried = try_steps(case_file, out, out.prepared->boundary_displacement(out.loaded.mesh), terminal);
  out.notes.insert(out.notes.end(), tried.notes.begin(), tried.notes.end());
  if (!tried.text.empty()) out.notes.push_back(tried.text);
  out.times.push_back({"steps", watch.lap(), true});
}

/// The morphed mesh with its regions (0 near, 1 fence, 2 far), layers and displacements.
void write_regions(std::string const& path, UnstructuredRun const& out) {
  UnstructuredMesh const& mesh = out.loaded.mesh;
  if (mesh.polyhedra.element.size() > 0) return;  // they cannot be written anew
  auto const& report = out.prepared->report;
  OutputFields fields;
  fields.displacement = true;
  CellField region{"Region", {}};
  for (Region const r : report.regions.element) region.values.push_back(double(2 - int(r)));
  fields.cells.push_back(std::move(region));
  fields.nodes.push_back({"Layer", std::vector<double>(report.layer.begin(), report.layer.end())});
  write_mesh(path, mesh, out.result.morphed, fields);
}

/// What write_stages() may put into its folder.
constexpr std::array stage_names{"regions.cgns", "wrap.cgns", "background.cgns", "background_morphed.cgns"};

void write_stages(std::filesystem::path const& folder, UnstructuredRun const& out) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw MachineError(
        fmt::format("the folder '{}' for the stages cannot be made: {}", folder.string(), error.message()));
  auto const& prepared = *out.prepared;
  write_regions((folder / stage_names[0]).string(), out);
  if (prepared.report.wrap) write_mesh((folder / stage_names[1]).string(), wrap_mesh(*prepared.report.wrap));
  if (!prepared.plan.background) return;
  Mesh background = prepared.plan.background->mesh;
  write_mesh((folder / stage_names[2]).string(), background);
  if (!out.background) return;
  background.coordinates = *out.background;
  write_mesh((folder / stage_names[3]).string(), background);
}

nlohmann::json whole_report(CaseFile const& case_file, UnstructuredRun const& out, bool written) {
  nlohmann::json json = report_json(case_file, out);
  json["output"] = written ? nlohmann::json(case_file.output.string()) : nlohmann::json(nullptr);
  return json;
}

std::string report_text(CaseFile const& case_file, UnstructuredRun const& out, bool written) {
  return json_text(whole_report(case_file, out, written));
}

}  // namespace

int morph_unstructured(CaseFile const& case_file, Terminal& terminal) {
  auto const& report = case_file.output_options.report;
  RunFiles outputs = outputs_of(case_file.output, report);
  if (auto const& folder = case_file.output_options.stages)
    for (char const* name : stage_names) outputs.push_back({"stage", *folder / name, true});
  check_run_files(inputs_of(case_file), outputs);
  UnstructuredRun out;
  // Reading, planning, morphing, guard, quality, writing: measured with a million elements.
  terminal.expect({25, 40, 2, 8, 10, 15});
  read_and_plan(case_file, terminal, out);
  move_nodes(out, terminal, case_file.output_options.stages.has_value());
  relax(out, terminal);
  terminal.progress("measuring quality");
  Stopwatch quality;
  measure_baseline(case_file, out);
  measure_result(case_file, out);
  out.times.push_back({"quality", quality.lap(), true});
  morph_in_steps_if_needed(case_file, out, terminal);
  bool const written = newly_inverted(out.result.after) == 0 || case_file.guard.write_inverted;
  std::optional<PendingFile> pending;
  if (report) pending.emplace(*report, report_text(case_file, out, written) + std::string(room_for_a_time, '\n'));
  if (written) {
    Stopwatch watch;
    terminal.progress("writing " + case_file.output.string());
    write_morphed(case_file.input.string(), case_file.output.string(), out.loaded.mesh, out.result.morphed,
                  out.result.fields);
    out.times.push_back({"write", watch.lap(), true});
  }
  if (case_file.output_options.stages) write_stages(*case_file.output_options.stages, out);
  if (pending) {
    pending->replace(report_text(case_file, out, written));
    pending->commit();
  }
  std::string text;
  for (auto const& note : out.notes) text += "note: " + note + "\n";
  text += regions_text(*out.prepared);
  text += "\n" + format_result(case_file, out);
  if (written) text += fmt::format("\nwrote {}\n", case_file.output.string());
  if (report) text += fmt::format("wrote {}\n", report->string());
  if (auto const& stages = case_file.output_options.stages)
    text += fmt::format("wrote wrap and background mesh to {}\n", stages->string());
  terminal.say(text);
  terminal.document(whole_report(case_file, out, written));
  if (terminal.quiet())
    for (auto const& s : out.result.shortfalls) terminal.warn(s.message);
  if (!written)
    terminal.error(refusal(case_file.output.string(), "elements are inverted that were not in the baseline",
                           diagnose(case_file, for_messages(out.loaded.mesh, out.prepared->boundary), out.result.after,
                                    out.result.morphed),
                           "move the boundary less, change [near_field], set steps"));
  return status_of_morph(written, any_failure(out.result.shortfalls));
}

void print_unstructured_plan(CaseFile const& case_file, nlohmann::json json, Terminal& terminal) {
  UnstructuredRun out;
  read_and_plan(case_file, terminal, out);
  json["nodes"] = out.loaded.mesh.n_nodes();
  json["elements"] = out.loaded.mesh.n_elements();
  json["notes"] = out.notes;
  json["plan"] = plan_json(*out.prepared);
  json["times"] = times_json(out.times, out.loaded.mesh.n_nodes());
  terminal.document(json);
  std::string text;
  for (auto const& note : out.notes) text += "note: " + note + "\n";
  text += regions_text(*out.prepared) + "\n" + format_times(out.times, out.loaded.mesh.n_nodes());
  if (!terminal.json()) terminal.result(text);
}

}  // namespace gridmorph::cli
