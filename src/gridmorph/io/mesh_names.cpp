#include <gridmorph/core/error.hpp>
#include <gridmorph/io/mesh_names.hpp>
#include <gridmorph/io/printable.hpp>

#include <algorithm>

namespace gridmorph::io {

namespace {

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

bool has_control(std::string const& name) { return std::any_of(name.begin(), name.end(), is_control); }

}  // namespace

void make_names_printable(Mesh& mesh) {
  for (Zone const& zone : mesh.zones)
    if (has_control(zone.name))
      throw IoError(mesh.source + ": the name of zone '" + printable(zone.name) +
                    "' holds control characters, shown as '?'; rename the zone");
  Index changed = 0;
  auto const make = [&](std::string& name) {
    if (!has_control(name)) return;
    std::replace_if(name.begin(), name.end(), is_control, '?');
    ++changed;
  };
  for (Patch& patch : mesh.patches) {
    make(patch.name);
    make(patch.bc_type);
    for (auto& family : patch.families) make(family);
  }
  for (auto& interface : mesh.interfaces) {
    make(interface.name);
    for (auto& family : interface.families) make(family);
  }
  for (auto& connection : mesh.connections) {
    make(connection.name);
    for (auto& family : connection.families) make(family);
  }
  for (auto& family : mesh.families) make(family);
  for (Subset& subset : mesh.subsets) make(subset.name);
  if (changed > 0)
    mesh.notes.push_back(mesh.source + ": " + std::to_string(changed) +
                         " names hold control characters, such as line feeds; they stand as '?' here, and a case file "
                         "names them so");
}

}  // namespace gridmorph::io
