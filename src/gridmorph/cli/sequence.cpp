#include <gridmorph/cli/commands.hpp>
#include <gridmorph/cli/morph_command.hpp>
#include <gridmorph/cli/output_files.hpp>
#include <gridmorph/cli/sequence.hpp>
#include <gridmorph/cli/sequence_steps.hpp>
#include <gridmorph/cli/step_files.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/stopwatch.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph::cli {

int morph_sequence(CaseFile const& case_file, Terminal& terminal) {
  check_sequence_outputs(case_file);
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
    steps.push_back(step_result(options.time_at(step), result.mesh.coordinates, result.morphed, quality));
    inverted = inverted || steps.back().newly_inverted > 0;
    part.lap();
    // Once a step cannot be used the files are not needed; the table still says how the others fare.
    if (!inverted || case_file.guard.write_inverted) files.add(result.morphed, output_fields(case_file, result));
    writing += part.lap();
  }
  std::size_t const worst = worst_of(steps);
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
    json["sequence"] = steps_json(steps, worst, options);
    pending.emplace(*report, json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
  }
  if (written) {
    terminal.progress("writing " + options.output.string());
    files.commit();
  }
  if (pending) pending->commit();

  std::string text;
  for (auto const& note : result.notes) text += "note: " + note + "\n";
  text += (text.empty() ? "" : "\n") + steps_table(steps, worst);
  text += fmt::format("\nstep {}, the worst one\n\n", worst + 1);
  text += format_result(case_file, result);
  if (written) text += wrote_text(options);
  if (report) text += fmt::format("wrote {}\n", report->string());
  terminal.say(text);
  if (terminal.quiet())
    for (auto const& s : result.shortfalls) terminal.warn(s.message);
  if (!written) terminal.error(refusal_text(options, "[volume] or [boundary_layer]"));
  return any_failure(result.shortfalls) || !written ? falls_short : done;
}

}  // namespace gridmorph::cli
