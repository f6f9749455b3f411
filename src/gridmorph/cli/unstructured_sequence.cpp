#include <gridmorph/cli/commands.hpp>
#include <gridmorph/cli/morph_command.hpp>
#include <gridmorph/cli/output_files.hpp>
#include <gridmorph/cli/sequence.hpp>
#include <gridmorph/cli/sequence_steps.hpp>
#include <gridmorph/cli/step_files.hpp>
#include <gridmorph/cli/unstructured_run.hpp>
#include <gridmorph/core/stopwatch.hpp>
#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/unstructured/guard.hpp>
#include <gridmorph/unstructured/unstructured_morpher.hpp>

#include <fmt/format.h>
#include <Kokkos_Core.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace gridmorph::cli {

namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;

/// The plan on the host, applied step by step.
class Stepper {
 public:
  Stepper(CaseFile const& case_file, UnstructuredRun& run)
      : case_file_(case_file), run_(run), morpher_(exec_, run.prepared->plan) {
    run_.morphed = Coordinates(run_.loaded.mesh.n_nodes());
  }

  void morph(int step) {
    auto const motion = motion_at(case_file_, case_file_.sequence->periods_at(step));
    auto const boundary = evaluate(run_.loaded.mesh, run_.prepared->boundary, motion);
    Kokkos::View<Vec3 const*, Exec::memory_space, Kokkos::MemoryTraits<Kokkos::Unmanaged>> const given(boundary.data(),
                                                                                                       boundary.size());
    Coordinates const &x = run_.loaded.mesh.coordinates, &moved = run_.morphed;
    morpher_.apply(exec_, given, {x.x.data(), x.y.data(), x.z.data()},
                   {moved.x.data(), moved.y.data(), moved.z.data()});
    compat::fence(exec_, "gridmorph::cli (step read by the host)");
    auto const& l = run_.loaded;
    relaxed_ = std::max(relaxed_, relax_bad_elements(l.mesh, l.topology, *run_.prepared, moved).before);
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
  auto const& options = *case_file.sequence;
  UnstructuredRun run;
  read_and_plan(case_file, terminal, run);
  StepFiles files(case_file, run.loaded.mesh);
  Stepper stepper(case_file, run);
  Stopwatch part;
  std::vector<StepResult> steps;
  double morphing = 0, measuring = 0, writing = 0;
  bool inverted = false;
  for (int step = 0; step < options.steps; ++step) {
    terminal.progress(fmt::format("step {} of {}", step + 1, options.steps));
    part.lap();
    stepper.morph(step);
    morphing += part.lap();
    auto const& l = run.loaded;
    QualityReport const quality = measure_quality(Exec(), l.mesh, l.topology, l.claims, quality_of_morphed(run));
    measuring += part.lap();
    steps.push_back(step_result(options.time_at(step), l.mesh.coordinates, run.morphed, quality));
    inverted = inverted || steps.back().newly_inverted > 0;
    part.lap();
    // Once a step cannot be used the files are not needed; the table still says how the others fare.
    if (!inverted || case_file.guard.write_inverted) files.add(run.morphed, output_fields(case_file, run));
    writing += part.lap();
  }
  std::size_t const worst = worst_of(steps);
  stepper.morph(int(worst));
  measure(case_file, run);
  if (stepper.relaxed() > 0)
    run.notes.push_back(
        fmt::format("in a step up to {} elements had lost four fifths of their determinant or more; "
                    "displacements around them are smoothed",
                    stepper.relaxed()));
  std::string const count = fmt::format(", {} steps", options.steps);
  run.times.push_back({"morph" + count, morphing});
  run.times.push_back({"quality" + count, measuring});
  run.times.push_back({"write" + count, writing});

  bool const written = !inverted || case_file.guard.write_inverted;
  auto const& report = case_file.output_options.report;
  std::optional<PendingFile> pending;
  if (report) {
    nlohmann::json json = report_json(case_file, run);
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
  for (auto const& note : run.notes) text += "note: " + note + "\n";
  text += regions_text(*run.prepared) + "\n" + steps_table(steps, worst);
  text += fmt::format("\nstep {}, the worst one\n\n", worst + 1);
  text += format_result(case_file, run);
  if (written) text += wrote_text(options);
  if (report) text += fmt::format("wrote {}\n", report->string());
  terminal.say(text);
  if (terminal.quiet())
    for (auto const& s : run.shortfalls) terminal.warn(s.message);
  if (!written) terminal.error(refusal_text(options, "[near_field] or [boundary_layer]"));
  return any_failure(run.shortfalls) || !written ? falls_short : done;
}

}  // namespace gridmorph::cli
