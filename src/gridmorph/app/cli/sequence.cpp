#include <gridmorph/app/cli/commands.hpp>
#include <gridmorph/app/cli/diagnosis.hpp>
#include <gridmorph/app/cli/morph_command.hpp>
#include <gridmorph/app/cli/sequence.hpp>
#include <gridmorph/app/cli/sequence_steps.hpp>
#include <gridmorph/app/cli/step_files.hpp>
#include <gridmorph/core/stopwatch.hpp>

#include <nlohmann/json.hpp>

#include <string>

namespace gridmorph::cli {

int morph_sequence(CaseFile const& case_file, Terminal& terminal) {
  check_sequence_outputs(case_file);
  auto const& options = *case_file.sequence;
  Stopwatch watch;
  terminal.progress("reading " + case_file.input.string());
  MorphResult result = read_baseline(case_file);
  result.times.push_back({"read", watch.lap(), true});
  Engine const engine(result.mesh, case_file, terminal);
  result.times.insert(result.times.end(), engine.times().begin(), engine.times().end());
  QualityMeter const meter(result.mesh, case_file, engine);
  result.before = meter.baseline();

  StepFiles files(case_file, result.mesh);
  result.morphed = Coordinates(result.mesh.n_nodes());
  auto const morph = [&](int step) { engine.morph_into(motion_at(case_file, options.moment(step)), result.morphed); };
  Steps const steps =
      run_steps(case_file, terminal, files,
                {morph, [&] { return meter.morphed(result.morphed); }, [&] { return output_fields(case_file, result); },
                 result.mesh.coordinates, result.morphed});
  morph(int(steps.worst()));
  result.after = meter.morphed(result.morphed);
  result.shortfalls = shortfalls(result.before, result.after, thresholds_of(case_file));
  if (!result.after.fast) result.stages = engine.stage_results(result.morphed);
  result.notes = engine.notes();
  add_mapping_notes(case_file, result.notes);
  result.times.insert(result.times.end(), steps.times.begin(), steps.times.end());

  std::string head;
  for (auto const& note : result.notes) head += "note: " + note + "\n";
  if (!head.empty()) head += "\n";
  return finish_sequence(
      case_file, terminal, files, steps,
      {[&] { return report_json(case_file, result); }, head, format_result(case_file, result), result.shortfalls,
       "[volume] or [boundary_layer]",
       [&] { return diagnose(case_file, for_messages(result.mesh), result.after, result.morphed); }});
}

}  // namespace gridmorph::cli
