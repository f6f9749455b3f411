#include <gridmorph/core/error.hpp>
#include <gridmorph/io/element_orders.hpp>
#include <gridmorph/io/finite_check.hpp>
#include <gridmorph/io/kind_by_name.hpp>
#include <gridmorph/io/output_file.hpp>
#include <gridmorph/io/polyhedron.hpp>
#include <gridmorph/io/read_file.hpp>
#include <gridmorph/io/used_nodes.hpp>
#include <gridmorph/io/vtk/blocks.hpp>
#include <gridmorph/io/vtk/grid_mesh.hpp>
#include <gridmorph/io/vtk/vtk_mesh.hpp>
#include <gridmorph/io/vtk/vtu_file.hpp>
#include <gridmorph/mesh/file_order.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

namespace gridmorph::vtk {

namespace {

/// Number in the mesh of each point; -1 for those that no cell of its dimension uses.
std::vector<Index32> mesh_nodes(Grid const& grid, int dimension, Index& n_nodes) {
  return io::used_nodes(
      grid.nodes, std::size_t(grid.n_points),
      [&](Index e) { return dimension_of_cell(grid.type[std::size_t(e)]) == dimension; }, n_nodes);
}

class Builder {
 public:
  Builder(XmlFile const& file, Grid const& grid) : file_(file), grid_(grid) {
    mesh_.source = file.path();
    mesh_.first_number = 0;
  }

  Mesh run() {
    mesh_.dimension = dimension_of(grid_);
    if (mesh_.dimension == 0) throw MeshError(file_.path() + ": has neither volumes nor surfaces");
    Index n_nodes = 0;
    number_ = mesh_nodes(grid_, mesh_.dimension, n_nodes);
    mesh_.add_zone("zone 1", n_nodes);
    mesh_.zones.back().single_precision = (*grid_.points)["type"] == "Float32";
    mesh_.coordinates = Coordinates(n_nodes);
    for (std::size_t n = 0; n < number_.size(); ++n)
      if (number_[n] >= 0) mesh_.coordinates.set(number_[n], place(n));
    Problems problems;
    io::check_finite(mesh_, mesh_.coordinates, file_.path(), problems);
    problems.throw_if_any<MeshError>();
    cells();
    if (io::orient_prisms(mesh_)) note("the prisms are numbered with bottom triangles outwards, as VTK says; taken so");
    patches();
    check_mesh(mesh_);
    notes();
    return std::move(mesh_);
  }

 private:
  [[nodiscard]] Vec3 place(std::size_t n) const {
    return {grid_.coordinates[3 * n], grid_.coordinates[3 * n + 1], grid_.coordinates[3 * n + 2]};
  }
  void note(std::string const& text) { mesh_.notes.push_back(file_.path() + ": " + text); }

  void cells() {
    io::ElementsByFaces polyhedra(mesh_);
    std::vector<Index32> row;
    std::int64_t begin = 0;
    for (Index c = 0; c < grid_.n_cells; ++c) {
      std::uint8_t const type = grid_.type[std::size_t(c)];
      if (type == polyhedron) {
        add_polyhedron(c, begin, polyhedra);
        begin = grid_.faces_end[std::size_t(c)];
        continue;
      }
      if (dimension_of_cell(type) != mesh_.dimension) continue;
      if (type == polygon || type == triangle_strip)
        throw MeshError(file_.path() + ": cell " + std::to_string(c) +
                        " is a polygon or a strip; plane meshes are of triangles and quadrilaterals");
      auto const shape = io::vtk_shape(type);
      auto const nodes = grid_.nodes[c];
      row.clear();
      for (std::size_t k = 0; k < nodes.size(); ++k)
        row.push_back(number_[std::size_t(nodes[shape.order.empty() ? k : shape.order[k]])]);
      mesh_.add_element(shape.type, row);
      mesh_.elements.number.push_back(Index32(c));
    }
  }

  /// VTK does not say which way faces look: outwards is away from the middle of the cell.
  void add_polyhedron(Index c, std::int64_t at, io::ElementsByFaces& polyhedra) {
    Vec3 middle;
    for (Index32 const n : grid_.nodes[c]) middle += (1 / double(grid_.nodes[c].size())) * place(std::size_t(n));
    std::vector<Index32> face;
    std::int64_t const n_faces = grid_.faces[std::size_t(at++)];
    for (std::int64_t f = 0; f < n_faces; ++f) {
      face.clear();
      std::int64_t const n = grid_.faces[std::size_t(at++)];
      Vec3 area, centre;
      Vec3 const first = place(std::size_t(grid_.faces[std::size_t(at)]));
      for (std::int64_t k = 0; k < n; ++k) {
        auto const own = std::size_t(grid_.faces[std::size_t(at + k)]),
                   next = std::size_t(grid_.faces[std::size_t(at + (k + 1) % n)]);
        if (number_[own] < 0)
          throw MeshError(file_.path() + ": a face of cell " + std::to_string(c) + " has node " + std::to_string(own) +
                          ", and the cell does not list it");
        face.push_back(number_[own]);
        centre += (1 / double(n)) * place(own);
        area += cross(place(own) - first, place(next) - first);
      }
      at += n;
      polyhedra.add_face(face, dot(area, centre - middle) > 0);
    }
    polyhedra.end_element(c);
  }

  void patches() {
    auto const markers = read_markers(file_, grid_);
    std::map<std::int64_t, std::size_t> known;
    std::vector<Index32> face;
    for (Index c = 0; c < grid_.n_cells; ++c) {
      std::uint8_t const type = grid_.type[std::size_t(c)];
      if (dimension_of_cell(type) != mesh_.dimension - 1 || type == triangle_strip) continue;
      auto const corners = io::vtk_shape(type).corners;
      auto const order = io::vtk_shape(type).order;
      auto const nodes = grid_.nodes[c];
      face.clear();
      for (std::size_t k = 0; k < (corners > 0 ? std::size_t(corners) : nodes.size()); ++k)
        face.push_back(number_[std::size_t(nodes[order.empty() ? k : order[k]])]);
      if (face.size() < (mesh_.dimension == 3 ? 3U : 2U) || std::find(face.begin(), face.end(), -1) != face.end()) {
        ++loose_;
        continue;
      }
      std::int64_t const number = markers ? markers->of_cell[std::size_t(c)] : 0;
      auto const [at, is_new] = known.try_emplace(number, mesh_.patches.size());
      if (is_new) {
        Patch patch;
        patch.zone = 0;
        bool const named = markers && number >= 1 && std::size_t(number) <= markers->names.size();
        patch.name = named     ? markers->names[std::size_t(number) - 1]
                     : markers ? markers->array + " " + std::to_string(number)
                               : "surface";
        patch.kind = io::kind_by_name(patch.name);
        mesh_.patches.push_back(std::move(patch));
      }
      mesh_.patches[at->second].faces.add(face);
    }
    if (!known.empty())
      note(markers ? "surfaces are told apart by the cell array '" + markers->array + "'"
                   : "surfaces are one patch: there is no cell array that numbers them (docs/formats.md lists names)");
  }

  void notes() {
    if (auto const unused = grid_.n_points - mesh_.n_nodes(); unused > 0)
      note(std::to_string(unused) +
           " points belong to no cell of the mesh and stay where they are; messages count nodes without them");
    if (loose_ > 0) note(std::to_string(loose_) + " cells of its boundary are not at the mesh; left alone");
  }

  XmlFile const& file_;
  Grid const& grid_;
  Mesh mesh_;
  std::vector<Index32> number_;
  Index loose_ = 0;
};

/// Where fields go: into PointData or CellData, which are made where they are missing.
class FieldEdits {
 public:
  FieldEdits(XmlFile const& file, Grid const& grid, char const* tag_name)
      : file_(file), grid_(grid), name_(tag_name), data_(grid.piece->child(tag_name)) {}

  void add(std::string const& name, int components, std::vector<double> const& values) {
    text_ += file_.array_text(prefix_ + name, components, values, *grid_.points);
  }
  /// Names of what is to come, so that all can give way to those that are there.
  void expect(std::vector<std::string> const& names) {
    for (std::string const& name : names)
      for (Tag const& t : data_ == nullptr ? std::vector<Tag>() : data_->children)
        if (t["Name"] == name) prefix_ = "Morph";
  }
  void append_to(std::vector<Edit>& edits) const {
    if (text_.empty()) return;
    std::string const end = "</" + std::string(name_) + ">\n";
    if (data_ == nullptr)
      edits.push_back({grid_.piece->inside, grid_.piece->inside, "\n<" + std::string(name_) + ">\n" + text_ + end});
    else if (data_->closed)
      edits.push_back({data_->end - 2, data_->end, ">\n" + text_ + end});
    else
      edits.push_back({data_->inside_end, data_->inside_end, text_});
  }

 private:
  XmlFile const& file_;
  Grid const& grid_;
  char const* name_;
  Tag const* data_;
  std::string prefix_, text_;
};

/// Coordinates and fields in the order of the file.
void add_fields(XmlFile const& file, Grid const& grid, std::vector<Index32> const& number, int dimension,
                Coordinates const& before, Coordinates const& after, OutputFields const& fields,
                std::vector<Edit>& edits) {
  FieldEdits points(file, grid, "PointData"), cells(file, grid, "CellData");
  std::vector<std::string> names;
  if (fields.displacement) names.emplace_back("Displacement");
  for (auto const& field : fields.nodes) names.push_back(field.name);
  points.expect(names);
  names.clear();
  for (auto const& field : fields.cells) names.push_back(field.name);
  cells.expect(names);
  if (fields.displacement) {
    std::vector<double> values(3 * number.size(), 0.0);
    for (std::size_t n = 0; n < number.size(); ++n) {
      if (number[n] < 0) continue;
      Vec3 const d = after[number[n]] - before[number[n]];
      std::copy_n(&d.x, 3, values.begin() + std::ptrdiff_t(3 * n));
    }
    points.add("Displacement", 3, values);
  }
  double const none = std::numeric_limits<double>::quiet_NaN();
  for (auto const& field : fields.nodes) {
    auto const& own = field.values;
    std::vector<double> values(number.size(), none);
    for (std::size_t n = 0; n < number.size(); ++n)
      if (number[n] >= 0) values[n] = own[std::size_t(number[n])];
    points.add(field.name, 1, values);
  }
  for (auto const& field : fields.cells) {
    auto const& own = field.values;
    std::vector<double> values(std::size_t(grid.n_cells), none);
    for (std::size_t c = 0, e = 0; c < values.size(); ++c)
      if (dimension_of_cell(grid.type[c]) == dimension) values[c] = own[e++];
    cells.add(field.name, 1, values);
  }
  points.append_to(edits);
  cells.append_to(edits);
}

}  // namespace

bool is_vtu(std::string_view head) {
  constexpr std::size_t start = 4096;
  auto const text = head.substr(0, start);
  auto const at = text.find("<VTKFile");
  if (at == std::string_view::npos) return false;
  auto const tag = text.substr(at, text.find('>', at) - at);
  return tag.find("\"UnstructuredGrid\"") != std::string_view::npos ||
         tag.find("'UnstructuredGrid'") != std::string_view::npos;
}

Mesh mesh_of(XmlFile const& file, Grid const& grid) { return Builder(file, grid).run(); }

void add_rest_of_boundary(Mesh& mesh) {
  auto const topology = make_topology(mesh);
  auto const of_face = find_face_patches(mesh, topology);
  std::vector<Patch> rest(mesh.zones.size());
  for (Index f = 0; f < topology.boundary.size(); ++f) {
    auto const nodes = topology.boundary.nodes[f];
    if (of_face.patch[std::size_t(f)] < 0) rest[std::size_t(mesh.zone_of(nodes[0]))].faces.add(nodes);
  }
  for (std::size_t z = 0; z < rest.size(); ++z) {
    if (rest[z].faces.size() == 0) continue;
    rest[z].zone = int(z);
    rest[z].name = "boundary";
    mesh.patches.push_back(std::move(rest[z]));
  }
}

std::string morphed_text(XmlFile const& file, int dimension, Index n_elements, Coordinates const& before,
                         Coordinates const& after, OutputFields const& fields) {
  Grid const grid = read_grid(file);
  Index n_nodes = 0, n_cells = 0;
  auto const number = mesh_nodes(grid, dimension, n_nodes);
  for (std::uint8_t const type : grid.type) n_cells += dimension_of_cell(type) == dimension ? 1 : 0;
  if (n_nodes != after.size() || n_cells != n_elements)
    throw IoError(file.path() + ": holds another mesh than the one that was read; give the file of that one");
  std::vector<double> places = grid.coordinates;
  for (std::size_t n = 0; n < number.size(); ++n) {
    if (number[n] < 0) continue;
    Vec3 const to = after[number[n]];
    std::copy_n(&to.x, 3, places.begin() + std::ptrdiff_t(3 * n));
  }
  std::vector<Edit> edits;
  file.replace(*grid.points, places, edits);
  add_fields(file, grid, number, dimension, before, after, fields, edits);
  return file.edited(std::move(edits));
}

Mesh read(std::string const& path) {
  if (is_blocks(io::read_head(path))) return read_blocks(path);
  XmlFile const file(path, {"UnstructuredGrid"});
  Mesh mesh = mesh_of(file, read_grid(file));
  add_rest_of_boundary(mesh);
  return mesh;
}

void write_morphed(std::string const& input, std::string const& output, Mesh const& mesh, Coordinates const& morphed,
                   OutputFields const& fields) {
  if (is_blocks(io::read_head(input))) return write_morphed_blocks(input, output, mesh, morphed, fields);
  if (output.ends_with(".vtm"))
    throw IoError(output + ": is written as " + input + " is, an unstructured grid; give it the ending .vtu");
  OutputFields ordered = fields;
  for (auto& field : ordered.nodes) field.values = in_file_order(mesh.file_order.node, field.values);
  for (auto& field : ordered.cells) field.values = in_file_order(mesh.file_order.element, field.values);
  std::string const text = morphed_text(XmlFile(input, {"UnstructuredGrid"}), mesh.dimension, mesh.n_elements(),
                                        in_file_order(mesh, mesh.coordinates), in_file_order(mesh, morphed), ordered);
  io::OutputFile target(output);
  target.write(text);
  target.commit();
}

}  // namespace gridmorph::vtk
