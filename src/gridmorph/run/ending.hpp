// How a run ends: meshes, report and page appear together, or a message says why not.
#pragma once

#include <gridmorph/run/console.hpp>
#include <gridmorph/run/run_page.hpp>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace gridmorph::cli {

/// What a run has made, and what it says of it.
struct Ending {
  RunDocument& document;
  OutputOptions const& options;
  std::filesystem::path output;
  std::optional<RunPage>& page;  ///< the report as a page, where one is wanted
  bool written = false;          ///< the meshes are wanted
  std::function<void()> write;   ///< puts meshes in place, where they are wanted
  std::string wrote;             ///< after the text, where the meshes are written
  std::string also_wrote = {};   ///< after reports, in any case
  std::function<std::string()> refusal;
};

/// Returns the exit status.
int conclude(Ending const& ending, Console& console);

}  // namespace gridmorph::cli
