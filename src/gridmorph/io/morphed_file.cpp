#include <gridmorph/core/error.hpp>
#include <gridmorph/io/morphed_file.hpp>

#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <utility>

namespace gridmorph::cgns {

void check_same_mesh(File const& file, Layout const& layout, Mesh const& mesh) {
  Problems problems;
  if (layout.zones.size() != mesh.zones.size())
    problems.add(file.path() + ": holds " + std::to_string(layout.zones.size()) + " zones, but the mesh has " +
                 std::to_string(mesh.zones.size()) + "; give the file that the mesh was read from");
  else
    for (std::size_t z = 0; z < mesh.zones.size(); ++z) {
      auto const& found = layout.zones[z];
      auto const& zone = mesh.zones[z];
      bool const same_size = mesh.is_structured() ? found.mesh_extent() == zone.extent
                             : zone.is_block()    ? found.is_block() && found.extent == zone.extent
                                                  : found.nodes_in_file() == zone.size();
      if (found.name != zone.name || !same_size)
        problems.add(file.path() + ": zone '" + found.name + "' is not zone '" + zone.name +
                     "' of the mesh, or has another size; give the file that the mesh was read from");
    }
  check_own_coordinates(file, layout, problems);
  problems.throw_if_any<IoError>();
}

void check_own_coordinates(File const& file, Layout const& layout, Problems& problems) {
  std::map<std::pair<unsigned long, std::uint64_t>, Node const*> owners;
  for (auto const& zone : layout.zones)
    for (auto const* array : zone.array) {
      if (!array) continue;
      std::string const where = file.path() + ", node " + array->path + ": ";
      if (array->linked)
        problems.add(where +
                     "is a link to another place, which must not be changed; write the mesh into one file without "
                     "links first");
      if (array->linked || !array->stored) continue;
      auto const& stored = *array->stored;
      if (auto const [owner, first] = owners.emplace(stored.object, array); !first)
        problems.add(where + "has the same data set as " + owner->second->path +
                     ", so that both would get the same values; give every node data of its own");
      else if (stored.shared)
        problems.add(where +
                     "has a data set with another name in the file (a hard link), which must not be changed; give the "
                     "node data of its own");
      if (stored.type != stored.type_in_file)
        problems.add(where + "says that its values are " + stored.type + ", and they are stored as " +
                     stored.type_in_file + "; write the coordinates anew in one of the two");
    }
}

void check_written(File const& file, ZoneLayout const& zone, int component, double const* expected) {
  Node const* array = zone.array[component];
  if (!array) return;
  auto const n = std::size_t(zone.nodes_in_file());
  auto const memory = std::make_unique_for_overwrite<double[]>(n);
  double* const found = memory.get();
  read_component(file, zone, component, found);
  if (!zone.single_precision[component] && std::memcmp(found, expected, n * sizeof *found) == 0) return;
  for (std::size_t i = 0; i < n; ++i) {
    double const wanted = zone.single_precision[component] ? double(float(expected[i])) : expected[i];
    if (std::memcmp(&found[i], &wanted, sizeof wanted) == 0) continue;
    throw MachineError(file.path() + ", node " + array->path + ": value " + std::to_string(i + 1) +
                       " was read back as " + std::to_string(found[i]) + " instead of " + std::to_string(wanted) +
                       "; the file is not put in place; check disk and memory");
  }
}

namespace {

std::vector<std::string> names_of(std::vector<Zone> const& zones) {
  std::vector<std::string> out;
  for (auto const& zone : zones) out.push_back(zone.name);
  return out;
}

}  // namespace

Layout zones_of(File const& file, Node const& tree, Mesh const& mesh) {
  Problems problems;
  auto const find = mesh.is_structured() ? find_zones : find_unstructured_zones;
  auto layout = find(file, tree, problems, all_but(tree, names_of(mesh.zones)));
  problems.throw_if_any<IoError>();
  return layout;
}

}  // namespace gridmorph::cgns
