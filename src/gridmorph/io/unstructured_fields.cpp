#include <gridmorph/io/output_fields.hpp>
#include <gridmorph/io/unstructured_fields.hpp>
#include <gridmorph/mesh/file_order.hpp>

#include <optional>
#include <string>
#include <vector>

namespace gridmorph {

namespace {

/// Zone by zone, each of its values as the file numbers them.
class FieldsWriter {
 public:
  FieldsWriter(cgns::File& file, cgns::Layout const& layout, std::vector<io::ZoneSolutions> const& present,
               Mesh const& mesh)
      : file_(file), layout_(layout), present_(present), mesh_(mesh) {}

  void write(Coordinates const& morphed, OutputFields const& fields) {
    if (fields.displacement || !fields.nodes.empty()) nodes(morphed, fields);
    if (!fields.cells.empty()) cells(fields);
  }

 private:
  using Solutions = std::vector<io::SolutionWriter>;

  void nodes(Coordinates const& morphed, OutputFields const& fields) {
    Solutions solutions;
    for (std::size_t z = 0; z < mesh_.zones.size(); ++z)
      solutions.emplace_back(
          file_, layout_.zones[z], present_[z], "MorphNodes", "Vertex", sizes(z, 0),
          io::names_of_nodes(fields, {layout_.zones[z].array[0] != nullptr, layout_.zones[z].array[1] != nullptr,
                                      layout_.zones[z].array[2] != nullptr}));
    auto const places = node_places(mesh_);
    auto const before = io::components(mesh_.coordinates), after = io::components(morphed);
    std::vector<double> difference(fields.displacement ? std::size_t(mesh_.n_nodes()) : 0);
    for (std::size_t c = 0; fields.displacement && c < 3; ++c) {
      for (std::size_t n = 0; n < difference.size(); ++n) difference[n] = after[c][n] - before[c][n];
      auto const ordered = in_file_order(places, difference);
      for (std::size_t z = 0; z < mesh_.zones.size(); ++z)
        if (layout_.zones[z].array[c])
          solutions[z].add_displacement(io::displacement_names[c], ordered.data() + mesh_.zones[z].first_node, int(c));
    }
    for (auto const& field : fields.nodes) {
      auto const ordered = in_file_order(places, field.values);
      for (std::size_t z = 0; z < mesh_.zones.size(); ++z)
        solutions[z].add(field.name, ordered.data() + mesh_.zones[z].first_node, field.unit);
    }
  }

  void cells(OutputFields const& fields) {
    std::vector<std::optional<io::SolutionWriter>> solutions(mesh_.zones.size());
    for (std::size_t z = 0; z < mesh_.zones.size(); ++z) {
      auto const& zone = layout_.zones[z];
      // A plane of nodes in three index directions has no cells in the file that values could belong to.
      if (zone.index_dimension < 3 || zone.flat_axis < 0)
        solutions[z].emplace(file_, zone, present_[z], "MorphCells", "CellCenter", sizes(z, 1),
                             io::names_of_cells(fields));
    }
    for (auto const& field : fields.cells) {
      auto const ordered = in_file_order(mesh_.file_order.element, field.values);
      for (std::size_t z = 0; z < mesh_.zones.size(); ++z)
        if (solutions[z]) solutions[z]->add(field.name, ordered.data() + mesh_.zones[z].first_element, field.unit);
    }
  }

  /// The dimensions of an array with a value for each node (less: 0) or each cell (1) of a zone.
  [[nodiscard]] std::vector<Index> sizes(std::size_t z, Index less) const {
    auto const& zone = layout_.zones[z];
    if (!zone.is_block()) return {less == 0 ? mesh_.zones[z].size() : mesh_.zones[z].n_elements};
    std::vector<Index> out;
    for (int a = 0; a < zone.index_dimension; ++a) out.push_back(zone.extent[a] - less);
    return out;
  }

  cgns::File& file_;
  cgns::Layout const& layout_;
  std::vector<io::ZoneSolutions> const& present_;
  Mesh const& mesh_;
};

}  // namespace

void write_fields(cgns::File& file, cgns::Layout const& layout, std::vector<io::ZoneSolutions> const& present,
                  Mesh const& mesh, Coordinates const& morphed, OutputFields const& fields) {
  if (!fields.empty()) FieldsWriter(file, layout, present, mesh).write(morphed, fields);
}

}  // namespace gridmorph
