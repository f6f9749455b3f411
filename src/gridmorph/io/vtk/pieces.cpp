#include <gridmorph/core/error.hpp>
#include <gridmorph/geometry/point_numbers.hpp>
#include <gridmorph/io/files_read.hpp>
#include <gridmorph/io/made_folders.hpp>
#include <gridmorph/io/output_file.hpp>
#include <gridmorph/io/read_file.hpp>
#include <gridmorph/io/rest_of_boundary.hpp>
#include <gridmorph/io/vtk/blocks.hpp>
#include <gridmorph/io/vtk/grid_mesh.hpp>
#include <gridmorph/io/vtk/pieces.hpp>
#include <gridmorph/mesh/file_order.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <system_error>
#include <utility>

namespace gridmorph::vtk {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view parallel_type = "PUnstructuredGrid";

struct File {
  fs::path path;
  Attribute const* source = nullptr;  ///< the value of which is the path
  std::unique_ptr<XmlFile> file;
  std::vector<Grid> grids;
};

class Pieces {
 public:
  explicit Pieces(std::string const& path) {
    if (!is_parallel(io::read_head(path))) {
      files_.emplace_back().path = path;
      return;
    }
    top_.emplace(path, std::vector<std::string_view>{parallel_type});
    Tag const* grid = top_->root().child(parallel_type);
    if (grid == nullptr) top_->fail(top_->root(), "holds no <" + std::string(parallel_type) + ">");
    for (Tag const& piece : grid->children) {
      if (piece.name != "Piece") continue;
      auto const* source = piece.attribute("Source");
      if (source == nullptr) top_->fail(piece, "<Piece> has no Source");
      files_.push_back({fs::path(path).parent_path() / source->value, source, nullptr, {}});
    }
    if (files_.empty()) top_->fail(top_->root(), "names no files");
  }

  void read() {
    for (File& f : files_) {
      f.file = std::make_unique<XmlFile>(f.path.string(), std::vector<std::string_view>{"UnstructuredGrid"});
      f.grids = read_grids(*f.file);
      for (Grid const& grid : f.grids) grids_.push_back(&grid);
    }
    if (grids_.empty()) {
      XmlFile const& file = top_ ? *top_ : *files_.front().file;
      file.fail(file.root(), "holds no cells");
    }
  }

  [[nodiscard]] std::optional<XmlFile> const& top() const { return top_; }
  [[nodiscard]] std::vector<File> const& files() const { return files_; }
  [[nodiscard]] std::vector<Grid const*> const& grids() const { return grids_; }

 private:
  std::optional<XmlFile> top_;
  std::vector<File> files_;
  std::vector<Grid const*> grids_;
};

/// Joins zones by faces whose corners lie in the same places.
class Joiner {
 public:
  explicit Joiner(Mesh& mesh) : mesh_(mesh), topology_(make_topology(mesh)) {}

  void run() {
    BoundaryFaces const& faces = topology_.boundary;
    std::map<std::vector<int>, std::vector<Index32>> waiting;  // by place: faces without another side, ascending
    for (Index32 f = 0; f < Index32(faces.size()); ++f) {
      auto& same = waiting[places(f)];
      auto const other = std::find_if(same.begin(), same.end(), [&](Index32 g) { return zone(g) != zone(f); });
      if (other == same.end()) {
        same.push_back(f);
      } else {
        join(*other, f);
        same.erase(other);
      }
    }
    for (auto& [zones, pairs] : pairs_) {
      std::sort(pairs.begin(), pairs.end());
      pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
      Connection c;
      c.zone = zones.first;
      c.donor_zone = zones.second;
      c.name = mesh_.zones[c.zone].name + " to " + mesh_.zones[c.donor_zone].name;
      for (auto const& [own, donor] : pairs) {
        c.nodes.push_back(own);
        c.donor_nodes.push_back(donor);
      }
      mesh_.connections.push_back(std::move(c));
    }
  }

 private:
  [[nodiscard]] int zone(Index32 face) const { return mesh_.zone_of_element(topology_.boundary.element[face]); }
  /// Numbers of the places of corners and nodes amid edges, in order, each with its node.
  [[nodiscard]] std::vector<std::pair<int, Index32>> nodes(Index32 face) {
    std::vector<std::pair<int, Index32>> out;
    auto const add = [&](Index32 n) { out.emplace_back(numbers_.find_or_add(mesh_.coordinates[n], int(n)), n); };
    BoundaryFaces const& faces = topology_.boundary;
    for (Index32 const n : faces.nodes[face]) add(n);
    for (auto const& m : side_middle_nodes(mesh_, faces.element[face], faces.side[face])) add(m.node);
    std::sort(out.begin(), out.end());
    return out;
  }
  [[nodiscard]] std::vector<int> places(Index32 face) {
    std::vector<int> out;
    for (auto const& [place, node] : nodes(face)) out.push_back(place);
    return out;
  }
  void join(Index32 a, Index32 b) {
    if (zone(b) < zone(a)) std::swap(a, b);
    auto const own = nodes(a), donor = nodes(b);
    auto& pairs = pairs_[{zone(a), zone(b)}];
    for (std::size_t k = 0; k < own.size(); ++k) pairs.emplace_back(own[k].second, donor[k].second);
  }

  Mesh& mesh_;
  UnstructuredTopology topology_;
  PointNumbers numbers_{0};
  std::map<std::pair<int, int>, std::vector<std::pair<Index32, Index32>>> pairs_;
};

/// <PDataArray> for each field, so that readers of the whole show it.
void declare_fields(XmlFile const& top, OutputFields const& fields, FieldPrefixes const& prefixes,
                    std::vector<Edit>& edits) {
  auto const declare = [](std::string const& name, int components) {
    return "<PDataArray type=\"Float64\" Name=\"" + name + "\" NumberOfComponents=\"" + std::to_string(components) +
           "\"/>\n";
  };
  std::string points, cells;
  if (fields.displacement) points += declare(prefixes.points + "Displacement", 3);
  for (auto const& field : fields.nodes) points += declare(prefixes.points + field.name, 1);
  for (auto const& field : fields.cells) cells += declare(prefixes.cells + field.name, 1);
  Tag const& grid = *top.root().child(parallel_type);
  append_inside(grid, "PPointData", points, edits);
  append_inside(grid, "PCellData", cells, edits);
}

void check_ending(std::string const& input, std::string const& output, bool parallel) {
  auto const ending = fs::path(output).extension();
  if (parallel && ending != ".pvtu")
    throw IoError(output + ": is written as " + input +
                  " is, a parallel unstructured grid with a folder for its pieces; give it the ending .pvtu");
  if (!parallel && (ending == ".vtm" || ending == ".pvtu"))
    throw IoError(output + ": is written as " + input + " is, an unstructured grid; give it the ending .vtu");
}

}  // namespace

bool is_parallel(std::string_view head) {
  constexpr std::size_t start = 4096;
  auto const text = head.substr(0, start);
  return text.find("<VTKFile") != std::string_view::npos && text.find(parallel_type) != std::string_view::npos;
}

std::vector<fs::path> files_of_pieces(std::string const& path) {
  std::vector<fs::path> out;
  std::error_code ignored;
  Pieces const pieces(path);
  for (File const& file : pieces.files())
    if (fs::is_regular_file(file.path, ignored)) out.push_back(file.path);
  return out;
}

Mesh read_pieces(std::string const& path) {
  Pieces pieces(path);
  pieces.read();
  int dimension = 0;
  for (Grid const* grid : pieces.grids()) dimension = std::max(dimension, dimension_of(*grid));
  std::vector<std::string> names;
  std::vector<Mesh> meshes;
  for (File const& file : pieces.files())
    for (Grid const& grid : file.grids) {
      if (dimension_of(grid) != dimension)
        file.file->fail(*grid.piece,
                        "holds no cells of dimension " + std::to_string(dimension) +
                            ", and other pieces do; merge them in ParaView (Clean to Grid), or leave this one out");
      meshes.push_back(mesh_of(*file.file, grid));
      names.push_back("piece " + std::to_string(meshes.size()));
    }
  bool const alone = meshes.size() == 1;
  Mesh mesh = alone ? std::move(meshes.front()) : joined(names, meshes);
  mesh.source = path;
  if (!alone) {
    Joiner(mesh).run();
    Index pairs = 0;
    for (auto const& c : mesh.connections) pairs += Index(c.nodes.size());
    mesh.notes.push_back(path + ": " + std::to_string(meshes.size()) + " pieces are zones, joined at " +
                         std::to_string(pairs) + " pairs of points that lie in the same places");
    check_mesh(mesh);
  }
  io::add_rest_of_boundary(mesh);
  return mesh;
}

void write_morphed_pieces(std::string const& input, std::string const& output, Mesh const& mesh,
                          Coordinates const& morphed, OutputFields const& fields) {
  Pieces pieces(input);
  check_ending(input, output, pieces.top().has_value());
  pieces.read();
  if (pieces.grids().size() != mesh.zones.size())
    throw IoError(input + ": holds another mesh than the one that was read; give the file of that one");
  Coordinates const before = in_file_order(mesh, mesh.coordinates), after = in_file_order(mesh, morphed);
  OutputFields const all = in_order_of_the_file(mesh, fields);
  FieldPrefixes const prefixes = field_prefixes(pieces.grids(), all);
  std::vector<std::pair<std::string, std::string>> texts;  // path, bytes
  std::vector<Edit> top_edits;
  fs::path const target(output), folder = fs::path(target).replace_extension();
  io::MadeFolders made;
  std::size_t z = 0;
  for (File const& file : pieces.files()) {
    std::vector<Edit> edits;
    for (Grid const& grid : file.grids) {
      Zone const& zone = mesh.zones[z++];
      morph_grid(*file.file, grid, mesh.dimension, zone.n_elements, part(before, zone), part(after, zone),
                 part(all, zone), prefixes, edits);
    }
    fs::path place = target;
    if (pieces.top()) {
      fs::path const name = name_beside(target, texts.size(), ".vtu");
      top_edits.push_back({file.source->begin, file.source->end, escaped(name.string())});
      place = target.parent_path() / name;
      for (File const& other : pieces.files())
        if (io::identity_of(place) == io::identity_of(other.path))
          throw IoError(place.string() +
                        ": is a file of the input, and an output would take its place; give another name");
    }
    texts.emplace_back(place.string(), file.file->edited(std::move(edits)));
  }
  if (pieces.top()) {
    declare_fields(*pieces.top(), all, prefixes, top_edits);
    texts.emplace_back(output, pieces.top()->edited(std::move(top_edits)));
    made.make(folder);
  }
  io::OutputFiles outputs;
  for (auto const& [path, text] : texts) outputs.add(path).write(text);
  outputs.commit();
  made.keep();
}

}  // namespace gridmorph::vtk
