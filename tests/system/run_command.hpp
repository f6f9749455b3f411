// Starts the executable as a user would and keeps what it printed.
#pragma once

#include <generators/passage_demo.hpp>

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <sys/wait.h>

namespace gridmorph::test {

struct Outcome {
  int status = -1;  ///< exit status, or 128 + signal as shells count
  std::string out, err;

  [[nodiscard]] std::vector<std::string> error_lines() const {
    std::vector<std::string> lines;
    std::istringstream in(err);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
  }
};

inline std::string contents(std::filesystem::path const& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

/// Every patch stays where it is.
inline std::string const still = "[[motion]]\npatches = [\"*\"]\nrule = \"fixed\"\n";

/// A folder of its own for every test, with a small passage mesh beside it that is made once.
class CommandTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    std::string pattern = (std::filesystem::temp_directory_path() / "gridmorph-system-XXXXXX").string();
    root() = mkdtemp(pattern.data());
    PassageOptions passage;
    passage.nodes = 10'000;
    write_passage_demo(root() / "shared", passage, rotated_sections());
  }
  static void TearDownTestSuite() { std::filesystem::remove_all(root()); }

  void SetUp() override {
    folder_ = root() / ::testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::create_directory(folder_);
    for (auto const& entry : std::filesystem::directory_iterator(root() / "shared"))
      std::filesystem::copy(entry.path(), folder_);
  }

  [[nodiscard]] std::filesystem::path path(std::string const& name) const { return folder_ / name; }
  void write(std::string const& name, std::string const& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
  }
  /// A case file on the passage mesh.
  void write_case(std::string const& name, std::string const& rules, std::string const& top = "") const {
    write(name, top + "[mesh]\ninput = \"passage.cgns\"\noutput = \"out.cgns\"\naxis = \"x\"\n" + rules);
  }

  /// Runs `shell` in the test's folder; $G is the executable.
  [[nodiscard]] Outcome shell(std::string const& command) const {
    std::string const line =
        "cd '" + folder_.string() + "' && G='" GRIDMORPH_EXECUTABLE "' && { " + command + "; } >.stdout 2>.stderr";
    int const code = std::system(line.c_str());
    Outcome run;
    run.status = WIFEXITED(code) ? WEXITSTATUS(code) : 128 + WTERMSIG(code);
    run.out = contents(path(".stdout"));
    run.err = contents(path(".stderr"));
    return run;
  }
  [[nodiscard]] Outcome gridmorph(std::string const& arguments) const { return shell("$G " + arguments); }

  /// Status 2, nothing on standard output, every line of the message prefixed, and all of `words` in it.
  void expect_bad_input(Outcome const& run, std::vector<std::string> const& words) const {
    EXPECT_EQ(run.status, 2) << run.err;
    EXPECT_EQ(run.out, "");
    EXPECT_FALSE(run.err.empty());
    for (auto const& line : run.error_lines())
      EXPECT_TRUE(line.rfind("gridmorph: error: ", 0) == 0 || line.rfind(" ", 0) == 0) << line;
    for (auto const& word : words) EXPECT_NE(run.err.find(word), std::string::npos) << word << " not in: " << run.err;
    expect_nothing_written();
  }
  void expect_nothing_written() const {
    for (auto const& entry : std::filesystem::directory_iterator(folder_)) {
      std::string const name = entry.path().filename().string();
      EXPECT_TRUE(name.rfind("out", 0) != 0 && name.find("part") == std::string::npos) << name;
    }
  }

 private:
  static std::filesystem::path& root() {
    static std::filesystem::path path;
    return path;
  }
  std::filesystem::path folder_;
};

}  // namespace gridmorph::test
