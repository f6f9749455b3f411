// The commands. Each returns the exit status 0, 1 or 4 and throws for the others (main maps errors to 2 and 3).
#pragma once

#include <gridmorph/case/case_file.hpp>
#include <gridmorph/command/command_line.hpp>
#include <gridmorph/command/terminal.hpp>
#include <gridmorph/run/exit_status.hpp>

namespace gridmorph::cli {

/// "auto", "full" or "fast" of the command line takes the place of the case file's.
void set_quality(CaseFile& case_file, std::optional<std::string> const& mode);

int run_morph_command(CommandLine const& options, Terminal& terminal);
int run_inspect_command(CommandLine const& options, Terminal& terminal);
int run_plan_command(CommandLine const& options, Terminal& terminal);
int run_certify_command(CommandLine const& options, Terminal& terminal);
int run_quality_command(CommandLine const& options, Terminal& terminal);
int run_wheel_command(CommandLine const& options, Terminal& terminal);
int run_surface_command(CommandLine const& options, Terminal& terminal);
int run_fillet_command(CommandLine const& options, Terminal& terminal);
int run_blocks_command(CommandLine const& options, Terminal& terminal);
int run_hexahedra_command(CommandLine const& options, Terminal& terminal);
int run_view_command(CommandLine const& options, Terminal& terminal);
int run_keys_command(CommandLine const& options, Terminal& terminal);
int run_demo_command(CommandLine const& options, Terminal& terminal);

}  // namespace gridmorph::cli
