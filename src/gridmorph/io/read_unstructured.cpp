#include <gridmorph/core/error.hpp>
#include <gridmorph/io/cgns/cgns_unstructured_boundary.hpp>
#include <gridmorph/io/file_check.hpp>
#include <gridmorph/io/file_kind.hpp>
#include <gridmorph/io/finite_check.hpp>
#include <gridmorph/io/su2/su2_file.hpp>
#include <gridmorph/io/unstructured_check.hpp>
#include <gridmorph/io/unstructured_io.hpp>
#include <gridmorph/mesh/extent.hpp>

#include <algorithm>
#include <cmath>
#include <set>

namespace gridmorph {

namespace io {

void check_finite(UnstructuredMesh const& mesh, Coordinates const& coordinates, std::string const& where,
                  Problems& problems) {
  if (extent_of(coordinates).usable()) return;
  for (auto const& zone : mesh.zones) {
    Index bad = 0, first = -1;
    for (Index n = zone.first_node; n < zone.first_node + zone.n_nodes; ++n)
      if (!is_usable(coordinates[n]) && bad++ == 0) first = n;
    if (bad == 0) continue;
    problems.add(unusable_nodes(where, bad, zone.name, describe_node(mesh, first), coordinates[first]));
  }
}

}  // namespace io

namespace {

UnstructuredMesh read_cgns(std::string const& path, std::vector<std::string> const& leave_out) {
  cgns::File const file(path, cgns::File::Mode::read);
  auto const tree = file.tree();
  Problems unreadable;
  auto layout = find_unstructured_zones(file, tree, unreadable, leave_out);
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

  UnstructuredMesh mesh;
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
  io::check_finite(mesh, mesh.coordinates, path, problems);
  problems.throw_if_any<MeshError>();
  read_boundary(file, tree, layout, faces, mesh, problems);
  read_connections(file, layout, faces, mesh, problems);
  problems.throw_if_any<MeshError>();
  check_mesh(mesh);
  return mesh;
}

void collect_linked(cgns::Node const& node, std::set<std::string>& files) {
  if (!node.file.empty()) files.insert(node.file);
  for (auto const& child : node.children) collect_linked(child, files);
}

}  // namespace

MeshFileFacts look_at_mesh(std::string const& path, std::vector<std::string> const& leave_out) {
  MeshFileFacts out;
  out.format = mesh_format(path);
  if (out.format == MeshFormat::su2) out.kind = MeshKind::unstructured;
  if (out.format != MeshFormat::cgns) return out;
  cgns::File const file(path, cgns::File::Mode::read);
  auto const tree = file.tree();
  std::set<std::string> linked;
  collect_linked(tree, linked);
  out.linked.assign(linked.begin(), linked.end());
  std::string structured, unstructured;
  for (auto const* base : tree.all("CGNSBase_t"))
    for (auto const* zone : base->all("Zone_t")) {
      if (cgns::is_left_out(leave_out, base->name, zone->name)) continue;
      (zone_type(file, *zone) == "Unstructured" ? unstructured : structured) += " '" + zone->name + "'";
    }
  if (!structured.empty() && !unstructured.empty())
    throw IoError(
        path + ": mixes structured zones (" + structured.substr(1, 200) + ") with unstructured ones (" +
        unstructured.substr(1, 200) +
        "); such hybrid files cannot be handled, write the two kinds into files of their own, or name the zones "
        "or the base of one kind in leave_out");
  if (!unstructured.empty()) out.kind = MeshKind::unstructured;
  return out;
}

MeshKind mesh_kind(std::string const& path, std::vector<std::string> const& leave_out) {
  return look_at_mesh(path, leave_out).kind;
}

UnstructuredMesh read_unstructured_mesh(std::string const& path, ReadOptions const& options) {
  if (!su2::is_su2(path)) return read_cgns(path, options.leave_out);
  if (!options.leave_out.empty())
    throw IoError(path + ": leave_out is for CGNS files, which name bases and zones; remove it for an SU2 mesh");
  return su2::read(path);
}

}  // namespace gridmorph
