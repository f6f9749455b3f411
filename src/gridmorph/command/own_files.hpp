// Files that come along with the program: pages.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string_view>

namespace gridmorph::cli {

/// A folder of `names` that has the file `witness` in it, looked for beside the running program and in the folders
/// above it: what an installation, a Python package and a source tree that the program was built in have. Nothing where
/// there is none.
std::optional<std::filesystem::path> own_folder(std::span<std::string_view const> names, std::string_view witness);

}  // namespace gridmorph::cli
