// Which files a program has read, so that none of them is written over.
#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string>

namespace gridmorph::io {

/// A name of what a path leads to, equal for two paths that are one file or folder, or would be: device and inode of
/// what is there (links and hard links are the same file), else the canonical path.
std::string identity_of(std::filesystem::path const& path);

/// The one list of files that have been opened to be read while this lives. Readers fill it themselves, by note(), also
/// with what a file that they read leads to; OutputFile takes the place of none of them. For programs; in a library
/// nobody asks, and nothing is noted.
class FilesRead {
 public:
  FilesRead();
  ~FilesRead();
  FilesRead(FilesRead const&) = delete;
  FilesRead& operator=(FilesRead const&) = delete;

  /// A file, or a folder that stands for one. Cost: one look at it.
  static void note(std::filesystem::path const& path);
  /// The name by which a file was read; nothing for all others.
  static std::optional<std::string> name_of(std::filesystem::path const& path);
  /// One that has been read to its end, and may be replaced by what was made of it.
  static void release(std::filesystem::path const& path);

 private:
  std::mutex turn_;
  std::map<std::string, std::string> name_;  ///< by identity
};

}  // namespace gridmorph::io
