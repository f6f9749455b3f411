// Where the meshes of tests are.
#pragma once

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace gridmorph::test {

/// Path of a mesh: one of the project (examples/meshes), a stand-in made when the tests are built
/// ("water_turbine.cgns", "slotted_airfoil.cgns", "heated_coil.cgns"), or one that may not be passed on and has a
/// stand-in. The last are looked for in the folder that the environment variable GRIDMORPH_MESHES names, else in the
/// one the build was configured with; "" where they are not. Throws std::runtime_error when another one is missing.
inline std::string shared_mesh(std::string const& file) {
  char const* other = std::getenv("GRIDMORPH_MESHES");
  for (std::string const folder : {GRIDMORPH_PROJECT_MESHES, GRIDMORPH_MADE_MESHES,
                                   static_cast<char const*>(other != nullptr ? other : GRIDMORPH_MESHES_DIR)})
    if (auto const path = std::filesystem::path(folder) / file; !folder.empty() && std::filesystem::exists(path))
      return std::filesystem::absolute(path).string();
  constexpr std::array<std::string_view, 3> not_ours{"axialTurbine_7blk.cgns", "multi.cgns", "HeatingCoil.cgns"};
  bool const made = file == "water_turbine.cgns" || file == "slotted_airfoil.cgns" || file == "heated_coil.cgns";
  bool const may_be_missing =
      std::find(not_ours.begin(), not_ours.end(), file) != not_ours.end() || (made && *GRIDMORPH_MADE_MESHES == '\0');
  if (!may_be_missing) throw std::runtime_error("no mesh '" + file + "' in " GRIDMORPH_PROJECT_MESHES);
  return "";
}

}  // namespace gridmorph::test
