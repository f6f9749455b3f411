#include <gridmorph/app/cli/commands.hpp>
#include <gridmorph/app/cli/diagnosis.hpp>
#include <gridmorph/app/cli/morph_command.hpp>
#include <gridmorph/app/cli/sequence.hpp>
#include <gridmorph/app/cli/sequence_steps.hpp>
#include <gridmorph/app/cli/step_files.hpp>
#include <gridmorph/app/cli/unstructured_run.hpp>
#include <gridmorph/guard/guard.hpp>
#include <gridmorph/morph/unstructured_morpher.hpp>

#include <fmt/format.h>
#include <Kokkos_Core.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace gridmorph::cli {

namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;

/// Notes on steps that are shown; of more of them the number.
constexpr std::size_t most_notes = 8;

/// The plan on the host, applied step by step.
class Stepper {
 public:
  Stepper(CaseFile const& case_file, UnstructuredRun& run, Terminal& terminal)
      : case_file_(case_file),
        run_(run),
        terminal_(terminal),
        morpher_(exec_, run.prepared->plan, run.loaded.mesh.coordinates) {
    run_.result.morphed = Coordinates(run_.loaded.mesh.n_nodes());
  }

  void morph(int step) {
    step_ = step;
    auto const motion = motion_at(case_file_, case_file_.sequence->moment(step));
    displacement_ = evaluate(run_.loaded.mesh, run_.prepared->boundary, motion);
    Coordinates const& moved = run_.result.morphed;
    apply_on_host(morpher_, displacement_, moved);
    auto const& l = run_.loaded;
    RelaxOptions const options{.signs = l.signs};
    relaxed_ = std::max(relaxed_, relax_bad_elements(l.mesh, l.topology, *run_.prepared, moved, options).before);
  }
  /// Where elements are inverted, the way from the baseline is made in several steps, as that of a single morph.
  void measure() {
    measure_result(case_file_, run_);
    auto const tried = try_steps(case_file_, run_, displacement_, terminal_);
    if (!tried.text.empty()) stepped_[step_] = tried.text;
  }
  void add_notes(std::vector<std::string>& notes) const {
    if (relaxed_ > 0)
      notes.push_back(
          fmt::format("in a step up to {} elements had lost four fifths of their determinant or more; "
                      "displacements around them are smoothed",
                      relaxed_));
    std::size_t shown = 0;
    for (auto const& [step, text] : stepped_)
      if (shown++ < most_notes) notes.push_back(fmt::format("step {}: {}", step + 1, text));
    if (shown > most_notes) notes.push_back(fmt::format("the same in {} more steps", shown - most_notes));
  }

 private:
  CaseFile const& case_file_;
  UnstructuredRun& run_;
  Terminal& terminal_;
  Exec exec_;
  UnstructuredMorpher<Exec> morpher_;
  std::vector<Vec3> displacement_;  ///< of the step at hand
  int step_ = 0;
  Index relaxed_ = 0;                   ///< most elements that were bad in a step
  std::map<int, std::string> stepped_;  ///< steps whose way was made in several
};

}  // namespace

int morph_unstructured_sequence(CaseFile const& case_file, Terminal& terminal) {
  check_sequence_outputs(case_file);
  UnstructuredRun run;
  read_and_plan(case_file, terminal, run);
  auto const& l = run.loaded;
  measure_baseline(case_file, run);
  StepFiles files(case_file, l.mesh);
  Stepper stepper(case_file, run, terminal);
  Steps const steps = run_steps(case_file, terminal, files,
                                {[&](int step) { stepper.morph(step); },
                                 [&] {
                                   stepper.measure();
                                   return run.result.after;
                                 },
                                 [&] { return run.result.fields; }, l.mesh.coordinates, run.result.morphed});
  stepper.morph(int(steps.worst()));
  stepper.measure();
  stepper.add_notes(run.notes);
  run.times.insert(run.times.end(), steps.times.begin(), steps.times.end());

  std::string head;
  for (auto const& note : run.notes) head += "note: " + note + "\n";
  head += regions_text(*run.prepared) + "\n";
  return finish_sequence(case_file, terminal, files, steps,
                         {[&] { return report_json(case_file, run); }, head, format_result(case_file, run),
                          run.result.shortfalls, "[near_field] or [boundary_layer]",
                          [&] {
                            return diagnose(case_file, for_messages(l.mesh, run.prepared->boundary), run.result.after,
                                            run.result.morphed);
                          }});
}

}  // namespace gridmorph::cli
