#include <gridmorph/core/error.hpp>
#include <gridmorph/io/morphed_file.hpp>

namespace gridmorph::cgns {

void check_same_mesh(File const& file, Layout const& layout, Mesh const& mesh) {
  Problems problems;
  if (layout.zones.size() != mesh.zones.size())
    problems.add(file.path() + ": holds " + std::to_string(layout.zones.size()) + " zones, but the mesh has " +
                 std::to_string(mesh.zones.size()) + "; give the file that the mesh was read from");
  else
    for (std::size_t z = 0; z < mesh.zones.size(); ++z) {
      auto const& found = layout.zones[z];
      if (found.name != mesh.zones[z].name || found.mesh_extent() != mesh.zones[z].extent)
        problems.add(file.path() + ": zone '" + found.name + "' is not zone '" + mesh.zones[z].name +
                     "' of the mesh, or has another size; give the file that the mesh was read from");
      for (auto const* array : found.array)
        if (array && array->linked)
          problems.add(file.path() + ", node " + array->path +
                       ": is a link to another place, which must not be changed; write the mesh into one file without "
                       "links first");
    }
  problems.throw_if_any<IoError>();
}

namespace {

std::vector<std::string> names_of(auto const& zones) {
  std::vector<std::string> out;
  for (auto const& zone : zones) out.push_back(zone.name);
  return out;
}

}  // namespace

Layout zones_of(File const& file, Node const& tree, Mesh const& mesh) {
  Problems problems;
  auto layout = find_zones(file, tree, problems, all_but(tree, names_of(mesh.zones)));
  problems.throw_if_any<IoError>();
  return layout;
}

Layout unstructured_zones_of(File const& file, Node const& tree, UnstructuredMesh const& mesh) {
  Problems problems;
  auto layout = find_unstructured_zones(file, tree, problems, all_but(tree, names_of(mesh.zones)));
  problems.throw_if_any<IoError>();
  return layout;
}

}  // namespace gridmorph::cgns
