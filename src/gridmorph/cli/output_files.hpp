// Output files of the command line: checked before work begins, whole or not there at all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

namespace gridmorph::cli {

/// Throws ConfigError when `path` cannot be an output: its folder does not exist, it is a folder itself, or it is one of
/// the inputs. `what` names it in messages ("output", "report").
void check_output(std::filesystem::path const& path, std::string const& what, std::filesystem::path const& input);

/// Checks the output and, where there is one, the report of one run, which must be two files.
void check_outputs(std::filesystem::path const& output, std::optional<std::filesystem::path> const& report,
                   std::filesystem::path const& input);

/// What a report that waits beside its place has to spare for a time that is known later: more than the digits of three
/// numbers in JSON.
inline constexpr std::size_t room_for_a_time = 128;

/// A text file written beside its place; it appears there on commit() and leaves nothing behind without it.
class PendingFile {
 public:
  /// Writes the text. Throws MachineError when that fails (disk full, no permission).
  PendingFile(std::filesystem::path path, std::string const& text);
  ~PendingFile();
  PendingFile(PendingFile&&) noexcept;
  PendingFile& operator=(PendingFile&&) = delete;

  /// Puts another text in the place of the first one. A text that is no longer than that needs no more room on the disk.
  void replace(std::string const& text);
  void commit();

 private:
  std::filesystem::path path_, beside_;
};

}  // namespace gridmorph::cli
