#include <gridmorph/core/error.hpp>
#include <gridmorph/io/cgns/cgns_boundary.hpp>
#include <gridmorph/io/cgns/cgns_layout.hpp>
#include <gridmorph/io/extrude.hpp>
#include <gridmorph/io/finite_check.hpp>
#include <gridmorph/io/mesh_files.hpp>

namespace gridmorph::io {

namespace {

std::array<double*, 3> components(Coordinates const& c) { return {c.x.data(), c.y.data(), c.z.data()}; }

void read_coordinates(cgns::File const& file, cgns::Layout const& layout, Mesh& mesh) {
  mesh.coordinates = Coordinates(mesh.n_nodes());
  auto const flat_arrays = components(mesh.coordinates);
  std::vector<double> plane;
  for (std::size_t z = 0; z < layout.zones.size(); ++z) {
    auto const& from = layout.zones[z];
    auto const& zone = mesh.zones[z];
    for (int c = 0; c < 3; ++c) {
      double* const dest = flat_arrays[c] + zone.first_node;
      if (from.flat_axis < 0) {
        read_component(file, from, c, dest);
        continue;
      }
      plane.resize(from.nodes_in_file());
      read_component(file, from, c, plane.data());
      auto const p = cgns::plane_steps(zone, from.flat_axis);
      auto value = plane.begin();
      for (int b = 0; b < zone.extent[p.axis[1]]; ++b)
        for (int a = 0; a < zone.extent[p.axis[0]]; ++a) {
          Index const n = a * p.step[0] + b * p.step[1];
          dest[n] = dest[n + p.across] = *value++;
        }
    }
  }
}

}  // namespace

Mesh read_blocks(cgns::File const& file, cgns::Node const& tree, ReadOptions const& options) {
  std::string const& path = file.path();
  Problems unreadable;
  auto layout = find_zones(file, tree, unreadable, options.leave_out);
  unreadable.throw_if_any<IoError>();

  Mesh mesh;
  mesh.source = path;
  mesh.notes = std::move(layout.notes);
  mesh.dimension = layout.zones.front().flat_axis >= 0 ? 2 : 3;
  for (auto const& zone : layout.zones) {
    int const z = mesh.add_zone(zone.name, zone.mesh_extent());
    mesh.zones[z].single_precision = zone.is_single_precision();
  }

  Problems problems;
  read_boundary(file, tree, layout, mesh, problems);
  read_connections(file, layout, mesh, problems);
  if (options.coordinates) {
    read_coordinates(file, layout, mesh);
    check_places(mesh, path, problems);
  }
  // Non-finite coordinates leave nothing to measure the second plane by.
  if (mesh.dimension == 2 && problems.empty()) add_second_planes(layout, mesh, problems);
  problems.throw_if_any<MeshError>();
  return mesh;
}

}  // namespace gridmorph::io
