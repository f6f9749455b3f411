// A wheel over time: every step of [sequence] with one plan for all passages and steps.
#include <gridmorph/io/output_file.hpp>
#include <gridmorph/run/ending.hpp>
#include <gridmorph/run/run.hpp>
#include <gridmorph/run/run_files.hpp>
#include <gridmorph/run/step_files.hpp>
#include <gridmorph/run/wheel_run.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

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
    commit_steps(files_, options_);
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

std::string wrote_text(SequenceOptions const& options) {
  return one_file_per_step(options) ? fmt::format("\nwrote {} ... {}\n", step_path(options, 0).string(),
                                                  step_path(options, options.steps - 1).string())
                                    : fmt::format("\nwrote {} ({} steps)\n", options.output.string(), options.steps);
}

/// "step 3, passage 2: ...", of all steps.
std::vector<std::string> failures_of_steps(std::vector<WheelStep> const& steps) {
  std::vector<std::string> out;
  for (std::size_t s = 0; s < steps.size(); ++s)
    for (auto const& failure : steps[s].failures) out.push_back(fmt::format("step {}, {}", s + 1, failure));
  constexpr std::size_t most = 16;
  if (out.size() > most) {
    std::size_t const more = out.size() - most;
    out.resize(most);
    out.push_back(fmt::format("{} more; the report has them", more));
  }
  return out;
}

}  // namespace

int wheel_sequence(CaseFile const& case_file, MeshSource const& file, std::filesystem::path const& output,
                   std::optional<std::filesystem::path> const& report, Console& console) {
  SequenceOptions options = *case_file.sequence;
  options.output = output;
  RunFiles outputs;
  for (int step = 0; step < (one_file_per_step(options) ? options.steps : 1); ++step)
    outputs.push_back({"wheel", step_path(options, step)});
  if (report) outputs.push_back({"report", *report});
  check_run_files(inputs_of(case_file, file), outputs);

  WheelRun run(case_file, console);
  run.prepare();
  WheelFiles files(options, run.wheel().mesh);
  if (files.wants_baseline()) files.write_baseline([&](ZoneSink const& sink) { run.make_baseline(sink); });
  std::vector<WheelStep> steps;
  WheelMade worst;
  bool inverted = false;
  for (int step = 0; step < options.steps; ++step) {
    WheelMade made;
    // Once a step cannot be used the files are not needed; the table still says how the others fare.
    if (inverted && !case_file.guard.write_inverted)
      made = run.make(step, [](int, double const*, double const*, double const*) {});
    else
      files.add([&](ZoneSink const& sink) { made = run.make(step, sink); });
    run.time("write");
    inverted = inverted || any_inverted(made);
    steps.push_back(wheel_step(options.time_at(step), made));
    if (worst_step(steps) + 1 == steps.size()) worst = std::move(made);
  }
  std::size_t const at = worst_step(steps);
  bool const written = !inverted || case_file.guard.write_inverted;
  WheelResult const result = run.result(std::move(worst));
  std::vector<std::string> const failures = failures_of_steps(steps);
  return conclude(
      {.output = output,
       .report = report,
       .written = written,
       .falls_short = !failures.empty(),
       .json =
           [&] {
             nlohmann::json json = wheel_json(run, case_file, result);
             nlohmann::json list = wheel_steps_json(steps);
             for (std::size_t s = 0; s < steps.size() && one_file_per_step(options); ++s)
               list[s]["file"] = step_path(options, int(s)).string();
             json["sequence"] = {{"period", options.period},
                                 {"periods", options.periods},
                                 {"worst_step", at + 1},
                                 {"steps", std::move(list)}};
             return json;
           },
       .write =
           [&] {
             if (written) files.commit();
           },
       .text =
           [&] {
             std::string const tips = wheel_clearances(steps);
             return wheel_steps_table(steps) + "\nall steps\n\n" + passages_over_time(steps, result) +
                    (tips.empty() ? "" : "\n" + tips) + fmt::format("\nstep {}, the worst one\n\n", at + 1) +
                    wheel_text(run, result);
           },
       .wrote = wrote_text(options),
       .also_wrote = wrote_report(report),
       .warnings = failures,
       .refusal =
           [&] { return wheel_refusal(run, output, "steps have cells inverted that were not in the baseline"); }},
      console);
}

}  // namespace gridmorph::cli
