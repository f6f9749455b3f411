#include <gridmorph/command/commands.hpp>
#include <gridmorph/report/quality_json.hpp>
#include <gridmorph/report/quality_table.hpp>
#include <gridmorph/run/loaded_mesh.hpp>

#include <optional>

namespace gridmorph::cli {

int run_quality_command(CommandLine const& options, Terminal& terminal) {
  terminal.progress("reading " + options.input.string());
  LoadedMesh const mesh(options.input, {}, options.leave_out);
  std::optional<Coordinates> morphed;
  if (options.second) {
    terminal.progress("reading " + options.second->string());
    morphed = mesh.coordinates_of(*options.second, options.leave_out);
  }
  terminal.progress("measuring quality");
  QualityWanted wanted;
  wanted.fast = options.quality == "fast";
  QualityReport before;
  if (!wanted.fast || !morphed) before = mesh.measure(wanted);
  std::optional<QualityReport> after;
  if (morphed) {
    wanted.morphed = &*morphed;
    after = mesh.measure(wanted);
  }
  QualityThresholds const thresholds;
  terminal.document(quality_json(before, after, thresholds));
  if (!terminal.json()) terminal.result(format_table(before, after, thresholds));
  // A single mesh cannot have been morphed badly; a morphed one can.
  return after && any_failure(shortfalls(before, after, thresholds)) ? falls_short : done;
}

}  // namespace gridmorph::cli
