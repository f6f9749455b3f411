#include <gridmorph/command/commands.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/run/ending.hpp>
#include <gridmorph/run/run.hpp>
#include <gridmorph/run/run_files.hpp>
#include <gridmorph/run/wheel_page.hpp>
#include <gridmorph/run/wheel_run.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <optional>

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
  auto const page_file = options.page ? options.page : case_file.output_options.page;
  if (case_file.sequence && page_file)
    throw ConfigError(
        options.input.string() +
        ": a wheel over time has no page; leave out --html and html of [output], or make the wheel of one "
        "time without [sequence]");
  if (case_file.sequence) return wheel_sequence(case_file, file, output, report, terminal);
  RunFiles outputs = outputs_of(output, report);
  outputs.front().what = "wheel";  // CGNS, whatever the sector is
  if (page_file) outputs.push_back({"page", *page_file});
  check_run_files(inputs_of(case_file, file), outputs);

  std::optional<RunPage> page;
  if (page_file) page.emplace(case_file, options.typed);
  WheelRun run(case_file, terminal);
  if (page) run.keep_worst();
  run.prepare();
  MeshFileWriter writer(output.string(), run.wheel().mesh);
  WheelResult result = run.result(run.make(
      0, [&](int zone, double const* x, double const* y, double const* z) { writer.write_zone(zone, x, y, z); }));
  if (page) {
    terminal.progress("drawing the page");
    Stopwatch watch;
    fill_wheel_page(run, case_file, result, *page);
    result.times.push_back({"page", watch.lap()});
  }
  bool const written = !any_inverted(result) || case_file.guard.write_inverted;
  std::vector<std::string> const failures = failures_of(result);
  return conclude(
      {.output = output,
       .report = report,
       .page = page_file,
       .written = written,
       .falls_short = !failures.empty(),
       .json = [&] { return wheel_json(run, case_file, result); },
       .page_text =
           [&](nlohmann::json const& json) { return page->text(wheel_page_json(run, case_file, result, json)); },
       .write =
           [&] {
             if (written) writer.commit();
             if (written && page) page->add_output(output);
           },
       .text = [&] { return wheel_text(run, result); },
       .wrote = fmt::format("\nwrote {}\n", output.string()),
       .also_wrote = wrote_report(page_file),
       .warnings = failures,
       .refusal = [&] { return wheel_refusal(run, output, "cells are inverted that were not in the baseline"); }},
      terminal);
}

}  // namespace gridmorph::cli
