// Folders that are made for an output; those that are not kept go again.
#pragma once

#include <gridmorph/core/error.hpp>

#include <filesystem>
#include <system_error>
#include <vector>

namespace gridmorph::io {

class MadeFolders {
 public:
  MadeFolders() = default;
  explicit MadeFolders(std::filesystem::path const& folder) { make(folder); }
  ~MadeFolders() {
    std::error_code ignored;
    if (!kept_)
      for (auto const& p : made_) std::filesystem::remove_all(p, ignored);
  }
  MadeFolders(MadeFolders const&) = delete;
  MadeFolders& operator=(MadeFolders const&) = delete;

  /// Makes a folder with those above it. Throws MachineError.
  void make(std::filesystem::path const& folder) {
    std::error_code failure;
    for (auto p = folder; !p.empty() && !std::filesystem::exists(p, failure); p = p.parent_path()) made_.push_back(p);
    std::filesystem::create_directories(folder, failure);
    if (failure) throw MachineError(folder.string() + ": cannot be made: " + failure.message());
  }
  void keep() { kept_ = true; }
  [[nodiscard]] bool is_new() const { return !made_.empty(); }

 private:
  std::vector<std::filesystem::path> made_;
  bool kept_ = false;
};

}  // namespace gridmorph::io
