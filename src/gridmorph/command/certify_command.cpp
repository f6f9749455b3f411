#include <gridmorph/command/commands.hpp>
#include <gridmorph/run/certify_run.hpp>

namespace gridmorph::cli {

int run_certify_command(CommandLine const& options, Terminal& terminal) {
  CertifyOptions const wanted{options.parameters, options.limit.value_or(1), options.report};
  return certify_case(*options.case_document, wanted, terminal) ? done : falls_short;
}

}  // namespace gridmorph::cli
