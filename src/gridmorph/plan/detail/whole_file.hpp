// Files that appear whole or not at all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace gridmorph::detail {

/// Writes a file beside `path` and renames it onto `path`; a symbolic link is followed. Nothing is left behind on
/// failure. Throws IoError when there is no such folder, MachineError when the file cannot be written.
void write_whole(std::filesystem::path const& path, std::span<std::byte const> bytes);

/// Throws IoError when there is no such file, it cannot be read, or it does not begin with `magic`; then the rest, which
/// may be large, is not read.
std::vector<std::byte> read_whole(std::filesystem::path const& path, std::string_view magic);

}  // namespace gridmorph::detail
