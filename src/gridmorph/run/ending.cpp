#include <gridmorph/report/json_text.hpp>
#include <gridmorph/run/ending.hpp>
#include <gridmorph/run/exit_status.hpp>
#include <gridmorph/run/output_files.hpp>

#include <fmt/format.h>

namespace gridmorph::cli {

int conclude(Ending const& ending, Console& console) {
  RunDocument& document = ending.document;
  OutputOptions const& options = ending.options;
  if (ending.written) document.output = ending.output.string();
  // The report waits beside its place until the mesh is there: both appear, or none. It has room to spare for the time
  // that writing the mesh takes.
  std::optional<PendingFile> pending, page;
  std::string const room(room_for_a_time, '\n');
  if (options.report) pending.emplace(*options.report, json_text(run_json(document)) + room);
  if (ending.page) page.emplace(*options.page, ending.page->text(run_json(document)) + room);
  if (ending.written) console.progress("writing " + ending.output.string());
  ending.write();
  nlohmann::json const json = run_json(document);
  std::string text = run_text(document) + (ending.written ? ending.wrote : std::string());
  if (pending) {
    pending->replace(json_text(json));
    pending->commit();
    text += fmt::format("wrote {}\n", options.report->string());
  }
  if (page) {
    page->replace(ending.page->text(json));
    page->commit();
    text += fmt::format("wrote {}\n", options.page->string());
  }
  console.say(text + ending.also_wrote);
  console.document(json);
  if (document.wheel || console.quiet())
    for (auto const& warning : warnings_of(document)) console.warn(warning);
  if (!ending.written) console.error(ending.refusal());
  return status_of_morph(ending.written, misses_thresholds(document));
}

}  // namespace gridmorph::cli
