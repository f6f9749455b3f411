#include <gridmorph/command/commands.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/run/run.hpp>

#include <fmt/format.h>

namespace gridmorph::cli {

int run_plan_command(CommandLine const& options, Terminal& terminal) {
  CaseFile case_file = read_case_file(*options.case_document, options.parameters);
  if (options.optimise) case_file.plan.volume.order = OrderBy::prediction;
  if (options.graph) {
    auto const ending = options.graph->extension();
    if (ending != ".svg" && ending != ".dot" && ending != ".gv")
      throw ConfigError(
          fmt::format("--graph {}: a drawing is NAME.svg, or NAME.dot for Graphviz", options.graph->string()));
  }
  print_plan(case_file, terminal, {options.graph, options.all});
  return done;
}

}  // namespace gridmorph::cli
