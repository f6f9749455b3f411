// A sequence of meshes from one plan: over time, or of the designs of a sweep.
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/for_all.hpp>
#include <gridmorph/core/stopwatch.hpp>
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

double largest_displacement(Coordinates const& before, Coordinates const& after) {
  constexpr Index part = 16384;
  std::vector<double> squared(std::size_t((before.size() + part - 1) / part), 0);
  detail::for_all({}, "gridmorph::cli::largest_displacement", Index(squared.size()), [&](Index p) {
    for (Index n = p * part; n < std::min(before.size(), (p + 1) * part); ++n) {
      Vec3 const u = after[n] - before[n];
      squared[p] = std::max(squared[p], dot(u, u));
    }
  });
  return std::sqrt(*std::max_element(squared.begin(), squared.end()));
}

/// Throws ConfigError when an output or the report cannot be written where it should.
void check_sequence_outputs(CaseFile const& case_file, MeshSource const& file) {
  auto const& options = *case_file.sequence;
  if (options.output.empty())
    throw ConfigError(fmt::format("{}: no output; add {} or give --output FILE", case_file.source.string(),
                                  options.is_sweep() ? "output = \"design_{design}.cgns\" to [sweep]"
                                                     : "output = \"series.cgns\" or output = \"step_{step}.cgns\" to "
                                                       "[sequence]"));
  if (options.is_sweep() && !one_file_per_step(options))
    throw ConfigError(
        fmt::format("{}: the output '{}' of a [sweep] has no {{design}} in its name, which tells the files "
                    "of designs apart; write 'design_{{design}}{}'",
                    case_file.source.string(), options.output.string(), options.output.extension().string()));
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
std::pair<double, double> badness(SequenceStep const& step) {
  return {step.passages.front().determinant, step.passages.front().inversion};
}

/// Designs that are left out and listed.
constexpr std::size_t most_named = 20;

class Sequence {
 public:
  Sequence(CaseFile const& case_file, MeshSource const& file, Console& console, std::string const& typed)
      : case_file_(case_file),
        options_(*case_file.sequence),
        file_(file),
        console_(console),
        page_(case_file.output_options.page ? std::make_optional<RunPage>(case_file, typed) : std::nullopt),
        run_(case_file, file, console),
        // Steps are compared by what a verdict holds. Pages and files show all measures of all steps.
        verdicts_(case_file.guard.quality == QualityMode::automatic && !page_ && !case_file.output_options.quality &&
                  !wants_verdict(case_file, run_.mesh().n_cells())) {
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
    run_.measure(verdicts_);
    return true;
  }

  void make_steps() {
    sequence_ = {options_, {}, 0};
    stepped_.clear();
    relaxed_ = 0;
    worst_for_retry_ = 0;
    inverted_ = false;
    files_.emplace(case_file_, run_.mesh());
    for (int step = 0; step < options_.steps; ++step) {
      console_.progress(fmt::format("{} {} of {}", options_.step_word(), step + 1, options_.steps),
                        double(step) / options_.steps);
      make_step(step);
    }
  }

  void make_step(int step) {
    std::string const count = fmt::format(", {} {}s", options_.steps, options_.step_word());
    Moment const& moment = moments_[step];
    part_.lap();
    relaxed_ = std::max(relaxed_, run_.morph(&moment).before);
    add_time(run_.times, "morph" + count, part_.lap(), false);
    run_.measure(verdicts_);
    if (!case_file_.guard.freeze)  // steps would be beside the plan
      if (auto const tried = run_.try_steps(); !tried.text.empty()) stepped_[step] = tried.text;
    add_time(run_.times, "quality" + count, part_.lap(), false);
    judge(step);
    if (page_) page_->add_step(run_, step, options_.steps, sequence_.worst == std::size_t(step));
    part_.lap();
    if (is_usable(sequence_.steps.back()))
      files_->add(step, run_.morphed(), run_.fields());
    else
      sequence_.steps.back().left_out = true;
    add_time(run_.times, "write" + count, part_.lap(), false);
  }

  /// Once a step over time cannot be used the files are not needed; the table still says how the others fare. Designs
  /// are used one by one.
  [[nodiscard]] bool is_usable(SequenceStep const& step) const {
    if (case_file_.guard.write_inverted) return true;
    return options_.is_sweep() ? step.newly_inverted() == 0 : !inverted_;
  }

  void judge(int step) {
    auto& steps = sequence_.steps;
    auto& now = steps.emplace_back(SequenceStep{options_.time_at(step)});
    now.passages = {morphed_step(largest_displacement(run_.mesh().coordinates(), run_.morphed()), run_.quality(),
                                 run_.clearances(&moments_[step]))};
    for (auto const& s : run_.shortfalls_of(run_.quality()))
      if (s.severity == Shortfall::Severity::failure) now.failures.push_back(s.message);
    inverted_ = inverted_ || now.newly_inverted() > 0;
    if (step == 0 || badness(now) < badness(steps[sequence_.worst])) {
      sequence_.worst = std::size_t(step);
      worst_quality_ = run_.quality();
    }
    if (Badness const now = badness_of(run_.quality()); step == 0 || most_ < now) {
      most_ = now;
      worst_for_retry_ = std::size_t(step);
    }
  }

  void look_at_worst() {
    auto const& steps = sequence_.steps;
    written_ = std::any_of(steps.begin(), steps.end(), [&](SequenceStep const& step) { return is_usable(step); });
    (void)run_.morph(&moments_[sequence_.worst]);
    if (verdicts_ || !written_ || page_) {  // what is said of the worst cell needs it as it came out in the end
      run_.measure();
      if (!case_file_.guard.freeze) (void)run_.try_steps();
    }
    if (verdicts_) {
      worst_quality_ = run_.quality();
      run_.times.push_back({"quality of the worst", part_.lap(), false});
    }
    add_guard_notes();
    document_ = run_.document(worst_quality_, guarded_);
    document_.mesh->clearances = sequence_.steps[sequence_.worst].passages.front().clearances;
    document_.sequence = std::move(sequence_);
  }

  /// What the guard did in the steps.
  void add_guard_notes() {
    constexpr std::size_t most_notes = 8;  // of more of them the number
    if (relaxed_ > 0)
      guarded_.notes.push_back(fmt::format("in a {} up to {} {}; displacements around them are smoothed",
                                           options_.step_word(), relaxed_, run_.mesh().kind().lost));
    std::size_t shown = 0;
    for (auto const& [step, text] : stepped_)
      if (shown++ < most_notes)
        guarded_.notes.push_back(fmt::format("{} {}: {}", options_.step_word(), step + 1, text));
    if (shown > most_notes) guarded_.notes.push_back(fmt::format("the same in {} more steps", shown - most_notes));
  }

  void draw_page() {
    if (!page_) return;
    console_.progress("drawing the page");
    part_.lap();
    page_->finish(run_, worst_quality_);
    document_.times.push_back({"page", part_.lap()});
  }

  /// Designs that are not written: how many, and which they are.
  [[nodiscard]] std::string wrote() const {
    std::string out = wrote_steps(options_), which;
    auto const& steps = document_.sequence->steps;
    std::size_t count = 0;
    for (std::size_t s = 0; s < steps.size(); ++s)
      if (steps[s].left_out && ++count <= most_named) which += (which.empty() ? "" : ", ") + std::to_string(s + 1);
    if (count == 0) return out;
    return out + fmt::format("not written: {} of {} designs, whose cells are inverted: {}{}\n", count, steps.size(),
                             which, count > most_named ? ", ..." : "");
  }

  int end() {
    return conclude({.document = document_,
                     .options = case_file_.output_options,
                     .output = options_.output,
                     .page = page_,
                     .written = written_,
                     .write =
                         [&] {
                           if (written_) files_->commit();
                         },
                     .wrote = wrote(),
                     .refusal =
                         [&] {
                           return run_.refusal_of(options_.output,
                                                  options_.is_sweep() ? "all designs have cells" : "steps have cells",
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
  bool const verdicts_;  ///< is what of the steps is measured; of the worst all in the end
  std::vector<Moment> moments_;
  Stopwatch part_;
  Guarded guarded_;
  std::optional<StepFiles> files_;
  MorphedSequence sequence_;
  std::map<int, std::string> stepped_;  ///< steps whose way was made in several
  Index relaxed_ = 0;                   ///< most cells that were bad in a step
  QualityReport worst_quality_;
  std::size_t worst_for_retry_ = 0;
  Badness most_;  ///< of worst_for_retry_
  bool inverted_ = false, written_ = false;
  RunDocument document_;
};

}  // namespace

int morph_sequence(CaseFile const& case_file, MeshSource const& file, Console& console, std::string const& typed) {
  check_sequence_outputs(case_file, file);
  return Sequence(case_file, file, console, typed)();
}

}  // namespace gridmorph::cli
