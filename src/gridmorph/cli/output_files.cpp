#include <gridmorph/cli/output_files.hpp>
#include <gridmorph/core/error.hpp>

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>
#include <utility>

#include <unistd.h>

namespace gridmorph::cli {

void check_output(std::filesystem::path const& path, std::string const& what, std::filesystem::path const& input) {
  std::error_code error;
  auto const folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  if (!std::filesystem::is_directory(folder, error))
    throw ConfigError(
        fmt::format("{} '{}': the folder '{}' does not exist; make it first", what, path.string(), folder.string()));
  if (std::filesystem::is_directory(path, error))
    throw ConfigError(fmt::format("{} '{}' is a folder; give a file name", what, path.string()));
  if (std::filesystem::exists(path, error) && std::filesystem::equivalent(path, input, error))
    throw ConfigError(fmt::format("{} '{}' is the input '{}'; give another file name, inputs are never overwritten",
                                  what, path.string(), input.string()));
}

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

void check_outputs(std::filesystem::path const& output, std::optional<std::filesystem::path> const& report,
                   std::filesystem::path const& input) {
  check_output(output, "output", input);
  if (!report) return;
  check_output(*report, "report", input);
  if (*report == output)
    throw ConfigError(fmt::format("output and report are the same file '{}'; give two names", report->string()));
}

PendingFile::PendingFile(std::filesystem::path path, std::string const& text)
    : path_(std::move(path)), beside_(path_.string() + "." + std::to_string(getpid()) + ".part") {
  if (int const reason = write_text(beside_, "wb", text)) {
    std::remove(beside_.c_str());
    throw MachineError(fmt::format("'{}' cannot be written: {}", path_.string(), std::strerror(reason)));
  }
}

void PendingFile::replace(std::string const& text) {
  if (int const reason = write_text(beside_, "r+b", text))
    throw MachineError(fmt::format("'{}' cannot be written: {}", path_.string(), std::strerror(reason)));
}

PendingFile::PendingFile(PendingFile&& other) noexcept
    : path_(std::move(other.path_)), beside_(std::exchange(other.beside_, {})) {}

PendingFile::~PendingFile() {
  if (!beside_.empty()) std::remove(beside_.c_str());
}

void PendingFile::commit() {
  if (std::rename(beside_.c_str(), path_.c_str()) != 0)
    throw MachineError(fmt::format("'{}' cannot be written: {}", path_.string(), std::strerror(errno)));
  beside_.clear();
}

}  // namespace gridmorph::cli
