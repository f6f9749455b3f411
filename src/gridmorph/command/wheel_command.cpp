#include <gridmorph/command/commands.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/run/run.hpp>
#include <gridmorph/run/wheel_run.hpp>

namespace gridmorph::cli {

int run_wheel_command(CommandLine const& options, Terminal& terminal) {
  CaseFile case_file = read_case_file(*options.case_document, options.parameters);
  set_quality(case_file, options.quality);
  if (!case_file.wheel)
    throw ConfigError(options.input.string() + ": no [wheel]; add [wheel] with output = \"wheel.cgns\"");
  if (options.output) case_file.wheel->output = *options.output;
  if (options.report) case_file.output_options.report = *options.report;
  if (options.page) case_file.output_options.page = *options.page;
  if (case_file.wheel->output.empty())
    throw ConfigError(options.input.string() +
                      ": no output; add output = \"wheel.cgns\" to [wheel] or give --output FILE");
  MeshSource const file = checked_mesh_file(case_file, CaseUse::Run::wheel);
  return case_file.sequence ? wheel_sequence(case_file, file, terminal, options.typed)
                            : wheel_once(case_file, file, terminal, options.typed);
}

}  // namespace gridmorph::cli
