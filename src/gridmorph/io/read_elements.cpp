#include <gridmorph/core/error.hpp>
#include <gridmorph/io/cgns/cgns_unstructured_boundary.hpp>
#include <gridmorph/io/finite_check.hpp>
#include <gridmorph/io/mesh_files.hpp>
#include <gridmorph/mesh/block_elements.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <algorithm>
#include <array>
#include <limits>

namespace gridmorph::io {

namespace {

/// The last zone's cells as its elements, counted as its own.
void add_block(Mesh& mesh) {
  auto const& zone = mesh.zones.back();
  add_cells(mesh, zone, mesh.coordinates);
  for (Index e = 0; e < zone.n_elements; ++e) mesh.elements.number.push_back(Index32(e + 1));
}

}  // namespace

Coordinates read_coordinates(cgns::File const& file, cgns::Layout const& layout, Index n_nodes) {
  Coordinates out(n_nodes);
  std::array<double*, 3> const arrays{out.x.data(), out.y.data(), out.z.data()};
  Index first = 0;
  for (auto const& zone : layout.zones) {
    for (int c = 0; c < 3; ++c) read_component(file, zone, c, arrays[c] + first);
    first += zone.nodes_in_file();
  }
  return out;
}

Mesh read_elements(cgns::File const& file, cgns::Node const& tree, ReadOptions const& options) {
  std::string const& path = file.path();
  Problems unreadable;
  auto layout = find_unstructured_zones(file, tree, unreadable, options.leave_out);
  unreadable.throw_if_any<IoError>();

  cgns::ElementTypes const types(file, tree);
  std::vector<std::vector<cgns::Section>> sections;
  int dimension = 0;
  for (auto const& zone : layout.zones) {
    sections.push_back(zone.is_block() ? std::vector<cgns::Section>() : read_sections(file, types, zone, unreadable));
    dimension = std::max(dimension, zone.is_block() ? (zone.flat_axis < 0 ? 3 : 2) : dimension_of(sections.back()));
  }
  if (dimension < 2 && unreadable.empty())
    unreadable.add(path + ": has no elements (Elements_t) that fill a volume or a surface");
  Index n_nodes = 0;
  for (auto const& zone : layout.zones) n_nodes += zone.nodes_in_file();
  if (n_nodes > std::numeric_limits<Index32>::max())
    unreadable.add(path + ": has " + std::to_string(n_nodes) + " nodes; beside elements there may be at most " +
                   std::to_string(std::numeric_limits<Index32>::max()));
  unreadable.throw_if_any<IoError>();

  Mesh mesh;
  mesh.source = path;
  mesh.dimension = dimension;
  mesh.notes = std::move(layout.notes);
  // Before the elements: which way the cells of a block are numbered is seen at its coordinates.
  mesh.coordinates = read_coordinates(file, layout, n_nodes);
  Problems problems;
  std::vector<cgns::ListedFaces> faces;
  for (std::size_t z = 0; z < layout.zones.size(); ++z) {
    auto const& zone = layout.zones[z];
    std::string const where = path + ": zone '" + zone.name + "'";
    if (zone.is_block()) {
      mesh.add_zone(zone.name, zone.extent);
      faces.emplace_back();
      if ((zone.flat_axis < 0) == (dimension == 3)) add_block(mesh);
    } else {
      mesh.add_zone(zone.name, zone.nodes_in_file());
      faces.push_back(add_elements(sections[z], where, mesh, problems));
    }
    mesh.zones.back().single_precision = zone.is_single_precision();
    sections[z] = {};
    if (mesh.zones.back().n_elements == 0)
      problems.add(where + ": has no elements of dimension " + std::to_string(dimension) +
                   ", which other zones of the file have");
  }
  problems.throw_if_any<MeshError>();

  check_places(mesh, path, problems);
  problems.throw_if_any<MeshError>();
  read_boundary(file, tree, layout, faces, mesh, problems);
  read_connections(file, layout, faces, mesh, problems);
  problems.throw_if_any<MeshError>();
  check_mesh(mesh);
  return mesh;
}

}  // namespace gridmorph::io
