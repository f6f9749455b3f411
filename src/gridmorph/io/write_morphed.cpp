#include <gridmorph/core/error.hpp>
#include <gridmorph/io/file_check.hpp>
#include <gridmorph/io/finite_check.hpp>
#include <gridmorph/io/mesh_files.hpp>
#include <gridmorph/io/morphed_file.hpp>
#include <gridmorph/io/output_fields.hpp>
#include <gridmorph/io/output_file.hpp>
#include <gridmorph/io/plot3d/plot3d.hpp>

#include <utility>

namespace gridmorph {

namespace {

io::SolutionWriter solution_of(cgns::File& file, cgns::ZoneLayout const& layout, io::ZoneSolutions const& present,
                               char const* name, char const* location, Index less,
                               std::vector<std::string> const& arrays) {
  std::vector<Index> dimensions;
  for (int a = 0; a < layout.index_dimension; ++a) dimensions.push_back(layout.extent[a] - less);
  return {file, layout, present, name, location, std::move(dimensions), arrays};
}

void write_node_fields(cgns::File& file, cgns::ZoneLayout const& layout, io::ZoneSolutions const& present,
                       Mesh const& mesh, Zone const& zone, Coordinates const& morphed, OutputFields const& fields) {
  if (!fields.displacement && fields.nodes.empty()) return;
  auto const solution = solution_of(
      file, layout, present, "MorphNodes", "Vertex", 0,
      io::names_of_nodes(fields, {layout.array[0] != nullptr, layout.array[1] != nullptr, layout.array[2] != nullptr}));
  std::vector<double> plane;
  if (fields.displacement) {
    auto const before = io::components(mesh.coordinates), after = io::components(morphed);
    std::vector<double> difference(zone.size());
    for (int c = 0; c < 3; ++c) {
      if (!layout.array[c]) continue;
      for (Index n = 0; n < zone.size(); ++n)
        difference[n] = after[c][zone.first_node + n] - before[c][zone.first_node + n];
      cgns::with_file_nodes(layout, zone, difference.data(), plane,
                            [&](double const* v) { solution.add_displacement(io::displacement_names[c], v, c); });
    }
  }
  for (auto const& field : fields.nodes)
    cgns::with_file_nodes(layout, zone, field.values.data() + zone.first_node, plane,
                          [&](double const* v) { solution.add(field.name, v, field.unit); });
}

void write_cell_fields(cgns::File& file, cgns::ZoneLayout const& layout, io::ZoneSolutions const& present,
                       Index first_cell, OutputFields const& fields) {
  // A plane of nodes in three index directions has no cells in the file that values could belong to.
  if (fields.cells.empty() || (layout.flat_axis >= 0 && layout.index_dimension == 3)) return;
  auto const solution = solution_of(file, layout, present, "MorphCells", "CellCenter", 1, io::names_of_cells(fields));
  for (auto const& field : fields.cells) solution.add(field.name, field.values.data() + first_cell, field.unit);
}

/// The coordinates of a file that has been written.
void check_coordinates(std::string const& path, cgns::Node const& original, Mesh const& mesh,
                       Coordinates const& morphed) {
  cgns::File const file(path, cgns::File::Mode::read);
  auto const tree = file.tree_of_copy(original);
  auto const layout = cgns::zones_of(file, tree, mesh);
  auto const arrays = io::components(morphed);
  std::vector<double> plane;
  for (std::size_t z = 0; z < mesh.zones.size(); ++z)
    for (int c = 0; c < 3; ++c)
      cgns::with_file_nodes(layout.zones[z], mesh.zones[z], arrays[c] + mesh.zones[z].first_node, plane,
                            [&](double const* v) { check_written(file, layout.zones[z], c, v); });
}

}  // namespace

void io::write_morphed_blocks(std::string const& input, std::string const& output, Mesh const& mesh,
                              Coordinates const& morphed, OutputFields const& fields) {
  io::check_fields(mesh.n_nodes(), mesh.n_cells(), mesh.coordinates, morphed, fields);
  Problems problems;
  io::check_finite(mesh, morphed, "morphed mesh", problems);
  problems.throw_if_any<MeshError>();
  if (!cgns::is_cgns(input)) {
    if (!fields.empty())
      throw IoError(output + ": PLOT3D grid files have no place for solutions; write the mesh without fields");
    return plot3d::write(input, output, mesh, morphed);
  }
  cgns::Node original;
  {
    cgns::File const file(input, cgns::File::Mode::read);
    original = file.tree();
    cgns::check_same_mesh(file, cgns::zones_of(file, original, mesh), mesh);
  }

  io::OutputFile target(output);
  target.copy_from(input);
  target.reserve(io::bytes_of_fields(fields, mesh.zones.size(), mesh.n_nodes(), mesh.n_cells()));
  {
    cgns::File file(target.path(), cgns::File::Mode::modify);
    auto const tree = file.tree_of_copy(original);
    auto const layout = cgns::zones_of(file, tree, mesh);
    auto const solutions = fields.empty() ? std::vector<io::ZoneSolutions>() : io::zone_solutions(file, layout);
    std::vector<double> plane;
    Index first_cell = 0;
    for (std::size_t z = 0; z < mesh.zones.size(); ++z) {
      auto const& zone = mesh.zones[z];
      auto const arrays = io::components(morphed);
      for (int c = 0; c < 3; ++c)
        cgns::with_file_nodes(layout.zones[z], zone, arrays[c] + zone.first_node, plane,
                              [&](double const* v) { write_component(file, layout.zones[z], c, v); });
      if (!fields.empty()) {
        write_node_fields(file, layout.zones[z], solutions[z], mesh, zone, morphed, fields);
        write_cell_fields(file, layout.zones[z], solutions[z], first_cell, fields);
      }
      first_cell += Index(zone.extent[0] - 1) * (zone.extent[1] - 1) * (zone.extent[2] - 1);
    }
    file.close();
  }
  check_coordinates(target.path(), original, mesh, morphed);
  target.commit();
}

void io::write_blocks(std::string const& path, Mesh const& mesh, Coordinates const& morphed, OutputFields const& fields,
                      WriteOptions const& options) {
  io::OutputFile target(path);
  write_blocks(target.path(), mesh, options);
  write_morphed_blocks(target.path(), target.path(), mesh, morphed, fields);
  target.commit();
}

void write_morphed(std::string const& input, std::string const& output, Mesh const& mesh, Coordinates const& morphed,
                   OutputFields const& fields) {
  (mesh.is_structured() ? io::write_morphed_blocks : io::write_morphed_elements)(input, output, mesh, morphed, fields);
}

}  // namespace gridmorph
