#include <gridmorph/core/error.hpp>
#include <gridmorph/io/element_orders.hpp>
#include <gridmorph/io/files_read.hpp>
#include <gridmorph/io/finite_check.hpp>
#include <gridmorph/io/kind_by_name.hpp>
#include <gridmorph/io/made_folders.hpp>
#include <gridmorph/io/output_file.hpp>
#include <gridmorph/io/read_file.hpp>
#include <gridmorph/io/rest_of_boundary.hpp>
#include <gridmorph/io/vtk/blocks.hpp>
#include <gridmorph/io/vtk/grid_mesh.hpp>
#include <gridmorph/io/vtk/pieces.hpp>
#include <gridmorph/mesh/coordinate_resolution.hpp>
#include <gridmorph/mesh/file_order.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <set>
#include <system_error>
#include <unordered_map>
#include <utility>

namespace gridmorph::vtk {

namespace {

namespace fs = std::filesystem;

constexpr double match_tolerance = 1e-6;  // of the mesh size: surfaces are often stored in single precision

/// A file that a multi-block file names.
struct Leaf {
  std::string name;
  fs::path path;
  Attribute const* attribute = nullptr;  ///< the value of which is the path
  std::unique_ptr<XmlFile> file;
  Grid grid;  ///< of unstructured grids
  int dimension = 0;
  // Of surfaces:
  Tag const* points = nullptr;
  std::vector<double> coordinates;
  CsrGraph faces;
};

Tag const* array_of(Tag const* parent, std::string_view name) {
  if (parent == nullptr) return nullptr;
  for (Tag const& t : parent->children)
    if (t.name == "DataArray" && (name.empty() || t["Name"] == name)) return &t;
  return nullptr;
}

class Blocks {
 public:
  explicit Blocks(std::string const& path) : top_(path, {"vtkMultiBlockDataSet"}) {
    collect(top_.root(), "");
    if (leaves_.empty()) top_.fail(top_.root(), "names no files");
  }

  void read() {
    for (Leaf& leaf : leaves_) read_leaf(leaf);
    for (Leaf const& leaf : leaves_) dimension_ = std::max(dimension_, leaf.dimension);
    if (dimension_ < 2) top_.fail(top_.root(), "its files hold neither volumes nor surfaces");
    for (Leaf& leaf : leaves_)
      if (leaf.dimension == dimension_ - 1) read_surface(leaf);
  }

  [[nodiscard]] XmlFile const& top() const { return top_; }
  [[nodiscard]] std::vector<Leaf> const& leaves() const { return leaves_; }
  [[nodiscard]] int dimension() const { return dimension_; }
  [[nodiscard]] bool is_zone(Leaf const& leaf) const { return leaf.dimension == dimension_; }
  [[nodiscard]] bool is_surface(Leaf const& leaf) const { return leaf.dimension == dimension_ - 1; }

 private:
  void collect(Tag const& tag, std::string const& name) {
    for (Tag const& child : tag.children) {
      auto const own = child["name"];
      std::string const full = own.empty() ? name : name.empty() ? std::string(own) : name + "/" + std::string(own);
      if (auto const* file = child.attribute("file")) {
        Leaf leaf;
        leaf.name = full.empty() ? "block " + std::to_string(leaves_.size() + 1) : full;
        leaf.path = fs::path(top_.path()).parent_path() / file->value;
        leaf.attribute = file;
        leaves_.push_back(std::move(leaf));
      }
      collect(child, full);
    }
  }

  void read_leaf(Leaf& leaf) const {
    leaf.file =
        std::make_unique<XmlFile>(leaf.path.string(), std::vector<std::string_view>{"UnstructuredGrid", "PolyData"});
    if (leaf.file->root()["type"] == "PolyData") {
      Tag const* data = leaf.file->root().child("PolyData");
      Tag const* piece = data == nullptr ? nullptr : data->child("Piece");
      if (piece == nullptr) leaf.file->fail(leaf.file->root(), "holds no piece");
      leaf.dimension =
          array_of(piece->child("Polys"), "connectivity") != nullptr && leaf.file->count(*piece, "NumberOfPolys") > 0
              ? 2
              : 1;
      return;
    }
    leaf.grid = read_grid(*leaf.file);
    for (std::uint8_t const type : leaf.grid.type) leaf.dimension = std::max(leaf.dimension, dimension_of_cell(type));
  }

  void read_surface(Leaf& leaf) const {
    XmlFile const& file = *leaf.file;
    if (file.root()["type"] == "PolyData") {
      Tag const& piece = *file.root().child("PolyData")->child("Piece");
      leaf.points = array_of(piece.child("Points"), "");
      Tag const* cells = piece.child(dimension_ == 3 ? "Polys" : "Lines");
      Tag const *connectivity = array_of(cells, "connectivity"), *offsets = array_of(cells, "offsets");
      if (leaf.points == nullptr || connectivity == nullptr || offsets == nullptr)
        file.fail(piece, "holds no points or no cells");
      leaf.coordinates = file.coordinates(*leaf.points, 3 * file.count(piece, "NumberOfPoints"));
      auto const nodes = file.integers(*connectivity), ends = file.integers(*offsets);
      std::int64_t begin = 0;
      std::vector<Index32> row;
      for (std::int64_t const end : ends) {
        row.clear();
        if (end < begin || end > std::int64_t(nodes.size()))
          file.fail(*cells, "offsets do not fit what 'connectivity' holds");
        for (; begin < end; ++begin) row.push_back(point(leaf, *cells, nodes[begin]));
        leaf.faces.add(row);
      }
      return;
    }
    leaf.points = leaf.grid.points;
    leaf.coordinates = leaf.grid.coordinates;
    std::vector<Index32> row;
    for (Index c = 0; c < leaf.grid.n_cells; ++c) {
      std::uint8_t const type = leaf.grid.type[c];
      auto const shape = io::vtk_shape(type);
      if (dimension_of_cell(type) != leaf.dimension || (shape.corners == 0 && type != polygon)) continue;
      auto const nodes = leaf.grid.nodes[c];
      row.clear();
      for (std::size_t k = 0; k < (shape.corners == 0 ? nodes.size() : std::size_t(shape.corners)); ++k)
        row.push_back(nodes[shape.order.empty() ? k : shape.order[k]]);
      leaf.faces.add(row);
    }
  }

  static Index32 point(Leaf const& leaf, Tag const& cells, std::int64_t n) {
    if (n < 0 || 3 * n >= std::int64_t(leaf.coordinates.size()))
      leaf.file->fail(cells, "a cell has node " + std::to_string(n) + ", and there are " +
                                 std::to_string(leaf.coordinates.size() / 3) + ", counted from 0");
    return Index32(n);
  }

  XmlFile top_;
  std::vector<Leaf> leaves_;
  int dimension_ = 0;
};

/// Points of surfaces in cells of a lattice, much larger than the tolerance.
class PointFinder {
 public:
  PointFinder(std::vector<double> const& points, double tolerance)
      : points_(points), tolerance_(tolerance), cell_(1e3 * tolerance) {
    for (std::size_t n = 0; 3 * n < points.size(); ++n)
      cells_[key({points[3 * n], points[3 * n + 1], points[3 * n + 2]})].push_back(Index32(n));
  }

  /// Calls visit(point) for those within the tolerance of a place.
  template <class Visit>
  void each_at(Vec3 const& p, Visit const& visit) const {
    std::array<std::uint64_t, 8> keys{};
    std::size_t n_keys = 0;
    for (int corner = 0; corner < 8; ++corner) {
      auto const off = [&](int bit) { return (corner >> bit & 1) != 0 ? tolerance_ : -tolerance_; };
      std::uint64_t const k = key(p + Vec3{off(0), off(1), off(2)});
      if (std::find(keys.begin(), keys.begin() + n_keys, k) == keys.begin() + n_keys) keys[n_keys++] = k;
    }
    for (std::size_t k = 0; k < n_keys; ++k) {
      auto const found = cells_.find(keys[k]);
      if (found == cells_.end()) continue;
      for (Index32 const n : found->second) {
        auto const at = 3 * std::size_t(n);
        if (distance(p, {points_[at], points_[at + 1], points_[at + 2]}) <= tolerance_) visit(n);
      }
    }
  }

 private:
  [[nodiscard]] std::uint64_t key(Vec3 const& p) const {
    std::uint64_t out = 0;
    for (double const c : {p.x, p.y, p.z})
      out = out * 0x9E3779B97F4A7C15ULL + std::uint64_t(std::int64_t(std::floor(c / cell_)));
    return out;
  }

  std::vector<double> const& points_;
  double tolerance_, cell_;
  std::unordered_map<std::uint64_t, std::vector<Index32>> cells_;
};

/// For each point of a surface the nodes that lie there, in the order of the mesh.
std::vector<std::vector<Index32>> nodes_at(Leaf const& leaf, Mesh const& mesh, Coordinates const& places) {
  std::vector<std::vector<Index32>> out(leaf.coordinates.size() / 3);
  double const tolerance = place_tolerance(match_tolerance, mesh.size(), coordinate_resolution(mesh));
  if (!(tolerance > 0)) return out;
  PointFinder const finder(leaf.coordinates, tolerance);
  for (Index n = 0; n < places.size(); ++n)
    finder.each_at(places[n], [&](Index32 point) { out[point].push_back(Index32(n)); });
  return out;
}

void add_surface(Mesh& mesh, Leaf const& leaf) {
  auto const nodes = nodes_at(leaf, mesh, mesh.coordinates);
  Index loose = 0;
  std::vector<Patch> patches(mesh.zones.size());
  std::vector<Index32> row;
  for (Index f = 0; f < leaf.faces.size(); ++f) {
    bool found = false;
    for (std::size_t z = 0; z < mesh.zones.size(); ++z) {
      auto const& zone = mesh.zones[z];
      row.clear();
      for (Index32 const point : leaf.faces[f])
        for (Index32 const n : nodes[point])
          if (n >= zone.first_node && n < zone.first_node + zone.size()) {
            row.push_back(n);
            break;
          }
      if (row.size() != leaf.faces[f].size()) continue;
      patches[z].faces.add(row);
      found = true;
    }
    loose += found ? 0 : 1;
  }
  for (std::size_t z = 0; z < patches.size(); ++z) {
    if (patches[z].faces.size() == 0) continue;
    patches[z].name = leaf.name;
    patches[z].zone = int(z);
    patches[z].kind = io::kind_by_name(leaf.name);
    mesh.patches.push_back(std::move(patches[z]));
  }
  if (loose > 0)
    mesh.notes.push_back(leaf.path.string() + ": " + std::to_string(loose) + " of " +
                         std::to_string(leaf.faces.size()) + " cells of block '" + leaf.name +
                         "' are not at the mesh; left alone");
}

/// A surface with its points moved as the nodes that lie there.
std::string moved_surface(Leaf const& leaf, Mesh const& mesh, Coordinates const& before, Coordinates const& after) {
  auto const nodes = nodes_at(leaf, mesh, before);
  std::vector<double> places = leaf.coordinates;
  for (std::size_t point = 0; point < nodes.size(); ++point) {
    if (nodes[point].empty()) continue;
    Vec3 const from = before[nodes[point].front()], to = after[nodes[point].front()];
    if (from == to) continue;
    std::copy_n(&to.x, 3, places.begin() + std::ptrdiff_t(3 * point));
  }
  std::vector<Edit> edits;
  leaf.file->replace(*leaf.points, places, edits);
  return leaf.file->edited(std::move(edits));
}

}  // namespace

bool is_blocks(std::string_view head) {
  constexpr std::size_t start = 4096;
  auto const text = head.substr(0, start);
  return text.find("<VTKFile") != std::string_view::npos && text.find("vtkMultiBlockDataSet") != std::string_view::npos;
}

fs::path name_beside(fs::path const& output, std::size_t number, std::string const& ending) {
  std::string const stem = output.stem().string();
  return fs::path(stem) / (stem + "_" + std::to_string(number) + ending);
}

std::vector<fs::path> files_beside(std::string const& input, fs::path const& output) {
  std::vector<fs::path> out;
  std::string const head = io::read_head(input);
  bool const blocks = is_blocks(head);
  if (!blocks && !is_parallel(head)) return out;
  for (fs::path const& file : blocks ? files_of_blocks(input) : files_of_pieces(input))
    out.push_back(output.parent_path() / name_beside(output, out.size(), blocks ? file.extension().string() : ".vtu"));
  return out;
}

std::vector<fs::path> files_of_blocks(std::string const& path) {
  std::vector<fs::path> out;
  std::error_code ignored;
  Blocks const blocks(path);
  for (Leaf const& leaf : blocks.leaves())
    if (fs::is_regular_file(leaf.path, ignored)) out.push_back(leaf.path);
  return out;
}

Mesh read_blocks(std::string const& path) {
  Blocks blocks(path);
  blocks.read();
  std::vector<std::string> names;
  std::vector<Mesh> meshes;
  std::set<std::string> taken;
  for (Leaf const& leaf : blocks.leaves()) {
    if (!blocks.is_zone(leaf)) continue;
    std::string name = leaf.name;
    for (int n = 2; !taken.insert(name).second; ++n) name = leaf.name + " " + std::to_string(n);
    names.push_back(name);
    meshes.push_back(mesh_of(*leaf.file, leaf.grid));
  }
  Mesh mesh = joined(names, meshes);
  mesh.source = path;
  for (Leaf const& leaf : blocks.leaves())
    if (blocks.is_surface(leaf)) add_surface(mesh, leaf);
  check_mesh(mesh);
  io::add_rest_of_boundary(mesh);
  return mesh;
}

void write_morphed_blocks(std::string const& input, std::string const& output, Mesh const& mesh,
                          Coordinates const& morphed, OutputFields const& fields) {
  fs::path const target(output), folder = fs::path(target).replace_extension();
  if (target.extension() != ".vtm")
    throw IoError(output +
                  ": is written as a multi-block file of VTK with a folder for its blocks; give it the ending .vtm");
  Blocks blocks(input);
  blocks.read();
  Coordinates const before = in_file_order(mesh, mesh.coordinates), after = in_file_order(mesh, morphed);
  OutputFields const all = in_order_of_the_file(mesh, fields);
  std::vector<std::pair<std::string, std::string>> texts;  // path, bytes
  std::vector<Edit> edits;
  std::size_t z = 0;
  for (Leaf const& leaf : blocks.leaves()) {
    std::string text = leaf.file->text();
    if (blocks.is_zone(leaf)) {
      if (z == mesh.zones.size())
        throw IoError(input + ": holds more zones than the mesh; give the file that was read");
      Zone const& zone = mesh.zones[z++];
      text = morphed_text(*leaf.file, mesh.dimension, zone.n_elements, part(before, zone), part(after, zone),
                          part(all, zone));
    } else if (blocks.is_surface(leaf)) {
      text = moved_surface(leaf, mesh, before, after);
    }
    fs::path const name = name_beside(target, texts.size(), leaf.path.extension().string());
    edits.push_back({leaf.attribute->begin, leaf.attribute->end, escaped(name.string())});
    fs::path const place = target.parent_path() / name;
    for (Leaf const& other : blocks.leaves())
      if (io::identity_of(place) == io::identity_of(other.path))
        throw IoError(place.string() +
                      ": is a file of the input, and an output would take its place; give another name");
    texts.emplace_back(place.string(), std::move(text));
  }
  if (z != mesh.zones.size()) throw IoError(input + ": holds fewer zones than the mesh; give the file that was read");
  texts.emplace_back(output, blocks.top().edited(std::move(edits)));
  io::MadeFolders made(folder);
  io::OutputFiles outputs;
  for (auto const& [path, text] : texts) outputs.add(path).write(text);
  outputs.commit();
  made.keep();
}

}  // namespace gridmorph::vtk
