#include <gridmorph/core/error.hpp>
#include <gridmorph/io/file_check.hpp>
#include <gridmorph/io/finite_check.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/io/morphed_file.hpp>
#include <gridmorph/io/output_file.hpp>
#include <gridmorph/io/plot3d.hpp>

#include <algorithm>

namespace gridmorph {

namespace {

std::array<double const*, 3> components(Coordinates const& c) { return {c.x.data(), c.y.data(), c.z.data()}; }

void check_sizes(Mesh const& mesh, Coordinates const& morphed, OutputFields const& fields) {
  auto const expect = [](std::string const& what, Index found, Index expected) {
    if (found != expected)
      throw MeshError(what + " has " + std::to_string(found) + " values, but the mesh asks for " +
                      std::to_string(expected));
  };
  expect("the array of morphed coordinates", morphed.size(), mesh.n_nodes());
  if (fields.displacement) expect("the array of baseline coordinates", mesh.coordinates.size(), mesh.n_nodes());
  for (auto const& f : fields.nodes) expect("node field '" + f.name + "'", Index(f.values.size()), mesh.n_nodes());
  for (auto const& f : fields.cells) expect("cell field '" + f.name + "'", Index(f.values.size()), mesh.n_cells());
}

class SolutionWriter {
 public:
  SolutionWriter(cgns::File& file, cgns::ZoneLayout const& layout, char const* wanted_name, char const* location,
                 bool cells)
      : file_(file) {
    std::string name = wanted_name;
    // A solution of that name may be in the input, which comes through unchanged.
    for (int n = 2; layout.node->child(name); ++n) name = wanted_name + std::to_string(n);
    for (int a = 0; a < layout.index_dimension; ++a) dimensions_.push_back(layout.extent[a] - (cells ? 1 : 0));
    id_ = file.create(layout.node->id, name, "FlowSolution_t");
    file.create_text(id_, "GridLocation", "GridLocation_t", location);
  }
  void add(std::string const& name, double const* values) const {
    file_.create(id_, name, "DataArray_t", "R8", dimensions_, values);
  }

 private:
  cgns::File& file_;
  double id_ = 0;
  std::vector<Index> dimensions_;
};

void write_node_fields(cgns::File& file, cgns::ZoneLayout const& layout, Mesh const& mesh, Zone const& zone,
                       Coordinates const& morphed, OutputFields const& fields) {
  if (!fields.displacement && fields.nodes.empty()) return;
  SolutionWriter const solution(file, layout, "MorphNodes", "Vertex", false);
  std::vector<double> plane;
  if (fields.displacement) {
    static constexpr std::array names{"DisplacementX", "DisplacementY", "DisplacementZ"};
    auto const before = components(mesh.coordinates), after = components(morphed);
    std::vector<double> difference(std::size_t(zone.size()));
    for (int c = 0; c < 3; ++c) {
      if (!layout.array[c]) continue;
      for (Index n = 0; n < zone.size(); ++n)
        difference[n] = after[c][zone.first_node + n] - before[c][zone.first_node + n];
      cgns::with_file_nodes(layout, zone, difference.data(), plane,
                            [&](double const* v) { solution.add(names[c], v); });
    }
  }
  for (auto const& field : fields.nodes)
    cgns::with_file_nodes(layout, zone, field.values.data() + zone.first_node, plane,
                          [&](double const* v) { solution.add(field.name, v); });
}

void write_cell_fields(cgns::File& file, cgns::ZoneLayout const& layout, Index first_cell, OutputFields const& fields) {
  // A plane of nodes in three index directions has no cells in the file that values could belong to.
  if (fields.cells.empty() || (layout.flat_axis >= 0 && layout.index_dimension == 3)) return;
  SolutionWriter const solution(file, layout, "MorphCells", "CellCenter", true);
  for (auto const& field : fields.cells) solution.add(field.name, field.values.data() + first_cell);
}

std::uint64_t bytes_needed(Mesh const& mesh, OutputFields const& fields) {
  if (fields.empty()) return 0;
  std::uint64_t const node_fields = fields.nodes.size() + (fields.displacement ? 3 : 0);
  std::uint64_t const nodes_per_zone = node_fields + fields.cells.size() + 4;
  return cgns::File::bytes_per_node * nodes_per_zone * mesh.zones.size() +
         sizeof(double) *
             (node_fields * std::uint64_t(mesh.n_nodes()) + fields.cells.size() * std::uint64_t(mesh.n_cells()));
}

}  // namespace

void write_morphed(std::string const& input, std::string const& output, Mesh const& mesh, Coordinates const& morphed,
                   OutputFields const& fields) {
  check_sizes(mesh, morphed, fields);
  Problems problems;
  io::check_finite(mesh, morphed, "morphed mesh", problems);
  problems.throw_if_any<MeshError>();
  if (!cgns::is_cgns(input)) {
    if (!fields.empty())
      throw IoError(output + ": PLOT3D grid files have no place for solutions; write the mesh without fields");
    return plot3d::write(input, output, mesh, morphed);
  }
  {
    cgns::File const file(input, cgns::File::Mode::read);
    auto const tree = file.tree();
    cgns::check_same_mesh(file, cgns::zones_of(file, tree), mesh);
  }

  io::OutputFile target(output);
  target.copy_from(input);
  target.reserve(bytes_needed(mesh, fields));
  {
    cgns::File file(target.path(), cgns::File::Mode::modify);
    auto const tree = file.tree();
    auto const layout = cgns::zones_of(file, tree);
    std::vector<double> plane;
    Index first_cell = 0;
    for (std::size_t z = 0; z < mesh.zones.size(); ++z) {
      auto const& zone = mesh.zones[z];
      auto const arrays = components(morphed);
      for (int c = 0; c < 3; ++c)
        cgns::with_file_nodes(layout.zones[z], zone, arrays[c] + zone.first_node, plane,
                              [&](double const* v) { write_component(file, layout.zones[z], c, v); });
      write_node_fields(file, layout.zones[z], mesh, zone, morphed, fields);
      write_cell_fields(file, layout.zones[z], first_cell, fields);
      first_cell += Index(zone.extent[0] - 1) * (zone.extent[1] - 1) * (zone.extent[2] - 1);
    }
    file.close();
  }
  cgns::check_file(target.path());
  target.commit();
}

}  // namespace gridmorph
