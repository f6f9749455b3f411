// A sequence of meshes over time from one plan.
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/stopwatch.hpp>
#include <gridmorph/report/measure_text.hpp>
#include <gridmorph/run/run.hpp>
#include <gridmorph/run/run_files.hpp>
#include <gridmorph/run/run_page.hpp>
#include <gridmorph/run/step_files.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace gridmorph::cli {

namespace {

struct StepResult {
  double time = 0;
  double largest_displacement = 0;
  double determinant = 0;  ///< smallest 3x3x3
  double inversion = 0;    ///< smallest FallenCells::worst of inverted cells: which of two steps at -1 is the worse one
  std::string place;       ///< of it, for people; empty when nothing was measured
  std::string zone;
  std::vector<int> cell;  ///< 1-based indices; of an unstructured mesh the element's number
  Index newly_inverted = 0;
  std::string shortfall;  ///< the first of those that are failures
  std::vector<TipClearance> clearances;
};

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
    if (!step.clearances.empty()) json["clearances"] = clearance_json(step.clearances);
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

/// Throws ConfigError when an output or the report cannot be written where it should.
void check_sequence_outputs(CaseFile const& case_file, MeshSource const& file) {
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
  if (!one_file_per_step(options) && !holds_series(file.format))
    throw ConfigError(fmt::format(
        "{}: a series in one output is for CGNS and OpenFOAM meshes, and '{}' is {}; write one file per step, output = "
        "\"step_{{step}}{}\" in [sequence]",
        case_file.source.string(), case_file.input.string(), to_string(file.format),
        case_file.input.extension().string()));
  RunFiles outputs;
  for (int step = 0; step < files; ++step) outputs.push_back({"output", step_path(options, step)});
  if (!one_file_per_step(options))
    for (int step = 0; step < options.steps; ++step) outputs.front().times.push_back(options.time_at(step));
  if (auto const& report = case_file.output_options.report) outputs.push_back({"report", *report});
  if (auto const& page = case_file.output_options.page) outputs.push_back({"page", *page});
  check_run_files(inputs_of(case_file, file), outputs);
}

/// Which of two steps is the worse one.
std::pair<double, double> badness(StepResult const& step) { return {step.determinant, step.inversion}; }

/// "3 of 24 steps fall short, the first is step 7: ..."; empty where none does.
std::string shortfall_text(std::vector<StepResult> const& results) {
  auto const falls_short = [](StepResult const& s) { return !s.shortfall.empty(); };
  auto const first = std::find_if(results.begin(), results.end(), falls_short);
  if (first == results.end()) return "";
  auto const count = std::count_if(results.begin(), results.end(), falls_short);
  return fmt::format("{} of {} steps {} short, {} step {}: {}", count, results.size(), count == 1 ? "falls" : "fall",
                     count == 1 ? "it is" : "the first is", first - results.begin() + 1, first->shortfall);
}

/// What the guard did in the steps.
std::vector<std::string> guard_notes(Index relaxed, std::string const& lost,
                                     std::map<int, std::string> const& stepped) {
  constexpr std::size_t most_notes = 8;  // of more of them the number
  std::vector<std::string> notes;
  if (relaxed > 0)
    notes.push_back(fmt::format("in a step up to {} {}; displacements around them are smoothed", relaxed, lost));
  std::size_t shown = 0;
  for (auto const& [step, text] : stepped)
    if (shown++ < most_notes) notes.push_back(fmt::format("step {}: {}", step + 1, text));
  if (shown > most_notes) notes.push_back(fmt::format("the same in {} more steps", shown - most_notes));
  return notes;
}

}  // namespace

int morph_sequence(CaseFile const& case_file, MeshSource const& file, Console& console, std::string const& typed) {
  check_sequence_outputs(case_file, file);
  auto const& options = *case_file.sequence;
  std::optional<RunPage> page;
  if (case_file.output_options.page) page.emplace(case_file, typed);
  Run run(case_file, file, console);
  if (page) run.keep_measures();
  run.measure_baseline();
  StepFiles files(case_file, run.mesh());
  std::vector<StepResult> results;
  QualityReport worst_quality;
  std::size_t worst = 0;
  bool inverted = false;
  Index relaxed = 0;                   // most cells that were bad in a step
  std::map<int, std::string> stepped;  // steps whose way was made in several
  std::string const count = fmt::format(", {} steps", options.steps);
  Stopwatch part;
  console.expect({});
  std::vector<Moment> moments;
  for (int step = 0; step < options.steps; ++step) moments.push_back(options.moment(step));
  if (case_file.guard.smooth) {
    console.progress("looking for cells that lose their shape");
    run.freeze_guard(moments);
    run.times.push_back({"guard, all steps", part.lap()});
  }
  std::vector<std::string> guarded;
  nlohmann::json of_guard = nlohmann::json::object();
  if (case_file.guard.retry) {
    Retried const retry = run.retry(moments);
    if (!retry.json.is_null()) of_guard["retry"] = retry.json;
    if (!retry.text.empty()) guarded.push_back(retry.text);
    run.times.push_back({"retries", part.lap()});
  }
  if (case_file.guard.freeze) {
    FrozenIntoPlan freeze = run.freeze_into_plan(moments);
    of_guard["frozen_guard"] = std::move(freeze.json);
    guarded.push_back(std::move(freeze.text));
    run.times.push_back({"freeze", part.lap()});
  }
  if (page) page->begin(run);
  for (int step = 0; step < options.steps; ++step) {
    console.progress(fmt::format("step {} of {}", step + 1, options.steps), double(step) / options.steps);
    part.lap();
    Moment const moment = options.moment(step);
    relaxed = std::max(relaxed, run.morph(&moment).before);
    add_time(run.times, "morph" + count, part.lap(), false);
    run.measure();
    if (!case_file.guard.freeze)  // steps would be beside the plan
      if (auto const tried = run.try_steps(); !tried.text.empty()) stepped[step] = tried.text;
    add_time(run.times, "quality" + count, part.lap(), false);
    auto& result = results.emplace_back(
        step_result(options.time_at(step), run.mesh().coordinates(), run.morphed(), run.quality()));
    for (auto const& s : shortfalls({}, run.quality(), thresholds_of(case_file)))
      if (s.severity == Shortfall::Severity::failure && result.shortfall.empty()) result.shortfall = s.message;
    result.clearances = run.clearances(&moment);
    inverted = inverted || result.newly_inverted > 0;
    if (step == 0 || badness(result) < badness(results[worst])) {
      worst = std::size_t(step);
      worst_quality = run.quality();
    }
    if (page) page->add_step(run, step, options.steps, worst == std::size_t(step));
    part.lap();
    // Once a step cannot be used the files are not needed; the table still says how the others fare.
    if (!inverted || case_file.guard.write_inverted) files.add(run.morphed(), run.fields());
    add_time(run.times, "write" + count, part.lap(), false);
  }
  bool const written = !inverted || case_file.guard.write_inverted;
  Moment const moment = options.moment(int(worst));
  run.morph(&moment);
  if (!written || page) {  // what is said of the worst cell needs it as it came out in the end
    run.measure();
    if (!case_file.guard.freeze) (void)run.try_steps();
  }
  PlanOutcome const outcome = run.plan().outcome(run.morphed(), worst_quality.fast, false);
  run.notes = run.plan().notes();
  run.notes.insert(run.notes.end(), guarded.begin(), guarded.end());
  for (auto& note : guard_notes(relaxed, run.mesh().kind().lost, stepped)) run.notes.push_back(std::move(note));

  if (page) {
    console.progress("drawing the page");
    part.lap();
    page->finish(run, worst_quality);
    run.times.push_back({"page", part.lap()});
  }

  auto shortfalls = run.shortfalls_of_motion();
  bool const motion_falls_short = any_failure(shortfalls);
  auto const of_quality = run.shortfalls_of(worst_quality);
  shortfalls.insert(shortfalls.end(), of_quality.begin(), of_quality.end());
  std::string const shortfall = shortfall_text(results);
  std::vector<std::string> warnings;
  if (console.quiet()) {
    warnings = messages_of(shortfalls);
    if (!shortfall.empty()) warnings.insert(warnings.begin(), shortfall);
  }
  return conclude(
      {.output = options.output,
       .report = case_file.output_options.report,
       .page = case_file.output_options.page,
       .written = written,
       .falls_short = !shortfall.empty() || motion_falls_short,
       .json =
           [&] {
             nlohmann::json json = run.json(worst_quality, outcome);
             json["sequence"] = steps_json(results, worst, options);
             json.update(of_guard);
             return json;
           },
       .page_text = [&](nlohmann::json const& report) { return page->text(report); },
       .write =
           [&] {
             if (written) files.commit();
           },
       .text =
           [&] {
             std::string text = run.head();
             text += (text.empty() ? "" : "\n") + steps_table(results, worst);
             std::vector<std::vector<TipClearance>> clearances;
             for (StepResult const& step : results) clearances.push_back(step.clearances);
             if (std::string const tips = clearance_steps_table(clearances); !tips.empty()) text += "\n" + tips;
             if (!shortfall.empty()) text += "\n" + shortfall + "\n";
             return text + fmt::format("\nstep {}, the worst one\n\n", worst + 1) + run.tables(worst_quality, outcome);
           },
       .wrote = wrote_text(options),
       .also_wrote = wrote_report(case_file.output_options.report) + wrote_report(case_file.output_options.page),
       .warnings = std::move(warnings),
       .refusal =
           [&] {
             return run.refusal_of(options.output, "steps have cells",
                                   "lower the amplitudes, change " + file.traits().change_many);
           }},
      console);
}

}  // namespace gridmorph::cli
