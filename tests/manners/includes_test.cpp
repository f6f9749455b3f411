// The folders of the sources build on one another in one direction: read from the includes themselves.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <string>
#include <vector>

namespace {

/// From the bottom to the top: a folder includes itself and those before it.
std::vector<std::string> const order{"kernels", "core",  "geometry", "mesh", "boundary", "motion", "quality",
                                     "plan",    "morph", "guard",    "io",   "mpi",      "wheel",  "fillet",
                                     "mapping", "case",  "report",   "page", "run",      "command"};

/// What only the folder that they are in may include.
std::regex const inner(R"(^[a-z0-9_/]+/detail/|^plan/(blocks|elements)/)");

struct Include {
  std::string from, what;  ///< folder/.../file, without "gridmorph/"
};

std::vector<Include> all_includes() {
  namespace fs = std::filesystem;
  static std::regex const line_of(R"(\s*#\s*include\s*<gridmorph/([^>]+)>.*)");
  std::vector<Include> out;
  for (fs::path const& root :
       {fs::path(GRIDMORPH_SOURCES) / "src/gridmorph", fs::path(GRIDMORPH_SOURCES) / "kernels/gridmorph"})
    for (auto const& entry : fs::recursive_directory_iterator(root)) {
      if (entry.path().extension() != ".hpp" && entry.path().extension() != ".cpp") continue;
      std::ifstream file(entry.path());
      std::string line;
      std::smatch match;
      while (std::getline(file, line))
        if (std::regex_match(line, match, line_of))
          out.push_back({fs::relative(entry.path(), root).generic_string(), match[1]});
    }
  return out;
}

std::string folder_of(std::string const& path) { return path.substr(0, path.find('/')); }

TEST(Includes, PointDownwards) {
  std::map<std::string, std::size_t> place;
  for (std::size_t n = 0; n < order.size(); ++n) place[order[n]] = n;
  auto const includes = all_includes();
  ASSERT_GT(includes.size(), 500u) << "the sources are not where they were";
  for (auto const& [from, what] : includes) {
    if (what == "version.hpp" || from == "gridmorph.hpp") continue;  // has no folder; may include all
    ASSERT_TRUE(place.contains(folder_of(from))) << from << ": a folder that has no place in the order yet";
    ASSERT_TRUE(place.contains(folder_of(what))) << from << " includes " << what;
    EXPECT_LE(place[folder_of(what)], place[folder_of(from)]) << from << " includes " << what;
  }
}

TEST(Includes, LeaveTheInsideOfOtherFoldersAlone) {
  for (auto const& [from, what] : all_includes())
    EXPECT_TRUE(!std::regex_search(what, inner) || folder_of(what) == folder_of(from)) << from << " includes " << what;
}

}  // namespace
