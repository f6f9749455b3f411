#include <gridmorph/app/cli/commands.hpp>
#include <gridmorph/app/cli/morph_command.hpp>
#include <gridmorph/app/cli/output_files.hpp>
#include <gridmorph/app/cli/run_files.hpp>
#include <gridmorph/app/cli/sequence_steps.hpp>
#include <gridmorph/app/cli/step_files.hpp>
#include <gridmorph/app/cli/workflow.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/stopwatch.hpp>
#include <gridmorph/report/measure_text.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace gridmorph::cli {

namespace {

/// Rows of the table; of longer sequences evenly spaced steps and the worst one are shown.
constexpr int most_rows = 100;

double largest_displacement(Coordinates const& before, Coordinates const& after) {
  double squared = 0;
  for (Index n = 0; n < before.size(); ++n) {
    Vec3 const u = after[n] - before[n];
    squared = std::max(squared, dot(u, u));
  }
  return std::sqrt(squared);
}

/// One row per step, of long sequences evenly spaced ones and the worst.
std::string steps_table(std::vector<StepResult> const& steps, std::size_t worst) {
  std::string text = fmt::format("{:>6}  {:>12}  {:>20}  {:>20}  {:>14}  {}\n", "step", "time", "largest displacement",
                                 "smallest determinant", "newly inverted", "at");
  std::size_t const stride = (steps.size() + most_rows - 1) / most_rows;
  for (std::size_t s = 0; s < steps.size(); ++s) {
    if (s % stride != 0 && s != worst) continue;
    auto const& step = steps[s];
    text += fmt::format("{:>6}  {:>12.6g}  {:>20.6g}  {:>20.4f}  {:>14}  {}{}\n", s + 1, step.time,
                        step.largest_displacement, step.determinant, step.newly_inverted, step.place,
                        s == worst ? "  <- worst" : "");
  }
  return text;
}

nlohmann::json steps_json(std::vector<StepResult> const& steps, std::size_t worst, SequenceOptions const& options) {
  nlohmann::json list = nlohmann::json::array();
  for (std::size_t s = 0; s < steps.size(); ++s) {
    auto const& step = steps[s];
    nlohmann::json json{{"step", s + 1},
                        {"time", step.time},
                        {"largest_displacement", step.largest_displacement},
                        {"newly_inverted", step.newly_inverted},
                        {"shortfall", step.shortfall.empty() ? nlohmann::json() : nlohmann::json(step.shortfall)},
                        {"min_determinant", nullptr}};
    if (!step.place.empty()) {
      json["min_determinant"] = {{"value", step.determinant}, {"zone", step.zone}};
      if (step.cell.size() == 1)
        json["min_determinant"]["element"] = step.cell[0];
      else
        json["min_determinant"]["cell"] = step.cell;
    }
    if (one_file_per_step(options)) json["file"] = step_path(options, int(s)).string();
    list.push_back(std::move(json));
  }
  return {
      {"period", options.period}, {"periods", options.periods}, {"worst_step", worst + 1}, {"steps", std::move(list)}};
}

/// "wrote step_1.cgns ... step_8.cgns" or "wrote series.cgns (8 steps)".
std::string wrote_text(SequenceOptions const& options) {
  return one_file_per_step(options) ? fmt::format("\nwrote {} ... {}\n", step_path(options, 0).string(),
                                                  step_path(options, options.steps - 1).string())
                                    : fmt::format("\nwrote {} ({} steps)\n", options.output.string(), options.steps);
}

}  // namespace

StepResult step_result(double time, Coordinates const& before, Coordinates const& after, QualityReport const& quality) {
  StepResult out;
  out.time = time;
  out.largest_displacement = largest_displacement(before, after);
  out.newly_inverted = newly_inverted(quality);
  for (auto const* region : {&quality.near_field, &quality.far_field})
    out.inversion = std::min(out.inversion, (*region)[Fall::inverted].worst);
  MeasureStatistics const* worst = nullptr;
  for (auto const* region : {&quality.near_field, &quality.far_field}) {
    auto const& measure = (*region)[Measure::determinant_3x3x3];
    if (measure.worst_zone >= 0 && (worst == nullptr || measure.worst < worst->worst)) worst = &measure;
  }
  if (worst == nullptr) return out;
  out.determinant = worst->worst;
  out.place = worst_place(quality, *worst);
  out.zone = quality.zone_names.at(std::size_t(worst->worst_zone));
  for (int const index : worst->worst_cell) out.cell.push_back(index + 1);
  if (quality.unstructured) out.cell.resize(1);
  return out;
}

void check_sequence_outputs(CaseFile const& case_file) {
  auto const& options = *case_file.sequence;
  if (options.output.empty())
    throw ConfigError(
        fmt::format("{}: no output; add output = \"series.cgns\" or output = \"step_{{step}}.cgns\" to [sequence] or "
                    "give --output FILE",
                    case_file.source.string()));
  int const files = one_file_per_step(options) ? options.steps : 1;
  if (files == 1 && !one_file_per_step(options) &&
      (case_file.output_options.displacement || case_file.output_options.quality))
    throw ConfigError(
        fmt::format("{}: [output] displacement and quality need one file per step; write output = "
                    "\"step_{{step}}.cgns\" in [sequence]",
                    case_file.source.string()));
  RunFiles outputs;
  for (int step = 0; step < files; ++step) outputs.push_back({"output", step_path(options, step)});
  if (auto const& report = case_file.output_options.report) outputs.push_back({"report", *report});
  check_run_files(inputs_of(case_file), outputs);
}

std::size_t Steps::worst() const {
  auto const found = std::min_element(results.begin(), results.end(), [](StepResult const& a, StepResult const& b) {
    return std::pair(a.determinant, a.inversion) < std::pair(b.determinant, b.inversion);
  });
  return std::size_t(found - results.begin());
}

std::string Steps::shortfall() const {
  auto const falls_short = [](StepResult const& s) { return !s.shortfall.empty(); };
  auto const first = std::find_if(results.begin(), results.end(), falls_short);
  if (first == results.end()) return "";
  auto const count = std::count_if(results.begin(), results.end(), falls_short);
  return fmt::format("{} of {} steps {} short, {} step {}: {}", count, results.size(), count == 1 ? "falls" : "fall",
                     count == 1 ? "it is" : "the first is", first - results.begin() + 1, first->shortfall);
}

Steps run_steps(CaseFile const& case_file, Terminal& terminal, StepFiles& files, StepWork const& work) {
  auto const& options = *case_file.sequence;
  Steps out;
  Stopwatch part;
  double morphing = 0, measuring = 0, writing = 0;
  terminal.expect({});
  for (int step = 0; step < options.steps; ++step) {
    terminal.progress(fmt::format("step {} of {}", step + 1, options.steps), double(step) / options.steps);
    part.lap();
    work.morph(step);
    morphing += part.lap();
    QualityReport const quality = work.measure();
    measuring += part.lap();
    out.results.push_back(step_result(options.time_at(step), work.before, work.after, quality));
    for (auto const& s : shortfalls({}, quality, thresholds_of(case_file)))
      if (s.severity == Shortfall::Severity::failure && out.results.back().shortfall.empty())
        out.results.back().shortfall = s.message;
    out.inverted = out.inverted || out.results.back().newly_inverted > 0;
    part.lap();
    // Once a step cannot be used the files are not needed; the table still says how the others fare.
    if (!out.inverted || case_file.guard.write_inverted) files.add(work.after, work.fields());
    writing += part.lap();
  }
  std::string const count = fmt::format(", {} steps", options.steps);
  out.times = {{"morph" + count, morphing}, {"quality" + count, measuring}, {"write" + count, writing}};
  return out;
}

int finish_sequence(CaseFile const& case_file, Terminal& terminal, StepFiles& files, Steps const& steps,
                    SequenceReport const& report) {
  auto const& options = *case_file.sequence;
  std::size_t const worst = steps.worst();
  bool const written = !steps.inverted || case_file.guard.write_inverted;
  auto const& report_file = case_file.output_options.report;
  std::optional<PendingFile> pending;
  nlohmann::json json = report.json();
  json["output"] = written ? nlohmann::json(options.output.string()) : nlohmann::json(nullptr);
  json["sequence"] = steps_json(steps.results, worst, options);
  if (report_file) pending.emplace(*report_file, json_text(json));
  if (written) {
    terminal.progress("writing " + options.output.string());
    files.commit();
  }
  if (pending) pending->commit();

  std::string text = report.head + steps_table(steps.results, worst);
  std::string const shortfall = steps.shortfall();
  if (!shortfall.empty()) text += "\n" + shortfall + "\n";
  text += fmt::format("\nstep {}, the worst one\n\n", worst + 1) + report.worst;
  if (written) text += wrote_text(options);
  if (report_file) text += fmt::format("wrote {}\n", report_file->string());
  terminal.say(text);
  terminal.document(json);
  if (terminal.quiet()) {
    if (!shortfall.empty()) terminal.warn(shortfall);
    for (auto const& s : report.shortfalls) terminal.warn(s.message);
  }
  if (!written)
    terminal.error(refusal(options.output.string(), "steps have cells inverted that were not in the baseline",
                           report.diagnose(), "lower the amplitudes, change " + report.what_to_change));
  return status_of_morph(written, !shortfall.empty());
}

}  // namespace gridmorph::cli
