#include <gridmorph/command/commands.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/run/run.hpp>

#include <fmt/format.h>

namespace gridmorph::cli {

void set_quality(CaseFile& case_file, std::optional<std::string> const& mode) {
  if (mode)
    case_file.guard.quality = *mode == "full"   ? QualityMode::full
                              : *mode == "fast" ? QualityMode::fast
                                                : QualityMode::automatic;
}

int run_morph_command(CommandLine const& options, Terminal& terminal) {
  CaseFile case_file = read_case_file(*options.case_document, options.parameters);
  if (options.output) (case_file.sequence ? case_file.sequence->output : case_file.output) = *options.output;
  if (options.report) case_file.output_options.report = *options.report;
  if (options.page) case_file.output_options.page = *options.page;
  set_quality(case_file, options.quality);
  if (options.fraction) {
    if (case_file.sequence)
      throw ConfigError(
          fmt::format("{}: --fraction is for one mesh, and this has [{}]; change the amplitudes of its rules",
                      case_file.source.string(), case_file.sequence->is_sweep() ? "sweep" : "sequence"));
    take_fraction(case_file, *options.fraction);
  }
  if (options.dry_run) {
    print_plan(case_file, terminal);
    return done;
  }
  if (case_file.sequence)
    return morph_sequence(case_file, checked_mesh_file(case_file, CaseUse::Run::sequence), terminal, options.typed);
  MeshSource const file = checked_mesh_file(case_file, CaseUse::Run::morph);
  if (case_file.output.empty())
    throw ConfigError(fmt::format("{}: no output; add output = \"morphed.cgns\" to [mesh] or give --output FILE",
                                  options.input.string()));
  return morph_once(case_file, file, terminal, options.typed);
}

}  // namespace gridmorph::cli
