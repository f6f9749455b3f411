// Text files of the command line: whole or not there at all.
#pragma once

#include <gridmorph/io/output_file.hpp>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

namespace gridmorph::cli {

/// What a report that waits beside its place has to spare for what is known later: more than the digits of three
/// numbers in JSON, and size and checksum of the output.
inline constexpr std::size_t room_for_a_time = 256;

/// A text file written beside its place; it appears there on commit() and leaves nothing behind without it.
class PendingFile {
 public:
  /// Writes the text. Throws MachineError when that fails (disk full, no permission).
  PendingFile(std::filesystem::path const& path, std::string const& text)
      : file_(std::make_unique<io::OutputFile>(path.string())) {
    replace(text);
  }

  /// Puts another text in the place of the first one. A text that is no longer than that needs no more room on the
  /// disk.
  void replace(std::string const& text) { file_->write(text); }
  void commit() { file_->commit(); }

 private:
  std::unique_ptr<io::OutputFile> file_;
};

}  // namespace gridmorph::cli
