#include <gridmorph/core/error.hpp>
#include <gridmorph/io/cgns/cgns_layout.hpp>
#include <gridmorph/io/file_check.hpp>
#include <gridmorph/io/finite_check.hpp>
#include <gridmorph/io/foam/foam_mesh.hpp>
#include <gridmorph/io/gmsh/gmsh_mesh.hpp>
#include <gridmorph/io/mesh_files.hpp>
#include <gridmorph/io/morphed_file.hpp>
#include <gridmorph/io/output_fields.hpp>
#include <gridmorph/io/output_file.hpp>
#include <gridmorph/io/su2/su2_file.hpp>
#include <gridmorph/io/ugrid/ugrid_file.hpp>
#include <gridmorph/io/unstructured_fields.hpp>
#include <gridmorph/io/vtk/vtk_mesh.hpp>
#include <gridmorph/mesh/file_order.hpp>

#include <array>

namespace gridmorph {

namespace {

void write_cgns(std::string const& input, std::string const& output, Mesh const& mesh, Coordinates const& morphed,
                OutputFields const& fields) {
  cgns::Node original;
  {
    cgns::File const file(input, cgns::File::Mode::read);
    original = file.tree();
    cgns::check_same_mesh(file, cgns::zones_of(file, original, mesh), mesh);
  }
  io::OutputFile target(output);
  target.copy_from(input);
  target.reserve(io::bytes_of_fields(fields, mesh.zones.size(), mesh.n_nodes(), mesh.n_elements()));
  Coordinates const ordered = in_file_order(mesh, morphed);
  auto const arrays = io::components(ordered);
  {
    cgns::File file(target.path(), cgns::File::Mode::modify);
    auto const tree = file.tree_of_copy(original);
    auto const layout = cgns::zones_of(file, tree, mesh);
    auto const present = fields.empty() ? std::vector<io::ZoneSolutions>() : io::zone_solutions(file, layout);
    for (std::size_t z = 0; z < mesh.zones.size(); ++z)
      for (int c = 0; c < 3; ++c) write_component(file, layout.zones[z], c, arrays[c] + mesh.zones[z].first_node);
    write_fields(file, layout, present, mesh, morphed, fields);
    file.close();
  }
  {
    cgns::File const file(target.path(), cgns::File::Mode::read);
    auto const tree = file.tree_of_copy(original);
    auto const layout = cgns::zones_of(file, tree, mesh);
    for (std::size_t z = 0; z < mesh.zones.size(); ++z)
      for (int c = 0; c < 3; ++c) check_written(file, layout.zones[z], c, arrays[c] + mesh.zones[z].first_node);
  }
  target.commit();
}

/// The mesh with all nodes of its file.
void write_with_all_nodes(std::string const& input, std::string const& output, Mesh const& mesh,
                          Coordinates const& morphed, OutputFields const& fields) {
  NodesOfFile const file = io::nodes_of_file(input, mesh);
  OutputFields of_file = fields;
  for (auto& field : of_file.nodes) field.values = with_all_nodes(mesh, file, field.values);
  for (auto& field : of_file.cells) field.values = in_file_order(mesh.file_order.element, field.values);
  io::write_morphed_elements(input, output, with_all_nodes(mesh, file), with_all_nodes(mesh, file, morphed), of_file);
}

}  // namespace

void io::write_morphed_elements(std::string const& input, std::string const& output, Mesh const& mesh,
                                Coordinates const& morphed, OutputFields const& fields) {
  io::check_fields(mesh.n_nodes(), mesh.n_elements(), mesh.coordinates, morphed, fields);
  Problems problems;
  io::check_finite(mesh, morphed, "morphed mesh", problems);
  problems.throw_if_any<MeshError>();
  if (mesh.file_order.left_out > 0) return write_with_all_nodes(input, output, mesh, morphed, fields);
  MeshFormat const format = mesh_format(input);
  if (format == MeshFormat::cgns) return write_cgns(input, output, mesh, morphed, fields);
  if (format == MeshFormat::vtk) return vtk::write_morphed(input, output, mesh, morphed, fields);
  if (!fields.empty())
    throw IoError(output + ": " + std::string(to_string(format)) +
                  " files hold no fields; leave out displacement and quality, or use a CGNS or VTK mesh");
  Coordinates const ordered = in_file_order(mesh, morphed);
  switch (format) {
    case MeshFormat::su2: return su2::write_morphed(input, output, mesh, ordered);
    case MeshFormat::openfoam: return foam::write_morphed(input, output, mesh, ordered);
    case MeshFormat::gmsh: return gmsh::write_morphed(input, output, mesh, ordered);
    case MeshFormat::ugrid: return ugrid::write_morphed(input, output, mesh, ordered);
    case MeshFormat::vtk:
    case MeshFormat::plot3d:
    case MeshFormat::cgns: break;
  }
  throw IoError(input + ": is not the file that the mesh was read from any more; give that one");
}

}  // namespace gridmorph
