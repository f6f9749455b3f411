#include <gridmorph/cli/commands.hpp>
#include <gridmorph/cli/morph_command.hpp>
#include <gridmorph/cli/output_files.hpp>
#include <gridmorph/cli/sequence.hpp>
#include <gridmorph/cli/step_files.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/stopwatch.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph::cli {

namespace {

/// Rows of the table; of longer sequences evenly spaced steps and the worst one are shown.
constexpr int most_rows = 100;

struct StepResult {
  double time = 0;
  double largest_displacement = 0;
  CellValue min_determinant;  ///< 3x3x3
  Index newly_inverted = 0;
};

CellValue smallest_determinant(QualityReport const& report) {
  CellValue out;
  for (auto const* region : {&report.near_field, &report.far_field}) {
    auto const& measure = (*region)[Measure::determinant_3x3x3];
    if (measure.worst_zone >= 0 && (out.zone < 0 || measure.worst < out.value))
      out = {measure.worst, measure.worst_zone, measure.worst_cell};
  }
  return out;
}

double largest_displacement(Coordinates const& before, Coordinates const& after) {
  double squared = 0;
  for (Index n = 0; n < before.size(); ++n) {
    Vec3 const u = after[n] - before[n];
    squared = std::max(squared, dot(u, u));
  }
  return std::sqrt(squared);
}

void check_outputs(CaseFile const& case_file) {
  auto const& options = *case_file.sequence;
  if (options.output.empty())
    throw ConfigError(
        fmt::format("{}: no output; add output = \"series.cgns\" or output = \"step_{{step}}.cgns\" to [sequence] or "
                    "give --output FILE",
                    case_file.source.string()));
  int const files = one_file_per_step(options) ? options.steps : 1;
  for (int step = 0; step < files; ++step) check_output(step_path(options, step), "output", case_file.input);
  if (files == 1 && !one_file_per_step(options) &&
      (case_file.output_options.displacement || case_file.output_options.quality))
    throw ConfigError(
        fmt::format("{}: [output] displacement and quality need one file per step; write output = "
                    "\"step_{{step}}.cgns\" in [sequence]",
                    case_file.source.string()));
  auto const& report = case_file.output_options.report;
  if (!report) return;
  check_output(*report, "report", case_file.input);
  for (int step = 0; step < files; ++step)
    if (*report == step_path(options, step))
      throw ConfigError(fmt::format("output and report are the same file '{}'; give two names", report->string()));
}

std::string table_of(std::vector<StepResult> const& steps, std::size_t worst, Mesh const& mesh) {
  std::string text = fmt::format("{:>6}  {:>12}  {:>20}  {:>20}  {:>14}  {}\n", "step", "time", "largest displacement",
                                 "smallest determinant", "newly inverted", "at");
  std::size_t const stride = (steps.size() + most_rows - 1) / most_rows;
  for (std::size_t s = 0; s < steps.size(); ++s) {
    if (s % stride != 0 && s != worst) continue;
    auto const& step = steps[s];
    auto const& d = step.min_determinant;
    text +=
        fmt::format("{:>6}  {:>12.6g}  {:>20.6g}  {:>20.4f}  {:>14}  {}{}\n", s + 1, step.time,
                    step.largest_displacement, d.value, step.newly_inverted,
                    d.zone < 0 ? "" : describe_cell(mesh.zones[d.zone].name, d.cell), s == worst ? "  <- worst" : "");
  }
  return text;
}

nlohmann::json json_of(std::vector<StepResult> const& steps, std::size_t worst, SequenceOptions const& options,
                       Mesh const& mesh) {
  nlohmann::json list = nlohmann::json::array();
  for (std::size_t s = 0; s < steps.size(); ++s) {
    auto const& step = steps[s];
    auto const& d = step.min_determinant;
    nlohmann::json json{{"step", s + 1},
                        {"time", step.time},
                        {"largest_displacement", step.largest_displacement},
                        {"newly_inverted", step.newly_inverted},
                        {"min_determinant", nullptr}};
    if (d.zone >= 0)
      json["min_determinant"] = {{"value", d.value},
                                 {"zone", mesh.zones[d.zone].name},
                                 {"cell", {d.cell[0] + 1, d.cell[1] + 1, d.cell[2] + 1}}};
    if (one_file_per_step(options)) json["file"] = step_path(options, int(s)).string();
    list.push_back(std::move(json));
  }
  return {
      {"period", options.period}, {"periods", options.periods}, {"worst_step", worst + 1}, {"steps", std::move(list)}};
}

}  // namespace

int morph_sequence(CaseFile const& case_file, Terminal& terminal) {
  check_outputs(case_file);
  auto const& options = *case_file.sequence;
  Stopwatch watch, part;
  terminal.progress("reading " + case_file.input.string());
  MorphResult result = read_baseline(case_file);
  result.times.push_back({"read", watch.lap(), true});
  Engine const engine(result.mesh, case_file, terminal);
  result.times.insert(result.times.end(), engine.times().begin(), engine.times().end());
  QualityMeter const meter(result.mesh, case_file, engine);
  result.before = meter.baseline();

  StepFiles files(case_file, result.mesh);
  result.morphed = Coordinates(result.mesh.n_nodes());
  std::vector<StepResult> steps;
  std::size_t worst = 0;
  double morphing = 0, measuring = 0, writing = 0;
  bool inverted = false;
  auto const morph = [&](int step) {
    engine.morph_into(motion_at(case_file, options.periods_at(step)), result.morphed);
  };
  for (int step = 0; step < options.steps; ++step) {
    terminal.progress(fmt::format("step {} of {}", step + 1, options.steps));
    part.lap();
    morph(step);
    morphing += part.lap();
    QualityReport const quality = meter.morphed(result.morphed);
    measuring += part.lap();
    steps.push_back({options.time_at(step), largest_displacement(result.mesh.coordinates, result.morphed),
                     smallest_determinant(quality), newly_inverted(quality)});
    if (steps.back().min_determinant.value < steps[worst].min_determinant.value) worst = steps.size() - 1;
    inverted = inverted || steps.back().newly_inverted > 0;
    part.lap();
    // Once a step cannot be used the files are not needed; the table still says how the others fare.
    if (!inverted || case_file.guard.write_inverted) files.add(result.morphed, output_fields(case_file, result));
    writing += part.lap();
  }
  morph(int(worst));
  result.after = meter.morphed(result.morphed);
  result.shortfalls = shortfalls(result.before, result.after, thresholds_of(case_file));
  result.stages = engine.stage_results(result.morphed);
  result.notes = engine.notes();
  add_mapping_notes(case_file, result.notes);
  std::string const count = fmt::format(", {} steps", options.steps);
  result.times.push_back({"morph" + count, morphing});
  result.times.push_back({"quality" + count, measuring});
  result.times.push_back({"write" + count, writing});

  bool const written = !inverted || case_file.guard.write_inverted;
  auto const& report = case_file.output_options.report;
  std::optional<PendingFile> pending;
  if (report) {
    nlohmann::json json = report_json(case_file, result);
    json["output"] = written ? nlohmann::json(options.output.string()) : nlohmann::json(nullptr);
    json["sequence"] = json_of(steps, worst, options, result.mesh);
    pending.emplace(*report, json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
  }
  if (written) {
    terminal.progress("writing " + options.output.string());
    files.commit();
  }
  if (pending) pending->commit();

  std::string text;
  for (auto const& note : result.notes) text += "note: " + note + "\n";
  text += (text.empty() ? "" : "\n") + table_of(steps, worst, result.mesh);
  text += fmt::format("\nstep {}, the worst one\n\n", worst + 1);
  text += format_result(case_file, result);
  if (written)
    text += one_file_per_step(options) ? fmt::format("\nwrote {} ... {}\n", step_path(options, 0).string(),
                                                     step_path(options, options.steps - 1).string())
                                       : fmt::format("\nwrote {} ({} steps)\n", options.output.string(), options.steps);
  if (report) text += fmt::format("wrote {}\n", report->string());
  terminal.say(text);
  if (terminal.quiet())
    for (auto const& s : result.shortfalls) terminal.warn(s.message);
  if (!written)
    terminal.error(
        fmt::format("'{}' is not written, because steps have cells inverted that were not in the baseline; lower the "
                    "amplitudes, change [volume] or [boundary_layer], or set write_inverted = true in [guard]",
                    options.output.string()));
  return any_failure(result.shortfalls) || !written ? falls_short : done;
}

}  // namespace gridmorph::cli
