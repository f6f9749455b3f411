#include <gridmorph/io/files_read.hpp>

#include <atomic>
#include <system_error>

#include <sys/stat.h>

namespace gridmorph::io {

namespace {

namespace fs = std::filesystem;

std::atomic<FilesRead*> asking{nullptr};

/// Files that wait beside the place of an output are the program's own.
bool is_own(fs::path const& path) {
  std::string const name = path.filename().string();
  return name.starts_with(".gridmorph-") && name.ends_with(".part");
}

}  // namespace

std::string identity_of(fs::path const& path) {
  struct stat found {};
  if (::stat(path.c_str(), &found) == 0) return std::to_string(found.st_dev) + ":" + std::to_string(found.st_ino);
  std::error_code failure;
  auto const canonical = fs::weakly_canonical(fs::absolute(path, failure), failure);
  return (failure ? path : canonical).string();
}

FilesRead::FilesRead() { asking.store(this); }

FilesRead::~FilesRead() { asking.store(nullptr); }

void FilesRead::note(fs::path const& path) {
  FilesRead* const list = asking.load();
  if (list == nullptr || is_own(path)) return;
  std::lock_guard const lock(list->turn_);
  list->name_.emplace(identity_of(path), path.string());
}

std::optional<std::string> FilesRead::name_of(fs::path const& path) {
  FilesRead* const list = asking.load();
  if (list == nullptr) return std::nullopt;
  std::lock_guard const lock(list->turn_);
  auto const found = list->name_.find(identity_of(path));
  return found == list->name_.end() ? std::nullopt : std::optional(found->second);
}

void FilesRead::release(fs::path const& path) {
  FilesRead* const list = asking.load();
  if (list == nullptr) return;
  std::lock_guard const lock(list->turn_);
  list->name_.erase(identity_of(path));
}

}  // namespace gridmorph::io
