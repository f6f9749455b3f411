#include <gridmorph/core/error.hpp>
#include <gridmorph/io/output_fields.hpp>

#include <utility>

namespace gridmorph::io {

void check_fields(Index n_nodes, Index n_cells, Coordinates const& baseline, Coordinates const& morphed,
                  OutputFields const& fields) {
  auto const expect = [](std::string const& what, Index found, Index expected) {
    if (found != expected)
      throw MeshError(what + " has " + std::to_string(found) + " values, but the mesh asks for " +
                      std::to_string(expected));
  };
  expect("the array of morphed coordinates", morphed.size(), n_nodes);
  if (fields.displacement) expect("the array of baseline coordinates", baseline.size(), n_nodes);
  for (auto const& f : fields.nodes) expect("node field '" + f.name + "'", Index(f.values.size()), n_nodes);
  for (auto const& f : fields.cells) expect("cell field '" + f.name + "'", Index(f.values.size()), n_cells);
}

std::uint64_t bytes_of_fields(OutputFields const& fields, std::size_t n_zones, Index n_nodes, Index n_cells) {
  if (fields.empty()) return 0;
  std::uint64_t const node_fields = fields.nodes.size() + (fields.displacement ? 3 : 0);
  return cgns::File::bytes_per_node * (node_fields + fields.cells.size() + 4) * n_zones +
         sizeof(double) * (node_fields * std::uint64_t(n_nodes) + fields.cells.size() * std::uint64_t(n_cells));
}

SolutionWriter::SolutionWriter(cgns::File& file, cgns::Node const& zone, std::string const& wanted_name,
                               char const* location, std::vector<Index> dimensions)
    : file_(file), dimensions_(std::move(dimensions)) {
  std::string name = wanted_name;
  for (int n = 2; zone.child(name); ++n) name = wanted_name + std::to_string(n);
  id_ = file.create(file.id(zone), name, "FlowSolution_t");
  file.create_text(id_, "GridLocation", "GridLocation_t", location);
}

void SolutionWriter::add(std::string const& name, double const* values) const {
  file_.create(id_, name, "DataArray_t", "R8", dimensions_, values);
}

}  // namespace gridmorph::io
