#include <gridmorph/app/cli/commands.hpp>
#include <gridmorph/app/cli/run_files.hpp>
#include <gridmorph/app/cli/wheel_run.hpp>
#include <gridmorph/app/run.hpp>
#include <gridmorph/core/error.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace gridmorph::cli {

int run_wheel_command(CommandLine const& options, Terminal& terminal) {
  CaseFile case_file = read_case_file(*options.case_document);
  set_quality(case_file, options.quality);
  if (!case_file.wheel)
    throw ConfigError(options.input.string() + ": no [wheel]; add [wheel] with output = \"wheel.cgns\"");
  auto const output = options.output.value_or(case_file.wheel->output);
  auto const report = options.report ? options.report : case_file.output_options.report;
  if (output.empty())
    throw ConfigError(options.input.string() +
                      ": no output; add output = \"wheel.cgns\" to [wheel] or give --output FILE");
  MeshSource const file = checked_mesh_file(case_file, CaseUse::Run::wheel);
  if (case_file.sequence) return wheel_sequence(case_file, file, output, report, terminal);
  RunFiles outputs = outputs_of(output, report);
  outputs.front().what = "wheel";  // CGNS, whatever the sector is
  check_run_files(inputs_of(case_file, file), outputs);

  WheelRun run(case_file, file.kind, terminal);
  run.prepare();
  MeshFileWriter writer(output.string(), run.wheel().mesh);
  WheelResult const result = run.result(run.make(
      0, [&](int zone, double const* x, double const* y, double const* z) { writer.write_zone(zone, x, y, z); }));
  bool const written = !any_inverted(result) || case_file.guard.write_inverted;
  std::vector<std::string> const failures = failures_of(result);
  return conclude(
      {.output = output,
       .report = report,
       .written = written,
       .falls_short = !failures.empty(),
       .json = [&] { return wheel_json(run, case_file, result); },
       .write =
           [&] {
             if (written) writer.commit();
           },
       .text = [&] { return wheel_text(run, result); },
       .wrote = fmt::format("\nwrote {}\n", output.string()),
       .also_wrote = {},
       .warnings = failures,
       .refusal = [&] { return wheel_refusal(run, output, "cells are inverted that were not in the baseline"); }},
      terminal);
}

}  // namespace gridmorph::cli
