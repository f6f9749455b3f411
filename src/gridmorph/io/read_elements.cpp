#include <gridmorph/core/error.hpp>
#include <gridmorph/io/cgns/cgns_unstructured_boundary.hpp>
#include <gridmorph/io/finite_check.hpp>
#include <gridmorph/io/mesh_files.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <algorithm>

namespace gridmorph::io {

Mesh read_elements(cgns::File const& file, cgns::Node const& tree, ReadOptions const& options) {
  std::string const& path = file.path();
  Problems unreadable;
  auto layout = find_unstructured_zones(file, tree, unreadable, options.leave_out);
  for (auto const& zone : layout.zones)
    if (zone_type(file, *zone.node) != "Unstructured")
      unreadable.add(path + ": zone '" + zone.name + "' is not unstructured");
  unreadable.throw_if_any<IoError>();

  cgns::ElementTypes const types(file, tree);
  std::vector<std::vector<cgns::Section>> sections;
  int dimension = 0;
  for (auto const& zone : layout.zones) {
    sections.push_back(read_sections(file, types, zone, unreadable));
    dimension = std::max(dimension, cgns::dimension_of(sections.back()));
  }
  if (dimension < 2 && unreadable.empty())
    unreadable.add(path + ": has no elements (Elements_t) that fill a volume or a surface");
  unreadable.throw_if_any<IoError>();

  Mesh mesh;
  mesh.source = path;
  mesh.dimension = dimension;
  mesh.notes = std::move(layout.notes);
  Problems problems;
  std::vector<cgns::ListedFaces> faces;
  for (std::size_t z = 0; z < layout.zones.size(); ++z) {
    auto const& zone = layout.zones[z];
    mesh.add_zone(zone.name, zone.nodes_in_file());
    mesh.zones.back().single_precision =
        zone.single_precision[0] || zone.single_precision[1] || zone.single_precision[2];
    std::string const where = path + ": zone '" + zone.name + "'";
    faces.push_back(add_elements(sections[z], where, mesh, problems));
    sections[z] = {};
    if (mesh.zones.back().n_elements == 0)
      problems.add(where + ": has no elements of dimension " + std::to_string(dimension) +
                   ", which other zones of the file have");
  }
  problems.throw_if_any<MeshError>();

  mesh.coordinates = Coordinates(mesh.n_nodes());
  std::array<double*, 3> const arrays{mesh.coordinates.x.data(), mesh.coordinates.y.data(), mesh.coordinates.z.data()};
  for (std::size_t z = 0; z < layout.zones.size(); ++z)
    for (int c = 0; c < 3; ++c)
      read_component(file, layout.zones[z], c, arrays[std::size_t(c)] + mesh.zones[z].first_node);
  check_finite(mesh, mesh.coordinates, path, problems);
  problems.throw_if_any<MeshError>();
  read_boundary(file, tree, layout, faces, mesh, problems);
  read_connections(file, layout, faces, mesh, problems);
  problems.throw_if_any<MeshError>();
  check_mesh(mesh);
  return mesh;
}

}  // namespace gridmorph::io
