#include <gridmorph/core/error.hpp>
#include <gridmorph/io/element_orders.hpp>
#include <gridmorph/io/vtk/vtu_file.hpp>

#include <algorithm>
#include <array>
#include <limits>

namespace gridmorph::vtk {

namespace {

/// Cell arrays that number boundaries: of VTK and its users, Gmsh, pygmsh and meshio, SU2, MEDIT, FEniCS, OpenFOAM,
/// STAR-CCM+.
constexpr std::array<std::string_view, 16> marker_arrays{
    "CellEntityIds", "gmsh:physical", "cell_tags",  "BoundaryId",      "BoundaryIds", "boundary_id",
    "Marker",        "marker",        "MarkerTag",  "medit:ref",       "PatchId",     "patchID",
    "SurfaceId",     "RegionId",      "facet_tags", "gmsh:geometrical"};

Tag const& need(XmlFile const& file, Tag const& parent, char const* name) {
  Tag const* out = parent.child(name);
  if (out == nullptr) file.fail(parent, "<" + parent.name + "> holds no <" + name + ">");
  return *out;
}

Tag const* named_array(Tag const& parent, std::string_view name) {
  for (Tag const& t : parent.children)
    if ((t.name == "DataArray" || t.name == "Array") && t["Name"] == name) return &t;
  return nullptr;
}

Tag const& need_array(XmlFile const& file, Tag const& parent, char const* name) {
  Tag const* out = named_array(parent, name);
  if (out == nullptr) file.fail(parent, "<" + parent.name + "> holds no DataArray '" + name + "'");
  return *out;
}

/// Numbers of polyhedra stand behind one another, each behind the end of the one before it.
void check_faces(XmlFile const& file, Tag const& cells, Grid const& grid) {
  std::int64_t begin = 0;
  auto const bad = [&](Index c) {
    file.fail(cells, "faces of cell " + std::to_string(c) + " do not fit what 'faces' and 'faceoffsets' hold");
  };
  for (Index c = 0; c < grid.n_cells; ++c) {
    std::int64_t const end = grid.faces_end[c];
    if (grid.type[c] != polyhedron) continue;
    if (end <= begin || end > std::int64_t(grid.faces.size())) bad(c);
    std::int64_t at = begin + 1;
    for (std::int64_t f = 0; f < grid.faces[begin]; ++f) {
      if (at >= end) bad(c);
      std::int64_t const n = grid.faces[at++];
      if (n < 3 || n > end - at) bad(c);
      for (std::int64_t k = 0; k < n; ++k, ++at)
        if (grid.faces[at] < 0 || grid.faces[at] >= grid.n_points) bad(c);
    }
    if (at != end || grid.faces[begin] < 4) bad(c);
    begin = end;
  }
}

/// Faces as VTK 9.4 and later have them: each once for each polyhedron, its nodes between places of its own.
void read_shared_faces(XmlFile const& file, Tag const& cells, Grid& grid) {
  auto const nodes = file.integers(need_array(file, cells, "face_connectivity"));
  auto const nodes_end = file.integers(need_array(file, cells, "face_offsets"));
  auto const faces = file.integers(need_array(file, cells, "polyhedron_to_faces"));
  auto const faces_end = file.integers(need_array(file, cells, "polyhedron_offsets"), grid.n_cells);
  grid.faces_end.assign(grid.n_cells, -1);
  std::int64_t at = 0;
  for (Index c = 0; c < grid.n_cells; ++c) {
    std::int64_t const end = faces_end[c];
    auto const bad = [&](std::string const& what) { file.fail(cells, "cell " + std::to_string(c) + ": " + what); };
    if (end < at || end > std::int64_t(faces.size()))
      bad("its faces end at " + std::to_string(end) + " of the " + std::to_string(faces.size()) +
          " of 'polyhedron_to_faces'");
    if (grid.type[c] != polyhedron) {
      if (end != at) bad("has faces, and is no polyhedron");
      continue;
    }
    grid.faces.push_back(end - at);
    for (; at < end; ++at) {
      std::int64_t const f = faces[at];
      if (f < 0 || f >= std::int64_t(nodes_end.size()))
        bad("has face " + std::to_string(f) + ", and there are " + std::to_string(nodes_end.size()) +
            ", counted from 0");
      std::int64_t const begin = f == 0 ? 0 : nodes_end[f - 1], last = nodes_end[f];
      if (begin < 0 || last < begin || last > std::int64_t(nodes.size()))
        bad("face " + std::to_string(f) + " has nodes " + std::to_string(begin) + " to " + std::to_string(last) +
            " of the " + std::to_string(nodes.size()) + " of 'face_connectivity'");
      // What damaged numbers list again and again is no mesh.
      if (grid.faces.size() + std::size_t(last - begin) > 4 * (nodes.size() + faces.size()) + 64)
        bad("faces are listed more often than meshes have them");
      grid.faces.push_back(last - begin);
      grid.faces.insert(grid.faces.end(), nodes.begin() + begin, nodes.begin() + last);
    }
    grid.faces_end[c] = std::int64_t(grid.faces.size());
  }
}

/// Cells that belong to another process would be in the mesh twice.
void refuse_ghosts(XmlFile const& file, Tag const& piece) {
  Tag const* data = piece.child("CellData");
  Tag const* ghosts = data == nullptr ? nullptr : named_array(*data, "vtkGhostType");
  if (data != nullptr && ghosts == nullptr) ghosts = named_array(*data, "vtkGhostLevels");
  if (ghosts == nullptr || !XmlFile::is_integer(*ghosts)) return;
  auto const values = file.integers(*ghosts);
  constexpr std::int64_t duplicate = 1;
  bool const levels = (*ghosts)["Name"] == "vtkGhostLevels";
  auto const n = std::count_if(values.begin(), values.end(),
                               [&](std::int64_t v) { return levels ? v != 0 : (v & duplicate) != 0; });
  if (n > 0)
    file.fail(*ghosts, std::to_string(n) +
                           " cells are ghosts, copies of cells of other pieces; write the mesh without "
                           "them (GhostLevel 0), or remove them in ParaView (Ghost Cells)");
}

}  // namespace

int dimension_of_cell(std::uint8_t type) {
  if (type == polyhedron) return 3;
  if (type == polygon || type == triangle_strip) return 2;
  if (type == poly_line) return 1;
  if (type == poly_vertex || type == 0) return 0;
  return io::vtk_shape(type).dimension;
}

namespace {

Grid read_piece(XmlFile const& file, Tag const& piece) {
  Grid out;
  out.piece = &piece;
  refuse_ghosts(file, piece);
  out.n_points = file.count(*out.piece, "NumberOfPoints");
  out.n_cells = file.count(*out.piece, "NumberOfCells");
  constexpr Index most = std::numeric_limits<Index32>::max();
  if (out.n_points > most || out.n_cells > most)
    file.fail(*out.piece, "has more points or cells than can be handled, " + std::to_string(most));
  Tag const& points = need(file, *out.piece, "Points");
  out.points = points.child("DataArray");
  if (out.points == nullptr || file.count(*out.points, "NumberOfComponents") != 3)
    file.fail(points, "<Points> holds no DataArray of 3 components");
  out.coordinates = file.coordinates(*out.points, 3 * out.n_points);
  Tag const& cells = need(file, *out.piece, "Cells");
  auto const types = file.integers(need_array(file, cells, "types"), out.n_cells);
  auto const offsets = file.integers(need_array(file, cells, "offsets"), out.n_cells);
  auto const connectivity = file.integers(need_array(file, cells, "connectivity"));
  std::int64_t begin = 0;
  for (Index c = 0; c < out.n_cells; ++c) {
    std::int64_t const type = types[c], end = offsets[c];
    std::string const which = "cell " + std::to_string(c);
    int const dimension = type < 0 || type > 255 ? -1 : dimension_of_cell(std::uint8_t(type));
    if (dimension < 0)
      file.fail(cells, which + " is of VTK's type " + std::to_string(type) +
                           "; cells of first and second order are read, polygons and polyhedra");
    if (end < begin || end > std::int64_t(connectivity.size()))
      file.fail(cells, which + " has nodes " + std::to_string(begin) + " to " + std::to_string(end) + " of the " +
                           std::to_string(connectivity.size()) + " of 'connectivity'");
    int const wanted = io::vtk_shape(type).nodes;
    if (wanted > 0 && end - begin != wanted)
      file.fail(cells, which + " of VTK's type " + std::to_string(type) + " has " + std::to_string(end - begin) +
                           " nodes instead of " + std::to_string(wanted));
    if (wanted == 0 && dimension >= 2 && end - begin < 3)
      file.fail(cells, which + " has " + std::to_string(end - begin) + " nodes");
    for (; begin < end; ++begin) {
      std::int64_t const n = connectivity[begin];
      if (n < 0 || n >= out.n_points)
        file.fail(cells, which + " has node " + std::to_string(n) + ", and there are " + std::to_string(out.n_points) +
                             ", counted from 0");
      out.nodes.item.push_back(Index32(n));
    }
    out.nodes.first.push_back(Index(out.nodes.item.size()));
    out.type.push_back(std::uint8_t(type));
  }
  if (std::find(out.type.begin(), out.type.end(), polyhedron) != out.type.end()) {
    if (named_array(cells, "faces") != nullptr) {
      out.faces = file.integers(need_array(file, cells, "faces"));
      out.faces_end = file.integers(need_array(file, cells, "faceoffsets"), out.n_cells);
    } else if (named_array(cells, "face_connectivity") != nullptr) {
      read_shared_faces(file, cells, out);
    } else {
      file.fail(cells,
                "holds polyhedra without DataArrays 'faces' and 'faceoffsets', or 'face_connectivity', "
                "'face_offsets', 'polyhedron_to_faces' and 'polyhedron_offsets'");
    }
    check_faces(file, cells, out);
  }
  return out;
}

}  // namespace

std::vector<Grid> read_grids(XmlFile const& file) {
  Tag const& unstructured = need(file, file.root(), "UnstructuredGrid");
  std::vector<Grid> out;
  for (Tag const& piece : unstructured.children)
    if (piece.name == "Piece" && file.count(piece, "NumberOfCells") > 0) out.push_back(read_piece(file, piece));
  return out;
}

Grid read_grid(XmlFile const& file) {
  auto grids = read_grids(file);
  Tag const& unstructured = need(file, file.root(), "UnstructuredGrid");
  if (grids.empty()) file.fail(unstructured, "holds no cells");
  if (grids.size() > 1)
    file.fail(*grids[1].piece,
              "holds several pieces with cells, and one is wanted here; merge them in ParaView (Clean "
              "to Grid), or write it from one process");
  return std::move(grids.front());
}

int dimension_of(Grid const& grid) {
  int out = 0;
  for (std::uint8_t const type : grid.type) out = std::max(out, dimension_of_cell(type));
  return out < 2 ? 0 : out;
}

std::optional<Markers> read_markers(XmlFile const& file, Grid const& grid) {
  Tag const* data = grid.piece->child("CellData");
  if (data == nullptr) return std::nullopt;
  for (std::string_view const name : marker_arrays) {
    Tag const* array = named_array(*data, name);
    if (array == nullptr || !XmlFile::is_integer(*array)) continue;
    auto const components = (*array)["NumberOfComponents"];
    if (!components.empty() && components != "1") continue;
    Markers out;
    out.array = name;
    out.of_cell = file.integers(*array, grid.n_cells);
    Tag const* fields = file.root().child("UnstructuredGrid")->child("FieldData");
    Tag const* names = fields == nullptr ? nullptr : named_array(*fields, patch_names);
    if (names != nullptr && (*names)["type"] == "String") out.names = file.strings(*names);
    return out;
  }
  return std::nullopt;
}

}  // namespace gridmorph::vtk
