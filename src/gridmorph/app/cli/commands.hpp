// The commands. Each returns the exit status 0, 1 or 4 and throws for the others (main maps errors to 2 and 3).
#pragma once

#include <gridmorph/app/casefile/case_file.hpp>
#include <gridmorph/app/cli/command_line.hpp>
#include <gridmorph/app/cli/terminal.hpp>

namespace gridmorph::cli {

enum ExitStatus : int {
  done = 0,
  falls_short = 1,  ///< the mesh was morphed and written, but misses the thresholds
  bad_input = 2,
  machine_failure = 3,
  not_written = 4  ///< the mesh was morphed and has inverted cells that were not in the baseline
};

inline int status_of_morph(bool written, bool short_of_thresholds) {
  return !written ? not_written : short_of_thresholds ? falls_short : done;
}

/// "auto", "full" or "fast" of the command line takes the place of the case file's.
void set_quality(CaseFile& case_file, std::optional<std::string> const& mode);

int run_morph_command(CommandLine const& options, Terminal& terminal);
int run_inspect_command(CommandLine const& options, Terminal& terminal);
int run_plan_command(CommandLine const& options, Terminal& terminal);
int run_quality_command(CommandLine const& options, Terminal& terminal);
int run_wheel_command(CommandLine const& options, Terminal& terminal);
int run_surface_command(CommandLine const& options, Terminal& terminal);
int run_fillet_command(CommandLine const& options, Terminal& terminal);
int run_hexahedra_command(CommandLine const& options, Terminal& terminal);
int run_view_command(CommandLine const& options, Terminal& terminal);
int run_keys_command(CommandLine const& options, Terminal& terminal);
int run_demo_command(CommandLine const& options, Terminal& terminal);

}  // namespace gridmorph::cli
