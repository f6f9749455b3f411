#include <gridmorph/core/error.hpp>
#include <gridmorph/io/element_orders.hpp>
#include <gridmorph/io/finite_check.hpp>
#include <gridmorph/io/kind_by_name.hpp>
#include <gridmorph/io/polyhedron.hpp>
#include <gridmorph/io/read_file.hpp>
#include <gridmorph/io/used_nodes.hpp>
#include <gridmorph/io/vtk/blocks.hpp>
#include <gridmorph/io/vtk/grid_mesh.hpp>
#include <gridmorph/io/vtk/pieces.hpp>
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

constexpr char const* displacement_name = "Displacement";

/// Number in the mesh of each point; -1 for those that no cell of its dimension uses.
std::vector<Index32> mesh_nodes(Grid const& grid, int dimension, Index& n_nodes) {
  return io::used_nodes(
      grid.nodes, std::size_t(grid.n_points), [&](Index e) { return dimension_of_cell(grid.type[e]) == dimension; },
      n_nodes);
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
    io::check_places(mesh_, file_.path(), problems);
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
      std::uint8_t const type = grid_.type[c];
      if (type == polyhedron) {
        add_polyhedron(c, begin, polyhedra);
        begin = grid_.faces_end[c];
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
        row.push_back(number_[nodes[shape.order.empty() ? k : shape.order[k]]]);
      mesh_.add_element(shape.type, row);
      mesh_.elements.number.push_back(Index32(c));
    }
  }

  /// VTK does not say which way faces look: outwards is away from the middle of the cell.
  void add_polyhedron(Index c, std::int64_t at, io::ElementsByFaces& polyhedra) {
    Vec3 middle;
    for (Index32 const n : grid_.nodes[c]) middle += (1 / double(grid_.nodes[c].size())) * place(std::size_t(n));
    std::vector<Index32> face;
    std::int64_t const n_faces = grid_.faces[at++];
    for (std::int64_t f = 0; f < n_faces; ++f) {
      face.clear();
      std::int64_t const n = grid_.faces[at++];
      Vec3 area, centre;
      Vec3 const first = place(std::size_t(grid_.faces[at]));
      for (std::int64_t k = 0; k < n; ++k) {
        auto const own = std::size_t(grid_.faces[at + k]), next = std::size_t(grid_.faces[at + (k + 1) % n]);
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
      std::uint8_t const type = grid_.type[c];
      if (dimension_of_cell(type) != mesh_.dimension - 1 || type == triangle_strip) continue;
      auto const corners = io::vtk_shape(type).corners;
      auto const order = io::vtk_shape(type).order;
      auto const nodes = grid_.nodes[c];
      face.clear();
      for (std::size_t k = 0; k < (corners > 0 ? std::size_t(corners) : nodes.size()); ++k)
        face.push_back(number_[nodes[order.empty() ? k : order[k]]]);
      if (face.size() < (mesh_.dimension == 3 ? 3U : 2U) || std::find(face.begin(), face.end(), -1) != face.end()) {
        ++loose_;
        continue;
      }
      std::int64_t const number = markers ? markers->of_cell[c] : 0;
      auto const [at, is_new] = known.try_emplace(number, mesh_.patches.size());
      if (is_new) {
        Patch patch;
        patch.zone = 0;
        bool const named = markers && number >= 1 && std::size_t(number) <= markers->names.size();
        patch.name = named     ? markers->names[number - 1]
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

std::vector<double> part(std::vector<double> const& values, Index first, Index n) {
  return {values.begin() + first, values.begin() + first + n};
}

/// Appends a mesh as a zone of that name, without its coordinates.
void append(Mesh& all, Mesh const& one, std::string const& name) {
  Index const first = all.n_nodes(), first_element = all.n_elements();
  int const z = all.add_zone(name, one.n_nodes());
  all.zones.back().single_precision = one.zones.front().single_precision;
  std::vector<Index32> row;
  auto const moved = [&](std::span<Index32 const> nodes) {
    row.assign(nodes.begin(), nodes.end());
    for (Index32& n : row) n += Index32(first);
    return std::span<Index32 const>(row);
  };
  for (Index e = 0; e < one.n_elements(); ++e) all.add_element(one.elements.type[e], moved(one.elements.nodes[e]));
  all.elements.number.insert(all.elements.number.end(), one.elements.number.begin(), one.elements.number.end());
  auto& p = all.polyhedra;
  if (!one.polyhedra.element.empty() && p.first_face.empty()) p.first_face.push_back(0);
  Index const faces_before = p.faces.size();
  for (std::size_t k = 0; k < one.polyhedra.element.size(); ++k) {
    p.element.push_back(Index32(one.polyhedra.element[k] + first_element));
    p.first_face.push_back(faces_before + one.polyhedra.first_face[k + 1]);
  }
  for (Index f = 0; f < one.polyhedra.faces.size(); ++f) p.faces.add(moved(one.polyhedra.faces[f]));
  for (Patch patch : one.patches) {
    patch.zone = z;
    for (Index32& n : patch.faces.item) n += Index32(first);
    all.patches.push_back(std::move(patch));
  }
  all.notes.insert(all.notes.end(), one.notes.begin(), one.notes.end());
}

/// Fields of points and of cells in the order of the file.
void add_fields(XmlFile const& file, Grid const& grid, std::vector<Index32> const& number, int dimension,
                Coordinates const& before, Coordinates const& after, OutputFields const& fields,
                FieldPrefixes const& prefixes, std::vector<Edit>& edits) {
  std::string points, cells;
  if (fields.displacement) {
    std::vector<double> values(3 * number.size(), 0.0);
    for (std::size_t n = 0; n < number.size(); ++n) {
      if (number[n] < 0) continue;
      Vec3 const d = after[number[n]] - before[number[n]];
      std::copy_n(&d.x, 3, values.begin() + std::ptrdiff_t(3 * n));
    }
    points += file.array_text(prefixes.points + displacement_name, 3, values, *grid.points);
  }
  double const none = std::numeric_limits<double>::quiet_NaN();
  for (auto const& field : fields.nodes) {
    auto const& own = field.values;
    std::vector<double> values(number.size(), none);
    for (std::size_t n = 0; n < number.size(); ++n)
      if (number[n] >= 0) values[n] = own[number[n]];
    points += file.array_text(prefixes.points + field.name, 1, values, *grid.points);
  }
  for (auto const& field : fields.cells) {
    auto const& own = field.values;
    std::vector<double> values(grid.n_cells, none);
    for (std::size_t c = 0, e = 0; c < values.size(); ++c)
      if (dimension_of_cell(grid.type[c]) == dimension) values[c] = own[e++];
    cells += file.array_text(prefixes.cells + field.name, 1, values, *grid.points);
  }
  append_inside(*grid.piece, "PointData", points, edits);
  append_inside(*grid.piece, "CellData", cells, edits);
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

Mesh joined(std::vector<std::string> const& names, std::vector<Mesh> const& meshes) {
  Mesh all;
  all.first_number = 0;
  for (std::size_t k = 0; k < meshes.size(); ++k) {
    all.dimension = meshes[k].dimension;
    append(all, meshes[k], names[k]);
  }
  all.coordinates = Coordinates(all.n_nodes());
  Index next = 0;
  for (Mesh const& one : meshes)
    for (Index n = 0; n < one.n_nodes(); ++n) all.coordinates.set(next++, one.coordinates[n]);
  return all;
}

Coordinates part(Coordinates const& all, Zone const& zone) {
  Coordinates out(zone.size());
  for (Index n = 0; n < zone.size(); ++n) out.set(n, all[zone.first_node + n]);
  return out;
}

OutputFields part(OutputFields const& all, Zone const& zone) {
  OutputFields out;
  out.displacement = all.displacement;
  for (auto const& f : all.nodes) out.nodes.push_back({f.name, part(f.values, zone.first_node, zone.size()), f.unit});
  for (auto const& f : all.cells)
    out.cells.push_back({f.name, part(f.values, zone.first_element, zone.n_elements), f.unit});
  return out;
}

OutputFields in_order_of_the_file(Mesh const& mesh, OutputFields const& fields) {
  OutputFields out = fields;
  auto const places = node_places(mesh);
  for (auto& field : out.nodes) field.values = in_file_order(places, field.values);
  for (auto& field : out.cells) field.values = in_file_order(mesh.file_order.element, field.values);
  return out;
}

FieldPrefixes field_prefixes(std::span<Grid const* const> grids, OutputFields const& fields) {
  auto const taken = [&](char const* tag_name, std::string const& name) {
    return std::any_of(grids.begin(), grids.end(), [&](Grid const* grid) {
      Tag const* data = grid->piece->child(tag_name);
      return data != nullptr &&
             std::any_of(data->children.begin(), data->children.end(), [&](Tag const& t) { return t["Name"] == name; });
    });
  };
  FieldPrefixes out;
  constexpr char const* ours = "Morph";
  if (fields.displacement && taken("PointData", displacement_name)) out.points = ours;
  for (auto const& field : fields.nodes)
    if (taken("PointData", field.name)) out.points = ours;
  for (auto const& field : fields.cells)
    if (taken("CellData", field.name)) out.cells = ours;
  return out;
}

void append_inside(Tag const& parent, std::string const& name, std::string const& text, std::vector<Edit>& edits) {
  if (text.empty()) return;
  std::string const end = "</" + name + ">\n";
  Tag const* tag = parent.child(name);
  if (tag == nullptr)
    edits.push_back({parent.inside, parent.inside, "\n<" + name + ">\n" + text + end});
  else if (tag->closed)
    edits.push_back({tag->end - 2, tag->end, ">\n" + text + end});
  else
    edits.push_back({tag->inside_end, tag->inside_end, text});
}

void morph_grid(XmlFile const& file, Grid const& grid, int dimension, Index n_elements, Coordinates const& before,
                Coordinates const& after, OutputFields const& fields, FieldPrefixes const& prefixes,
                std::vector<Edit>& edits) {
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
  file.replace(*grid.points, places, edits);
  add_fields(file, grid, number, dimension, before, after, fields, prefixes, edits);
}

std::string morphed_text(XmlFile const& file, int dimension, Index n_elements, Coordinates const& before,
                         Coordinates const& after, OutputFields const& fields) {
  Grid const grid = read_grid(file);
  Grid const* const all[]{&grid};
  std::vector<Edit> edits;
  morph_grid(file, grid, dimension, n_elements, before, after, fields, field_prefixes(all, fields), edits);
  return file.edited(std::move(edits));
}

Mesh read(std::string const& path) { return is_blocks(io::read_head(path)) ? read_blocks(path) : read_pieces(path); }

void write_morphed(std::string const& input, std::string const& output, Mesh const& mesh, Coordinates const& morphed,
                   OutputFields const& fields) {
  if (is_blocks(io::read_head(input))) return write_morphed_blocks(input, output, mesh, morphed, fields);
  write_morphed_pieces(input, output, mesh, morphed, fields);
}

}  // namespace gridmorph::vtk
