// How a run ends: meshes, report and page appear together, or a message says why not.
#pragma once

#include <gridmorph/report/shortfalls.hpp>
#include <gridmorph/run/console.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace gridmorph::cli {

/// What a run has made, and what it says of it.
struct Ending {
  std::filesystem::path output;
  std::optional<std::filesystem::path> report;
  std::optional<std::filesystem::path> page = {};  ///< the report as a page
  bool written = false;                            ///< the meshes are wanted
  bool falls_short = false;
  std::function<nlohmann::json()> json;  ///< the report, less the name of the output
  std::function<std::string(nlohmann::json const& report)> page_text = {};
  std::function<void()> write;        ///< puts meshes in place, where they are wanted
  std::function<std::string()> text;  ///< for people
  std::string wrote;                  ///< after it, where the meshes are written
  std::string also_wrote;             ///< after that, in any case
  std::vector<std::string> warnings = {};
  std::function<std::string()> refusal;
};

/// Returns the exit status.
int conclude(Ending const& ending, Console& console);

/// "wrote report.json"; empty without a report.
std::string wrote_report(std::optional<std::filesystem::path> const& report);
/// What quiet runs are told, since no table says it.
std::vector<std::string> messages_of(std::vector<Shortfall> const& shortfalls);

}  // namespace gridmorph::cli
