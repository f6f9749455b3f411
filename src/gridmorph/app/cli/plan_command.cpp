#include <gridmorph/app/cli/commands.hpp>
#include <gridmorph/app/run.hpp>

namespace gridmorph::cli {

int run_plan_command(CommandLine const& options, Terminal& terminal) {
  CaseFile case_file = read_case_file(*options.case_document);
  if (options.optimise) case_file.plan.volume.order = OrderBy::prediction;
  print_plan(case_file, terminal);
  return done;
}

}  // namespace gridmorph::cli
