#include <gridmorph/app/cli/output_files.hpp>
#include <gridmorph/core/error.hpp>

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include <unistd.h>

namespace gridmorph::cli {

namespace {

/// Writes the whole text; 0 or the system's reason why not. `mode` as of fopen; nothing but the text remains in the file.
int write_text(std::filesystem::path const& path, char const* mode, std::string const& text) {
  errno = 0;
  std::FILE* file = std::fopen(path.c_str(), mode);
  bool good = file != nullptr && std::fwrite(text.data(), 1, text.size(), file) == text.size() &&
              std::fflush(file) == 0 && ftruncate(fileno(file), off_t(text.size())) == 0;
  int reason = errno;
  if (file != nullptr && std::fclose(file) != 0) {
    if (good) reason = errno;
    good = false;
  }
  return good ? 0 : reason;
}

}  // namespace

PendingFile::PendingFile(std::filesystem::path const& path, std::string const& text)
    : file_(std::make_unique<io::OutputFile>(path.string())), path_(path) {
  put(text, "wb");
}

void PendingFile::put(std::string const& text, char const* mode) const {
  if (int const reason = write_text(file_->path(), mode, text))
    throw MachineError(fmt::format("'{}' cannot be written: {}", path_.string(), std::strerror(reason)));
}

void PendingFile::replace(std::string const& text) { put(text, "r+b"); }

void PendingFile::commit() { file_->commit(); }

}  // namespace gridmorph::cli
