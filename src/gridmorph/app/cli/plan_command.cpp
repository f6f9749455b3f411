#include <gridmorph/app/cli/commands.hpp>
#include <gridmorph/app/run.hpp>

namespace gridmorph::cli {

int run_plan_command(CommandLine const& options, Terminal& terminal) {
  print_plan(read_case_file(*options.case_document), terminal);
  return done;
}

}  // namespace gridmorph::cli
