#include <generators/stand_ins.hpp>
#include <generators/text_file.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/io/mesh_io.hpp>

#include <algorithm>

namespace gridmorph {

std::vector<std::string> const& stand_in_names() {
  static std::vector<std::string> const names{"turbine", "slat", "coil"};
  return names;
}

std::filesystem::path write_stand_in(std::string const& name, std::filesystem::path const& folder) {
  auto const& names = stand_in_names();
  if (std::find(names.begin(), names.end(), name) == names.end()) throw ConfigError("there is no mesh '" + name + "'");
  make_folder(folder);
  WriteOptions options;
  if (name == "turbine") {
    auto const path = folder / "water_turbine.cgns";
    write_mesh(path.string(), make_water_turbine(), options);
    return path;
  }
  options.format = FileFormat::cgns_adf;
  if (name == "slat") {
    auto const path = folder / "slotted_airfoil.cgns";
    write_mesh(path.string(), make_slotted_airfoil(), options);
    return path;
  }
  options.boundary_nodes = true;
  auto const path = folder / "heated_coil.cgns";
  write_mesh(path.string(), make_heated_coil(), options);
  return path;
}

}  // namespace gridmorph
