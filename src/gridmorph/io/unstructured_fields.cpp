#include <gridmorph/io/output_fields.hpp>
#include <gridmorph/io/unstructured_fields.hpp>
#include <gridmorph/mesh/file_order.hpp>

#include <string>
#include <vector>

namespace gridmorph {

namespace {

/// Zone by zone, each of its values as the file numbers them.
class FieldsWriter {
 public:
  FieldsWriter(cgns::File& file, cgns::Layout const& layout, UnstructuredMesh const& mesh)
      : file_(file), layout_(layout), mesh_(mesh) {}

  void write(Coordinates const& morphed, OutputFields const& fields) {
    if (fields.displacement || !fields.nodes.empty()) nodes(morphed, fields);
    if (!fields.cells.empty()) cells(fields);
  }

 private:
  using Solutions = std::vector<io::SolutionWriter>;

  void nodes(Coordinates const& morphed, OutputFields const& fields) {
    Solutions solutions;
    for (std::size_t z = 0; z < mesh_.zones.size(); ++z)
      solutions.emplace_back(file_, *layout_.zones[z].node, "MorphNodes", "Vertex",
                             std::vector<Index>{mesh_.zones[z].n_nodes});
    auto const add = [&](std::size_t z, std::string const& name, std::vector<double> const& values) {
      solutions[z].add(name, values.data() + mesh_.zones[z].first_node);
    };
    auto const before = io::components(mesh_.coordinates), after = io::components(morphed);
    std::vector<double> difference(fields.displacement ? std::size_t(mesh_.n_nodes()) : 0);
    for (std::size_t c = 0; fields.displacement && c < 3; ++c) {
      for (std::size_t n = 0; n < difference.size(); ++n) difference[n] = after[c][n] - before[c][n];
      auto const ordered = in_file_order(mesh_.file_order.node, difference);
      for (std::size_t z = 0; z < mesh_.zones.size(); ++z)
        if (layout_.zones[z].array[c]) add(z, io::displacement_names[c], ordered);
    }
    for (auto const& field : fields.nodes) {
      auto const ordered = in_file_order(mesh_.file_order.node, field.values);
      for (std::size_t z = 0; z < mesh_.zones.size(); ++z) add(z, field.name, ordered);
    }
  }

  void cells(OutputFields const& fields) {
    Solutions solutions;
    for (std::size_t z = 0; z < mesh_.zones.size(); ++z)
      solutions.emplace_back(file_, *layout_.zones[z].node, "MorphCells", "CellCenter",
                             std::vector<Index>{mesh_.zones[z].n_elements});
    for (auto const& field : fields.cells) {
      auto const ordered = in_file_order(mesh_.file_order.element, field.values);
      for (std::size_t z = 0; z < mesh_.zones.size(); ++z)
        solutions[z].add(field.name, ordered.data() + mesh_.zones[z].first_element);
    }
  }

  cgns::File& file_;
  cgns::Layout const& layout_;
  UnstructuredMesh const& mesh_;
};

}  // namespace

void write_fields(cgns::File& file, cgns::Layout const& layout, UnstructuredMesh const& mesh,
                  Coordinates const& morphed, OutputFields const& fields) {
  FieldsWriter(file, layout, mesh).write(morphed, fields);
}

}  // namespace gridmorph
