// A sequence of meshes over time from one plan.
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/stopwatch.hpp>
#include <gridmorph/report/measure_text.hpp>
#include <gridmorph/run/ending.hpp>
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
  RunFiles meshes;
  for (int step = 0; step < files; ++step) meshes.push_back({"output", step_path(options, step)});
  if (!one_file_per_step(options))
    for (int step = 0; step < options.steps; ++step) meshes.front().times.push_back(options.time_at(step));
  check_run_files(inputs_of(case_file, file), outputs_of(std::move(meshes), case_file.output_options));
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

class Sequence {
 public:
  Sequence(CaseFile const& case_file, MeshSource const& file, Console& console, std::string const& typed)
      : case_file_(case_file),
        options_(*case_file.sequence),
        file_(file),
        console_(console),
        page_(case_file.output_options.page ? std::make_optional<RunPage>(case_file, typed) : std::nullopt),
        run_(case_file, file, console) {
    for (int step = 0; step < options_.steps; ++step) moments_.push_back(options_.moment(step));
  }

  int operator()() {
    if (page_) run_.keep_measures();
    run_.measure_baseline();
    console_.expect({});
    part_.lap();
    find_lost_shapes();
    // Recipes that were asked for are tried on meshes that are guarded as such.
    bool const freezes_later = case_file_.guard.freeze && case_file_.guard.retry.value_or(false);
    if (!freezes_later) freeze();
    if (page_) page_->begin(run_);
    make_steps();
    if (bool const kept = retry(); kept || freezes_later) {
      freeze();
      make_steps();
    }
    look_at_worst();
    draw_page();
    return end();
  }

 private:
  void find_lost_shapes() {
    if (!case_file_.guard.smooth) return;
    console_.progress("looking for cells that lose their shape");
    run_.freeze_guard(moments_);
    run_.times.push_back({"guard, all steps", part_.lap()});
  }

  void freeze() {
    if (!case_file_.guard.freeze) return;
    run_.freeze_into_plan(guarded_, moments_);
    add_time(run_.times, "freeze", part_.lap(), false);
  }

  /// Other recipes for the worst step, and for all of them what mends it.
  bool retry() {
    Moment const& moment = moments_[worst_for_retry_];
    if (!case_file_.guard.retry.value_or(true) || !make_again(moment) || !run_.wants_retry()) return false;
    part_.lap();
    bool const kept = run_.retry(&moment, guarded_, moments_);
    run_.times.push_back({"retries", part_.lap()});
    return kept;
  }

  /// A step once more; false where there is no need to look at it.
  bool make_again(Moment const& moment) {
    if (!case_file_.guard.retry && !inverted_) return false;
    (void)run_.morph(&moment);
    run_.measure();
    return true;
  }

  void make_steps() {
    results_.clear();
    stepped_.clear();
    relaxed_ = 0;
    worst_ = worst_for_retry_ = 0;
    inverted_ = false;
    files_.emplace(case_file_, run_.mesh());
    for (int step = 0; step < options_.steps; ++step) {
      console_.progress(fmt::format("step {} of {}", step + 1, options_.steps), double(step) / options_.steps);
      make_step(step);
    }
  }

  void make_step(int step) {
    std::string const count = fmt::format(", {} steps", options_.steps);
    Moment const& moment = moments_[std::size_t(step)];
    part_.lap();
    relaxed_ = std::max(relaxed_, run_.morph(&moment).before);
    add_time(run_.times, "morph" + count, part_.lap(), false);
    run_.measure();
    if (!case_file_.guard.freeze)  // steps would be beside the plan
      if (auto const tried = run_.try_steps(); !tried.text.empty()) stepped_[step] = tried.text;
    add_time(run_.times, "quality" + count, part_.lap(), false);
    judge(step);
    if (page_) page_->add_step(run_, step, options_.steps, worst_ == std::size_t(step));
    part_.lap();
    // Once a step cannot be used the files are not needed; the table still says how the others fare.
    if (!inverted_ || case_file_.guard.write_inverted) files_->add(run_.morphed(), run_.fields());
    add_time(run_.times, "write" + count, part_.lap(), false);
  }

  void judge(int step) {
    auto& result = results_.emplace_back(
        step_result(options_.time_at(step), run_.mesh().coordinates(), run_.morphed(), run_.quality()));
    for (auto const& s : shortfalls({}, run_.quality(), thresholds_of(case_file_)))
      if (s.severity == Shortfall::Severity::failure && result.shortfall.empty()) result.shortfall = s.message;
    result.clearances = run_.clearances(&moments_[std::size_t(step)]);
    inverted_ = inverted_ || result.newly_inverted > 0;
    if (step == 0 || badness(result) < badness(results_[worst_])) {
      worst_ = std::size_t(step);
      worst_quality_ = run_.quality();
    }
    if (Badness const now = badness_of(run_.quality()); step == 0 || most_ < now) {
      most_ = now;
      worst_for_retry_ = std::size_t(step);
    }
  }

  void look_at_worst() {
    written_ = !inverted_ || case_file_.guard.write_inverted;
    (void)run_.morph(&moments_[worst_]);
    if (!written_ || page_) {  // what is said of the worst cell needs it as it came out in the end
      run_.measure();
      if (!case_file_.guard.freeze) (void)run_.try_steps();
    }
    outcome_ = run_.plan().outcome(run_.morphed(), worst_quality_.fast, false);
    run_.notes = run_.plan().notes();
    run_.notes.insert(run_.notes.end(), guarded_.notes.begin(), guarded_.notes.end());
    add_guard_notes();
    shortfalls_ = run_.shortfalls_of_motion();
    motion_falls_short_ = any_failure(shortfalls_);
    auto const of_quality = run_.shortfalls_of(worst_quality_);
    shortfalls_.insert(shortfalls_.end(), of_quality.begin(), of_quality.end());
  }

  /// What the guard did in the steps.
  void add_guard_notes() {
    constexpr std::size_t most_notes = 8;  // of more of them the number
    if (relaxed_ > 0)
      run_.notes.push_back(fmt::format("in a step up to {} {}; displacements around them are smoothed", relaxed_,
                                       run_.mesh().kind().lost));
    std::size_t shown = 0;
    for (auto const& [step, text] : stepped_)
      if (shown++ < most_notes) run_.notes.push_back(fmt::format("step {}: {}", step + 1, text));
    if (shown > most_notes) run_.notes.push_back(fmt::format("the same in {} more steps", shown - most_notes));
  }

  void draw_page() {
    if (!page_) return;
    console_.progress("drawing the page");
    part_.lap();
    page_->finish(run_, worst_quality_);
    run_.times.push_back({"page", part_.lap()});
  }

  [[nodiscard]] nlohmann::json json() const {
    nlohmann::json json = run_.json(worst_quality_, outcome_);
    json["sequence"] = steps_json(results_, worst_, options_);
    json.update(guarded_.json);
    return json;
  }

  [[nodiscard]] std::string text(std::string const& shortfall) const {
    std::string text = run_.head();
    text += (text.empty() ? "" : "\n") + steps_table(results_, worst_);
    std::vector<std::vector<TipClearance>> clearances;
    for (StepResult const& step : results_) clearances.push_back(step.clearances);
    if (std::string const tips = clearance_steps_table(clearances); !tips.empty()) text += "\n" + tips;
    if (!shortfall.empty()) text += "\n" + shortfall + "\n";
    return text + fmt::format("\nstep {}, the worst one\n\n", worst_ + 1) + run_.tables(worst_quality_, outcome_);
  }

  int end() {
    std::string const shortfall = shortfall_text(results_);
    std::vector<std::string> warnings;
    if (console_.quiet()) {
      warnings = messages_of(shortfalls_);
      if (!shortfall.empty()) warnings.insert(warnings.begin(), shortfall);
    }
    OutputOptions const& output = case_file_.output_options;
    return conclude({.output = options_.output,
                     .report = output.report,
                     .page = output.page,
                     .written = written_,
                     .falls_short = !shortfall.empty() || motion_falls_short_,
                     .json = [&] { return json(); },
                     .page_text = [&](nlohmann::json const& report) { return page_->text(report); },
                     .write =
                         [&] {
                           if (written_) files_->commit();
                         },
                     .text = [&] { return text(shortfall); },
                     .wrote = wrote_steps(options_),
                     .also_wrote = wrote_report(output.report) + wrote_report(output.page),
                     .warnings = std::move(warnings),
                     .refusal =
                         [&] {
                           return run_.refusal_of(options_.output, "steps have cells",
                                                  "lower the amplitudes, change " + file_.traits().change_many);
                         }},
                    console_);
  }

  CaseFile const& case_file_;
  SequenceOptions const& options_;
  MeshSource const& file_;
  Console& console_;
  std::optional<RunPage> page_;
  Run run_;
  std::vector<Moment> moments_;
  Stopwatch part_;
  Guarded guarded_;
  std::optional<StepFiles> files_;
  std::vector<StepResult> results_;
  std::map<int, std::string> stepped_;  ///< steps whose way was made in several
  Index relaxed_ = 0;                   ///< most cells that were bad in a step
  QualityReport worst_quality_;
  std::size_t worst_ = 0, worst_for_retry_ = 0;
  Badness most_;  ///< of worst_for_retry_
  bool inverted_ = false, written_ = false, motion_falls_short_ = false;
  PlanOutcome outcome_;
  std::vector<Shortfall> shortfalls_;
};

}  // namespace

int morph_sequence(CaseFile const& case_file, MeshSource const& file, Console& console, std::string const& typed) {
  check_sequence_outputs(case_file, file);
  return Sequence(case_file, file, console, typed)();
}

}  // namespace gridmorph::cli
