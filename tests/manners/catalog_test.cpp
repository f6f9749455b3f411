// kernels/CATALOG.md lists the headers of kernels/, each once, and benchmarks that exist.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

fs::path const sources = GRIDMORPH_SOURCES;

std::string text_of(fs::path const& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// What stands in back quotes at the places of a table's lines that `pattern` names by its first group.
std::vector<std::string> matches(std::string const& text, std::regex const& pattern) {
  std::vector<std::string> out;
  for (std::sregex_iterator m(text.begin(), text.end(), pattern), end; m != end; ++m) out.push_back((*m)[1]);
  std::sort(out.begin(), out.end());
  return out;
}

TEST(Catalog, ListsEveryHeaderOfTheKernelsOnce) {
  std::vector<std::string> headers;
  for (auto const& entry : fs::directory_iterator(sources / "kernels/gridmorph/kernels"))
    headers.push_back(entry.path().filename().string());
  std::sort(headers.begin(), headers.end());
  EXPECT_EQ(matches(text_of(sources / "kernels/CATALOG.md"), std::regex("\n\\| `([a-z0-9_]+\\.hpp)` \\|")), headers);
}

TEST(Kernels, AreInOneNamespace) {
  for (auto const& entry : fs::directory_iterator(sources / "kernels/gridmorph/kernels")) {
    std::string text = text_of(entry.path());
    // A section of using-declarations at the end gives host code short names.
    if (auto const host = text.find("\nnamespace gridmorph {\n"); host != std::string::npos) {
      std::regex const names(
          "\nnamespace gridmorph \\{\n((using|namespace compat =) [^;]*;\n)+\\}  // namespace gridmorph\n");
      EXPECT_TRUE(std::regex_match(text.substr(host), names)) << entry.path();
      text.resize(host);
    }
    EXPECT_NE(text.find("\nnamespace gridmorph::kernels"), std::string::npos) << entry.path();
  }
}

TEST(Catalog, NamesHeadersAndBenchmarksThatExist) {
  std::string const catalog = text_of(sources / "kernels/CATALOG.md");
  for (auto const& header : matches(catalog, std::regex("`([a-z0-9_]+\\.hpp)`")))
    EXPECT_TRUE(fs::exists(sources / "kernels/gridmorph/kernels" / header)) << header;
  std::string benchmarks;
  for (auto const& entry : fs::directory_iterator(sources / "bench"))
    if (entry.path().extension() == ".cpp") benchmarks += text_of(entry.path());
  auto const named = matches(catalog, std::regex("`((kernels|unstructured)/[a-z_]+)[a-z_/]*` ?[,|]"));
  EXPECT_GE(named.size(), 15u);
  for (auto const& name : named) {
    std::string const last = name.substr(name.find('/') + 1);
    EXPECT_TRUE(benchmarks.find(name) != std::string::npos || benchmarks.find('"' + last + '"') != std::string::npos)
        << name;
  }
}

}  // namespace
