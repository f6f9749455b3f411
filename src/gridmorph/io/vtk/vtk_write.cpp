#include <gridmorph/core/error.hpp>
#include <gridmorph/io/element_orders.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/io/output_fields.hpp>
#include <gridmorph/io/output_file.hpp>
#include <gridmorph/io/vtk/vtu_file.hpp>
#include <gridmorph/mesh/as_hexahedra.hpp>
#include <gridmorph/mesh/file_order.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <type_traits>

namespace gridmorph {

namespace vtk {

namespace {

/// VTK's cell type of an element; 0 where it has none.
std::uint8_t vtk_type(ElementType type, std::size_t nodes) {
  if (type == ElementType::polyhedron) return polyhedron;
  for (std::uint8_t const candidate : {5, 9, 10, 12, 13, 14, 22, 23, 24, 25, 26, 27, 28, 29, 32}) {
    auto const shape = io::vtk_shape(candidate);
    if (shape.type == type && std::size_t(shape.nodes) == nodes) return candidate;
  }
  return 0;
}

std::uint8_t face_type(std::size_t corners) { return corners == 2 ? 3 : corners == 3 ? 5 : corners == 4 ? 9 : polygon; }

/// One piece: tags first, then all arrays as they are in memory, each with the number of its bytes before it.
class Writer {
 public:
  Writer(Mesh const& mesh, std::string const& path) : mesh_(mesh) {
    for (Index e = 0; e < mesh.n_elements(); ++e) element(e, path);
    marker_.assign(type_.size(), 0);
    for (auto const& zone : mesh.zones)
      zone_.insert(zone_.end(), std::size_t(zone.n_elements), std::int32_t(&zone - mesh.zones.data()) + 1);
    for (std::size_t p = 0; p < mesh.patches.size(); ++p)
      for (Index f = 0; f < mesh.patches[p].faces.size(); ++f) face(mesh.patches[p].faces[f], p);
    // Patches that list nodes have the faces between these.
    if (std::any_of(mesh.patches.begin(), mesh.patches.end(), lists_nodes)) {
      auto const topology = make_topology(mesh);
      auto const of_face = find_face_patches(mesh, topology);
      for (Index f = 0; f < topology.boundary.size(); ++f)
        if (int const p = of_face.patch[f]; p >= 0 && lists_nodes(mesh.patches[p]))
          face(topology.boundary.nodes[f], std::size_t(p));
    }
  }

  std::string run(Coordinates const& morphed, OutputFields const& fields) {
    std::string const endian = std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";
    tags_ = "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"" + endian +
            "\" header_type=\"UInt64\">\n<UnstructuredGrid>\n";
    names();
    tags_ += "<Piece NumberOfPoints=\"" + std::to_string(mesh_.n_nodes()) + "\" NumberOfCells=\"" +
             std::to_string(type_.size()) + "\">\n<PointData>\n";
    if (fields.displacement) array("Displacement", 3, difference(morphed));
    for (auto const& field : fields.nodes) array(field.name, 1, field.values);
    tags_ += "</PointData>\n<CellData>\n";
    array("CellEntityIds", 1, marker_);
    if (mesh_.zones.size() > 1) array("Zone", 1, zone_);
    for (auto const& field : fields.cells) {
      auto values = field.values;
      values.resize(type_.size(), std::numeric_limits<double>::quiet_NaN());
      array(field.name, 1, values);
    }
    tags_ += "</CellData>\n<Points>\n";
    array("Points", 3, interleaved(morphed));
    tags_ += "</Points>\n<Cells>\n";
    array("connectivity", 1, connectivity_);
    array("offsets", 1, offsets_);
    array("types", 1, type_);
    if (!faces_.empty()) {
      array("faces", 1, faces_);
      array("faceoffsets", 1, faces_end_);
    }
    tags_ += "</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
    tags_ += data_;
    return std::move(tags_) + "\n</AppendedData>\n</VTKFile>\n";
  }

 private:
  static bool lists_nodes(Patch const& patch) { return patch.faces.size() == 0 && !patch.nodes.empty(); }

  void face(std::span<Index32 const> nodes, std::size_t patch) {
    end_cell(face_type(nodes.size()), nodes);
    marker_.push_back(std::int32_t(patch) + 1);
    zone_.push_back(mesh_.patches[patch].zone + 1);
  }

  void element(Index e, std::string const& path) {
    auto const nodes = mesh_.elements.nodes[e];
    ElementType const type = mesh_.elements.type[e];
    std::uint8_t const number = vtk_type(type, nodes.size());
    if (number == 0)
      throw IoError(path + ": " + describe_element(mesh_, e) + " of " + std::to_string(nodes.size()) +
                    " nodes has no type of cells in VTK");
    std::vector<Index32> sids(nodes.begin(), nodes.end());
    if (type == ElementType::prism) io::turn_prism(sids);  // VTK's bottom triangles look outwards
    std::vector<Index32> row = sids;
    auto const order = io::vtk_shape(number).order;
    for (std::size_t k = 0; k < order.size(); ++k) row[order[k]] = sids[k];
    end_cell(number, row);
    if (type != ElementType::polyhedron) return;
    int const n = n_sides(mesh_, e);
    faces_.push_back(n);
    std::array<Index32, max_face_corners> room{};
    for (int f = 0; f < n; ++f) {
      auto const nodes_of_side = side_nodes(mesh_, e, f, room);
      faces_.push_back(std::int64_t(nodes_of_side.size()));
      faces_.insert(faces_.end(), nodes_of_side.begin(), nodes_of_side.end());
    }
    faces_end_.back() = std::int64_t(faces_.size());
  }

  void end_cell(std::uint8_t type, std::span<Index32 const> nodes) {
    connectivity_.insert(connectivity_.end(), nodes.begin(), nodes.end());
    offsets_.push_back(std::int64_t(connectivity_.size()));
    type_.push_back(type);
    faces_end_.push_back(-1);
  }

  /// Writes the names of patches as strings are in these files: codes of characters, each string ended by a zero.
  void names() {
    if (mesh_.patches.empty()) return;
    tags_ += std::string("<FieldData>\n<DataArray type=\"String\" Name=\"") + vtk::patch_names +
             "\" NumberOfTuples=\"" + std::to_string(mesh_.patches.size()) + "\" format=\"ascii\">\n";
    for (auto const& patch : mesh_.patches) {
      for (unsigned char const c : patch.name) tags_ += std::to_string(int(c)) + " ";
      tags_ += "0\n";
    }
    tags_ += "</DataArray>\n</FieldData>\n";
  }

  [[nodiscard]] static std::vector<double> interleaved(Coordinates const& x) {
    std::vector<double> out;
    out.reserve(3 * std::size_t(x.size()));
    for (Index n = 0; n < x.size(); ++n) out.insert(out.end(), {x.x(n), x.y(n), x.z(n)});
    return out;
  }
  /// The displacement of all nodes; both meshes are in the order of the file already.
  [[nodiscard]] std::vector<double> difference(Coordinates const& morphed) const {
    std::vector<double> out = interleaved(morphed);
    auto const before = interleaved(mesh_.coordinates);
    for (std::size_t k = 0; k < out.size(); ++k) out[k] -= before[k];
    return out;
  }

  template <class T>
  void array(std::string const& name, int components, std::vector<T> const& values) {
    constexpr char const* type = std::is_same_v<T, double>         ? "Float64"
                                 : std::is_same_v<T, std::int64_t> ? "Int64"
                                 : std::is_same_v<T, std::int32_t> ? "Int32"
                                                                   : "UInt8";
    tags_ += std::string("<DataArray type=\"") + type + "\" Name=\"" + vtk::escaped(name) + "\" NumberOfComponents=\"" +
             std::to_string(components) + "\" format=\"appended\" offset=\"" + std::to_string(data_.size()) + "\"/>\n";
    std::uint64_t const bytes = values.size() * sizeof(T);
    data_.append(reinterpret_cast<char const*>(&bytes), sizeof bytes);
    data_.append(reinterpret_cast<char const*>(values.data()), std::size_t(bytes));
  }

  Mesh const& mesh_;
  std::vector<std::int64_t> connectivity_, offsets_, faces_, faces_end_;
  std::vector<std::uint8_t> type_;
  std::vector<std::int32_t> marker_, zone_;
  std::string tags_, data_;
};

void write_elements(std::string const& path, Mesh const& mesh, Coordinates const& morphed, OutputFields const& fields) {
  io::OutputFile target(path);
  target.write(Writer(mesh, path).run(morphed, fields));
  target.commit();
}

}  // namespace

}  // namespace vtk

void write_vtk(std::string const& path, Mesh const& mesh, Coordinates const& morphed, OutputFields const& fields) {
  if (mesh.is_structured()) {
    Mesh const hexahedra = as_hexahedra(mesh);
    io::check_fields(hexahedra.n_nodes(), hexahedra.n_elements(), mesh.coordinates, morphed, fields);
    return vtk::write_elements(path, hexahedra, morphed, fields);
  }
  io::check_fields(mesh.n_nodes(), mesh.n_elements(), mesh.coordinates, morphed, fields);
  if (mesh.file_order.node.empty()) return vtk::write_elements(path, mesh, morphed, fields);
  // Fields still come in the mesh's own order.
  Mesh ordered = in_file_order(mesh);
  Coordinates const places = in_file_order(mesh, morphed);
  OutputFields in_order = fields;
  auto const of_nodes = node_places(mesh);
  for (auto& field : in_order.nodes) field.values = in_file_order(of_nodes, field.values);
  for (auto& field : in_order.cells) field.values = in_file_order(mesh.file_order.element, field.values);
  ordered.file_order = {};
  vtk::write_elements(path, ordered, places, in_order);
}

}  // namespace gridmorph
