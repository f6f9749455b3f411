#include <gridmorph/app/cli/commands.hpp>
#include <gridmorph/app/cli/diagnosis.hpp>
#include <gridmorph/app/cli/morph_command.hpp>
#include <gridmorph/app/cli/output_files.hpp>
#include <gridmorph/app/cli/run_files.hpp>
#include <gridmorph/app/cli/sequence.hpp>
#include <gridmorph/app/cli/unstructured_morph.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/stopwatch.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/io/unstructured_io.hpp>
#include <gridmorph/mapping/mapping_report.hpp>
#include <gridmorph/report/quality_json.hpp>
#include <gridmorph/report/quality_table.hpp>
#include <gridmorph/report/step_times.hpp>
#include <gridmorph/report/target_text.hpp>

#include <fmt/format.h>
#include <Kokkos_Core.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph::cli {

namespace {

/// The cell fields of the output mesh.
constexpr std::array field_measures{Measure::aspect_ratio,       Measure::determinant_2x2x2,
                                    Measure::determinant_3x3x3,  Measure::minimum_angle_deg,
                                    Measure::equiangle_skewness, Measure::relative_displacement};

}  // namespace

std::string field_name(Measure measure) {
  std::string out;
  bool upper = true;
  for (char const c : to_string(measure)) {
    if (c == '_') {
      upper = true;
      continue;
    }
    out += upper && c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c;
    upper = false;
  }
  return out;
}

FieldUnit field_unit(Measure measure) {
  return measure == Measure::minimum_angle_deg ? FieldUnit::degree : FieldUnit::number;
}

OutputFields output_fields(CaseFile const& case_file, MorphResult const& result) {
  OutputFields fields;
  fields.displacement = case_file.output_options.displacement;
  if (!case_file.output_options.quality) return fields;
  QualityInput<Kokkos::HostSpace> input;
  input.coordinates = views(result.morphed);
  input.baseline = views(result.mesh.coordinates);
  auto const values = cell_fields(Kokkos::DefaultHostExecutionSpace(), result.mesh, input, field_measures);
  for (std::size_t m = 0; m < field_measures.size(); ++m)
    fields.cells.push_back({field_name(field_measures[m]),
                            std::vector<double>(values[m].data(), values[m].data() + values[m].extent(0)),
                            field_unit(field_measures[m])});
  return fields;
}

namespace {

nlohmann::json stages_json(MorphResult const& result) {
  nlohmann::json stages = nlohmann::json::array();
  for (auto const& stage : result.stages) {
    nlohmann::json json{{"name", stage.name}, {"min_determinant", nullptr}};
    auto const& worst = stage.min_determinant;
    if (worst.zone >= 0)
      json["min_determinant"] = {{"value", worst.value},
                                 {"zone", result.mesh.zones[worst.zone].name},
                                 {"cell", {worst.cell[0] + 1, worst.cell[1] + 1, worst.cell[2] + 1}}};
    stages.push_back(std::move(json));
  }
  return stages;
}

std::string stages_text(MorphResult const& result) {
  std::string text;
  for (auto const& stage : result.stages) {
    auto const& worst = stage.min_determinant;
    if (worst.zone >= 0)
      text += fmt::format("stage {}: smallest determinant {:.4g}, {}\n", stage.name, worst.value,
                          describe_cell(result.mesh.zones[worst.zone].name, worst.cell));
  }
  return text;
}

}  // namespace

nlohmann::json report_json(CaseFile const& case_file, MorphResult const& result) {
  nlohmann::json json = quality_json(result.before, result.after, thresholds_of(case_file));
  json["gridmorph"] = GRIDMORPH_VERSION;
  json["case_file"] = case_file.source.string();
  json["input"] = case_file.input.string();
  json["nodes"] = result.mesh.n_nodes();
  json["times"] = times_json(result.times, result.mesh.n_nodes());
  json["notes"] = result.notes;
  json["stages"] = stages_json(result);
  json["targets"] = targets_json(result.mesh, result.targets);
  json["fields"] = nlohmann::json::array();
  for (auto const& use : case_file.fields) {
    json["fields"].push_back(mapping_json(*use.field));
    json["fields"].back()["rule"] = use.where;
  }
  return json;
}

namespace {

nlohmann::json whole_report(CaseFile const& case_file, MorphResult const& result, bool written) {
  nlohmann::json json = report_json(case_file, result);
  json["output"] = written ? nlohmann::json(case_file.output.string()) : nlohmann::json(nullptr);
  return json;
}

std::string report_text(CaseFile const& case_file, MorphResult const& result, bool written) {
  return json_text(whole_report(case_file, result, written));
}

}  // namespace

std::string format_result(CaseFile const& case_file, MorphResult const& result) {
  std::string text = stages_text(result);
  text += (text.empty() ? "" : "\n") + format_table(result.before, result.after, thresholds_of(case_file));
  if (!result.after.fast) text += "\n" + format_short_table(result.before, result.after);
  return text + "\n" + format_times(result.times, result.mesh.n_nodes());
}

Index newly_inverted(QualityReport const& quality) {
  return quality.near_field.newly_inverted + quality.far_field.newly_inverted;
}

int morph_and_write(CaseFile const& case_file, Terminal& terminal) {
  auto const& report = case_file.output_options.report;
  check_run_files(inputs_of(case_file), outputs_of(case_file.output, report));

  MorphResult result = run_morph(case_file, terminal);
  bool const written = newly_inverted(result.after) == 0 || case_file.guard.write_inverted;
  OutputFields fields;
  if (written) {
    Stopwatch watch;
    fields = output_fields(case_file, result);
    result.times.back().seconds += watch.lap();
    result.times.push_back({"write", 0, true});
  }
  // The report waits beside its place until the mesh is there: both appear, or none. It has room to spare for the time
  // that writing the mesh takes.
  std::optional<PendingFile> pending;
  if (report) pending.emplace(*report, report_text(case_file, result, written) + std::string(room_for_a_time, '\n'));
  if (written) {
    terminal.progress("writing " + case_file.output.string());
    Stopwatch watch;
    write_morphed(case_file.input.string(), case_file.output.string(), result.mesh, result.morphed, fields);
    result.times.back().seconds = watch.lap();
  }
  if (pending) {
    pending->replace(report_text(case_file, result, written));
    pending->commit();
  }

  std::string text;
  for (auto const& note : result.notes) text += "note: " + note + "\n";
  text += format_result(case_file, result);
  if (written) text += fmt::format("\nwrote {}\n", case_file.output.string());
  if (report) text += fmt::format("wrote {}\n", report->string());
  terminal.say(text);
  terminal.document(whole_report(case_file, result, written));
  if (terminal.quiet())  // otherwise the table has said it
    for (auto const& s : result.shortfalls) terminal.warn(s.message);
  if (!written)
    terminal.error(refusal(case_file.output.string(), "cells are inverted that were not in the baseline",
                           diagnose(case_file, for_messages(result.mesh), result.after, result.morphed),
                           "move the boundary less, change [volume] or [boundary_layer]"));
  return status_of_morph(written, any_failure(result.shortfalls));
}

int run_morph_command(CommandLine const& options, Terminal& terminal) {
  CaseFile case_file = read_case_file(options.input);
  if (options.output) (case_file.sequence ? case_file.sequence->output : case_file.output) = *options.output;
  if (options.report) case_file.output_options.report = *options.report;
  set_quality(case_file, options.quality);
  if (options.dry_run) {
    print_plan(case_file, terminal);
    return done;
  }
  bool const unstructured = check_keys(case_file) == MeshKind::unstructured;
  if (case_file.sequence)
    return unstructured ? morph_unstructured_sequence(case_file, terminal) : morph_sequence(case_file, terminal);
  if (case_file.output.empty())
    throw ConfigError(fmt::format("{}: no output; add output = \"morphed.cgns\" to [mesh] or give --output FILE",
                                  options.input.string()));
  return unstructured ? morph_unstructured(case_file, terminal) : morph_and_write(case_file, terminal);
}

}  // namespace gridmorph::cli
