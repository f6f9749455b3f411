#include <gridmorph/core/error.hpp>
#include <gridmorph/io/cgns_layout.hpp>
#include <gridmorph/io/file_check.hpp>
#include <gridmorph/io/output_file.hpp>
#include <gridmorph/io/su2_file.hpp>
#include <gridmorph/io/unstructured_check.hpp>
#include <gridmorph/io/unstructured_io.hpp>

#include <array>

namespace gridmorph {

namespace {

std::array<double const*, 3> components(Coordinates const& c) { return {c.x.data(), c.y.data(), c.z.data()}; }

cgns::Layout zones_of(cgns::File const& file, cgns::Node const& tree) {
  Problems problems;
  auto layout = find_unstructured_zones(file, tree, problems);
  problems.throw_if_any<IoError>();
  return layout;
}

/// The file must hold the mesh it is said to hold; also refuses coordinates that live in another file.
void check_same_mesh(cgns::File const& file, cgns::Layout const& layout, UnstructuredMesh const& mesh) {
  Problems problems;
  bool same = layout.zones.size() == mesh.zones.size();
  for (std::size_t z = 0; same && z < mesh.zones.size(); ++z)
    same = layout.zones[z].name == mesh.zones[z].name && layout.zones[z].nodes_in_file() == mesh.zones[z].n_nodes;
  if (!same) problems.add(file.path() + ": holds other zones than the mesh; give the file that the mesh was read from");
  for (auto const& zone : layout.zones)
    for (auto const* array : zone.array)
      if (array && array->linked)
        problems.add(file.path() + ", node " + array->path +
                     ": is a link to another place, which must not be changed; write the mesh into one file without "
                     "links first");
  problems.throw_if_any<IoError>();
}

void check_sizes(UnstructuredMesh const& mesh, Coordinates const& morphed, OutputFields const& fields) {
  auto const expect = [](std::string const& what, Index found, Index expected) {
    if (found != expected)
      throw MeshError(what + " has " + std::to_string(found) + " values, but the mesh asks for " +
                      std::to_string(expected));
  };
  expect("the array of morphed coordinates", morphed.size(), mesh.n_nodes());
  if (fields.displacement) expect("the array of baseline coordinates", mesh.coordinates.size(), mesh.n_nodes());
  for (auto const& f : fields.nodes) expect("node field '" + f.name + "'", Index(f.values.size()), mesh.n_nodes());
  for (auto const& f : fields.cells) expect("cell field '" + f.name + "'", Index(f.values.size()), mesh.n_elements());
}

class SolutionWriter {
 public:
  SolutionWriter(cgns::File& file, cgns::Node const& zone, char const* wanted_name, char const* location, Index size)
      : file_(file), size_(size) {
    std::string name = wanted_name;
    // A solution of that name may be in the input, which comes through unchanged.
    for (int n = 2; zone.child(name); ++n) name = wanted_name + std::to_string(n);
    id_ = file.create(zone.id, name, "FlowSolution_t");
    file.create_text(id_, "GridLocation", "GridLocation_t", location);
  }
  void add(std::string const& name, double const* values) const {
    file_.create(id_, name, "DataArray_t", "R8", {size_}, values);
  }

 private:
  cgns::File& file_;
  double id_ = 0;
  Index size_;
};

void write_fields(cgns::File& file, cgns::ZoneLayout const& layout, UnstructuredMesh const& mesh,
                  UnstructuredZone const& zone, Coordinates const& morphed, OutputFields const& fields) {
  if (fields.displacement || !fields.nodes.empty()) {
    SolutionWriter const solution(file, *layout.node, "MorphNodes", "Vertex", zone.n_nodes);
    static constexpr std::array names{"DisplacementX", "DisplacementY", "DisplacementZ"};
    auto const before = components(mesh.coordinates), after = components(morphed);
    std::vector<double> difference(std::size_t(zone.n_nodes));
    for (std::size_t c = 0; fields.displacement && c < 3; ++c) {
      if (!layout.array[c]) continue;
      for (Index n = 0; n < zone.n_nodes; ++n)
        difference[std::size_t(n)] = after[c][zone.first_node + n] - before[c][zone.first_node + n];
      solution.add(names[c], difference.data());
    }
    for (auto const& field : fields.nodes) solution.add(field.name, field.values.data() + zone.first_node);
  }
  if (!fields.cells.empty()) {
    SolutionWriter const solution(file, *layout.node, "MorphCells", "CellCenter", zone.n_elements);
    for (auto const& field : fields.cells) solution.add(field.name, field.values.data() + zone.first_element);
  }
}

std::uint64_t bytes_needed(UnstructuredMesh const& mesh, OutputFields const& fields) {
  if (fields.empty()) return 0;
  std::uint64_t const node_fields = fields.nodes.size() + (fields.displacement ? 3 : 0);
  return cgns::File::bytes_per_node * (node_fields + fields.cells.size() + 4) * mesh.zones.size() +
         sizeof(double) *
             (node_fields * std::uint64_t(mesh.n_nodes()) + fields.cells.size() * std::uint64_t(mesh.n_elements()));
}

void write_cgns(std::string const& input, std::string const& output, UnstructuredMesh const& mesh,
                Coordinates const& morphed, OutputFields const& fields) {
  {
    cgns::File const file(input, cgns::File::Mode::read);
    auto const tree = file.tree();
    check_same_mesh(file, zones_of(file, tree), mesh);
  }
  io::OutputFile target(output);
  target.copy_from(input);
  target.reserve(bytes_needed(mesh, fields));
  {
    cgns::File file(target.path(), cgns::File::Mode::modify);
    auto const tree = file.tree();
    auto const layout = zones_of(file, tree);
    auto const arrays = components(morphed);
    for (std::size_t z = 0; z < mesh.zones.size(); ++z) {
      auto const& zone = mesh.zones[z];
      for (int c = 0; c < 3; ++c) write_component(file, layout.zones[z], c, arrays[std::size_t(c)] + zone.first_node);
      write_fields(file, layout.zones[z], mesh, zone, morphed, fields);
    }
    file.close();
  }
  cgns::check_file(target.path());
  target.commit();
}

}  // namespace

void write_morphed(std::string const& input, std::string const& output, UnstructuredMesh const& mesh,
                   Coordinates const& morphed, OutputFields const& fields) {
  check_sizes(mesh, morphed, fields);
  Problems problems;
  io::check_finite(mesh, morphed, "morphed mesh", problems);
  problems.throw_if_any<MeshError>();
  if (!su2::is_su2(input)) return write_cgns(input, output, mesh, morphed, fields);
  if (!fields.empty())
    throw IoError(output + ": SU2 files hold no fields; leave out displacement and quality, or use a CGNS mesh");
  su2::write_morphed(input, output, mesh, morphed);
}

}  // namespace gridmorph
