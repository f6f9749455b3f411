#include <gridmorph/cli/commands.hpp>
#include <gridmorph/cli/diagnosis.hpp>
#include <gridmorph/cli/morph_command.hpp>
#include <gridmorph/cli/sequence.hpp>
#include <gridmorph/cli/sequence_steps.hpp>
#include <gridmorph/cli/step_files.hpp>
#include <gridmorph/cli/unstructured_run.hpp>
#include <gridmorph/unstructured/guard.hpp>
#include <gridmorph/unstructured/unstructured_morpher.hpp>

#include <fmt/format.h>
#include <Kokkos_Core.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <string>

namespace gridmorph::cli {

namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;

/// The plan on the host, applied step by step.
class Stepper {
 public:
  Stepper(CaseFile const& case_file, UnstructuredRun& run)
      : case_file_(case_file), run_(run), morpher_(exec_, run.prepared->plan) {
    run_.result.morphed = Coordinates(run_.loaded.mesh.n_nodes());
  }

  void morph(int step) {
    auto const motion = motion_at(case_file_, case_file_.sequence->periods_at(step));
    auto const boundary = evaluate(run_.loaded.mesh, run_.prepared->boundary, motion);
    Coordinates const& moved = run_.result.morphed;
    apply_on_host(morpher_, boundary, run_.loaded.mesh.coordinates, moved);
    auto const& l = run_.loaded;
    RelaxOptions const options{.signs = l.signs};
    relaxed_ = std::max(relaxed_, relax_bad_elements(l.mesh, l.topology, *run_.prepared, moved, options).before);
  }
  /// Most elements that were bad in a step.
  [[nodiscard]] Index relaxed() const { return relaxed_; }

 private:
  CaseFile const& case_file_;
  UnstructuredRun& run_;
  Exec exec_;
  UnstructuredMorpher<Exec> morpher_;
  Index relaxed_ = 0;
};

}  // namespace

int morph_unstructured_sequence(CaseFile const& case_file, Terminal& terminal) {
  check_sequence_outputs(case_file);
  UnstructuredRun run;
  read_and_plan(case_file, terminal, run);
  auto const& l = run.loaded;
  measure_baseline(case_file, run);
  StepFiles files(case_file, l.mesh);
  Stepper stepper(case_file, run);
  Steps const steps = run_steps(case_file, terminal, files,
                                {[&](int step) { stepper.morph(step); },
                                 [&] {
                                   measure_result(case_file, run);
                                   return run.result.after;
                                 },
                                 [&] { return run.result.fields; }, l.mesh.coordinates, run.result.morphed});
  stepper.morph(int(steps.worst()));
  measure_result(case_file, run);
  if (stepper.relaxed() > 0)
    run.notes.push_back(
        fmt::format("in a step up to {} elements had lost four fifths of their determinant or more; "
                    "displacements around them are smoothed",
                    stepper.relaxed()));
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
