#include <gridmorph/core/error.hpp>
#include <gridmorph/io/element_zones.hpp>
#include <gridmorph/io/mesh_files.hpp>
#include <gridmorph/io/morphed_file.hpp>
#include <gridmorph/io/output_fields.hpp>
#include <gridmorph/io/output_file.hpp>
#include <gridmorph/io/unstructured_fields.hpp>
#include <gridmorph/mesh/file_order.hpp>

namespace gridmorph {

namespace {

void write_zones(cgns::File& file, Mesh const& mesh, Coordinates const& x, WriteOptions const& options) {
  io::ElementZoneWriter writer(file, mesh, options);
  writer.begin();
  for (std::size_t z = 0; z < mesh.zones.size(); ++z) {
    Index const first = mesh.zones[z].first_node;
    writer.zone(int(z), {x.x.data() + first, x.y.data() + first, x.z.data() + first});
  }
}

}  // namespace

void write_mesh(std::string const& path, Mesh const& mesh, Coordinates const& morphed, OutputFields const& fields,
                WriteOptions const& options) {
  if (mesh.is_structured()) return io::write_blocks(path, mesh, morphed, fields, options);
  check_mesh(mesh);
  if (morphed.size() != mesh.n_nodes())
    throw MeshError(path + ": the mesh has " + std::to_string(mesh.n_nodes()) + " nodes, but coordinates of " +
                    std::to_string(morphed.size()));
  io::check_fields(mesh.n_nodes(), mesh.n_elements(), mesh.coordinates, morphed, fields);
  io::OutputFile target(path);
  target.reserve(io::bytes_of_elements(mesh) +
                 io::bytes_of_fields(fields, mesh.zones.size(), mesh.n_nodes(), mesh.n_elements()));
  {
    cgns::File file(target.path(), cgns::File::Mode::create, options.format);
    if (mesh.file_order.node.empty())
      write_zones(file, mesh, morphed, options);
    else
      write_zones(file, in_file_order(mesh), in_file_order(mesh, morphed), options);
    file.close();
  }
  if (!fields.empty()) {
    cgns::File file(target.path(), cgns::File::Mode::modify);
    auto const tree = file.tree();
    auto const layout = cgns::zones_of(file, tree, mesh);
    write_fields(file, layout, io::zone_solutions(file, layout), mesh, morphed, fields);
    file.close();
  }
  target.commit();
}

}  // namespace gridmorph
