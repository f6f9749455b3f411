// Where the meshes from outside are.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace gridmorph::test {

/// Path of a shared mesh: in the folder that the environment variable GRIDMORPH_MESHES names, else in the one the build was
/// configured with. The file need not be there.
inline std::string shared_mesh(std::string const& file) {
  char const* folder = std::getenv("GRIDMORPH_MESHES");
  return (std::filesystem::path(folder != nullptr ? folder : GRIDMORPH_MESHES_DIR) / file).string();
}

}  // namespace gridmorph::test
