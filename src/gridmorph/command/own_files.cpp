#include <gridmorph/command/own_files.hpp>

#include <system_error>

namespace gridmorph::cli {

std::optional<std::filesystem::path> own_folder(std::span<std::string_view const> names, std::string_view witness) {
  std::error_code error;
  auto const program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) return std::nullopt;
  for (auto folder = program.parent_path(); folder.has_relative_path(); folder = folder.parent_path())
    for (std::string_view const name : names)
      if (std::filesystem::exists(folder / name / witness, error)) return folder / name;
  return std::nullopt;
}

}  // namespace gridmorph::cli
