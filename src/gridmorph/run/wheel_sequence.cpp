// A wheel over time: every step of [sequence] with one plan for all passages and steps.
#include <gridmorph/io/output_file.hpp>
#include <gridmorph/run/ending.hpp>
#include <gridmorph/run/run_files.hpp>
#include <gridmorph/run/step_files.hpp>
#include <gridmorph/run/wheel_page.hpp>
#include <gridmorph/run/wheel_run.hpp>

#include <fmt/format.h>

#include <deque>
#include <memory>
#include <optional>
#include <utility>

namespace gridmorph::cli {

namespace {

/// The wheels of all steps beside their places: one CGNS file each, or one with the baseline and a series.
class WheelFiles {
 public:
  WheelFiles(SequenceOptions const& options, Mesh const& wheel) : options_(options), wheel_(wheel) {}

  /// What takes the zones of the baseline; empty where there is no place for it.
  [[nodiscard]] bool wants_baseline() const { return !one_file_per_step(options_); }
  void write_baseline(std::function<void(ZoneSink const&)> const& make) {
    baseline_.emplace(options_.output.string());
    write_file(baseline_->path(), make);
    std::vector<double> times;
    for (int step = 0; step < options_.steps; ++step) times.push_back(options_.time_at(step));
    series_ = std::make_unique<SeriesWriter>(baseline_->path(), options_.output.string(), wheel_, times);
  }
  /// The next step. Nothing is kept of it where `make` says so.
  void add(std::function<void(ZoneSink const&)> const& make) {
    if (series_) {
      make([&](int zone, double const* x, double const* y, double const* z) { series_->add_zone(zone, x, y, z); });
      return;
    }
    write_file(files_.emplace_back(step_path(options_, int(files_.size())).string()).path(), make);
  }
  void commit() {
    if (series_) {
      series_->commit();
      return;
    }
    commit_steps(files_);
  }

 private:
  void write_file(std::string const& path, std::function<void(ZoneSink const&)> const& make) const {
    MeshFileWriter writer(path, wheel_);
    make([&](int zone, double const* x, double const* y, double const* z) { writer.write_zone(zone, x, y, z); });
    writer.commit();
  }

  SequenceOptions const& options_;
  Mesh const& wheel_;
  std::optional<io::OutputFile> baseline_;  ///< that the series is added to
  std::unique_ptr<SeriesWriter> series_;
  std::deque<io::OutputFile> files_;
};

class WheelSequence {
 public:
  WheelSequence(CaseFile const& case_file, MeshSource const& file, SequenceOptions options, Console& console,
                std::string const& typed)
      : case_file_(case_file),
        options_(std::move(options)),
        console_(console),
        page_(case_file.output_options.page ? std::make_optional<RunPage>(case_file, typed) : std::nullopt),
        run_(case_file, file, console) {
    if (page_) run_.keep_worst();
  }

  int operator()() {
    run_.prepare();
    make_steps();
    written_ = !inverted_ || case_file_.guard.write_inverted;
    document_ = run_.document(worst_made_);
    document_.sequence = std::move(sequence_);
    if (page_) draw_wheel_page(run_, case_file_, *worst_made_.worst, document_, *page_, console_);
    return end();
  }

 private:
  void make_steps() {
    files_.emplace(options_, run_.wheel().mesh);
    if (files_->wants_baseline()) files_->write_baseline([&](ZoneSink const& sink) { run_.make_baseline(sink); });
    for (int step = 0; step < options_.steps; ++step) make_step(step);
  }

  void make_step(int step) {
    WheelMade made;
    // Once a step cannot be used the files are not needed; the table still says how the others fare.
    if (inverted_ && !case_file_.guard.write_inverted)
      made = run_.make(step, [](int, double const*, double const*, double const*) {});
    else
      files_->add([&](ZoneSink const& sink) { made = run_.make(step, sink); });
    run_.time("write");
    inverted_ = inverted_ || any_inverted(made);
    sequence_.steps.push_back(wheel_step(options_.time_at(step), made.wheel.passages));
    if (step > 0 && !is_worse(sequence_.steps.back(), sequence_.steps[sequence_.worst])) return;
    sequence_.worst = sequence_.steps.size() - 1;
    worst_made_ = std::move(made);
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
                     .wrote = wrote_steps(options_),
                     .refusal =
                         [&] {
                           return wheel_refusal(run_, options_.output,
                                                "steps have cells inverted that were not in the baseline");
                         }},
                    console_);
  }

  CaseFile const& case_file_;
  SequenceOptions options_;
  Console& console_;
  std::optional<RunPage> page_;
  WheelRun run_;
  std::optional<WheelFiles> files_;
  MorphedSequence sequence_{options_, {}, 0};
  WheelMade worst_made_;
  RunDocument document_;
  bool inverted_ = false, written_ = false;
};

}  // namespace

int wheel_sequence(CaseFile const& case_file, MeshSource const& file, Console& console, std::string const& typed) {
  SequenceOptions options = *case_file.sequence;
  options.output = case_file.wheel->output;
  RunFiles wheels;
  for (int step = 0; step < (one_file_per_step(options) ? options.steps : 1); ++step)
    wheels.push_back({"wheel", step_path(options, step)});
  check_run_files(inputs_of(case_file, file), outputs_of(std::move(wheels), case_file.output_options));
  return WheelSequence(case_file, file, std::move(options), console, typed)();
}

}  // namespace gridmorph::cli
