#include <gridmorph/report/json_text.hpp>
#include <gridmorph/run/ending.hpp>
#include <gridmorph/run/exit_status.hpp>
#include <gridmorph/run/output_files.hpp>

#include <fmt/format.h>

namespace gridmorph::cli {

int conclude(Ending const& ending, Console& console) {
  auto const report = [&] {
    nlohmann::json json = ending.json();
    json["output"] = ending.written ? nlohmann::json(ending.output.string()) : nlohmann::json(nullptr);
    return json;
  };
  // The report waits beside its place until the mesh is there: both appear, or none. It has room to spare for the time
  // that writing the mesh takes.
  std::optional<PendingFile> pending, page;
  if (ending.report) pending.emplace(*ending.report, json_text(report()) + std::string(room_for_a_time, '\n'));
  if (ending.page) page.emplace(*ending.page, ending.page_text(report()) + std::string(room_for_a_time, '\n'));
  if (ending.written) console.progress("writing " + ending.output.string());
  ending.write();
  nlohmann::json const json = report();
  if (pending) {
    pending->replace(json_text(json));
    pending->commit();
  }
  if (page) {
    page->replace(ending.page_text(json));
    page->commit();
  }
  console.say(ending.text() + (ending.written ? ending.wrote : std::string()) + ending.also_wrote);
  console.document(json);
  for (auto const& warning : ending.warnings) console.warn(warning);
  if (!ending.written) console.error(ending.refusal());
  return status_of_morph(ending.written, ending.falls_short);
}

std::string wrote_report(std::optional<std::filesystem::path> const& report) {
  return report ? fmt::format("wrote {}\n", report->string()) : std::string();
}

std::vector<std::string> messages_of(std::vector<Shortfall> const& shortfalls) {
  std::vector<std::string> out;
  for (auto const& s : shortfalls) out.push_back(s.message);
  return out;
}

}  // namespace gridmorph::cli
