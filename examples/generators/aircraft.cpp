#include <generators/aircraft.hpp>
#include <generators/aircraft_surface.hpp>
#include <generators/node_joints.hpp>
#include <gridmorph/core/error.hpp>

#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace gridmorph {

namespace {

namespace aircraft_blocks {

using namespace aircraft;

/// A block of the mesh before its directions are changed: nodes of the lattice, or of the layer on a wall face, (two
/// ways along the wall, away from it).
struct Block {
  std::string name;
  WallFace const* wall = nullptr;
  IndexRange nodes;  ///< of the lattice
  Index3 extent{};
  Orientation stored{};  ///< from these indices to those in the mesh
};

/// One of the 48 for each zone, the same in every mesh.
Orientation some_orientation(int zone) {
  auto const draw = (std::uint64_t(zone) + 1) * 0x9E3779B97F4A7C15u >> 32;
  constexpr std::array<int, 3> axes[] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  Orientation o;
  o.axis = axes[draw % 6];
  for (int a = 0; a < 3; ++a) o.sign[a] = (draw >> (4 + a)) & 1 ? 1 : -1;
  return o;
}

/// Zones of the lattice lie between all its planes but that of the hinge and the one inboard of the aileron, which only
/// walls need.
std::vector<Block> lattice_blocks(Lattice const& lattice) {
  std::vector<Block> blocks;
  auto const next = [](int axis, int plane) {
    ++plane;
    bool const skipped = (axis == 0 && plane == i_hinge) || (axis == 1 && plane == j_aileron);
    return skipped ? plane + 1 : plane;
  };
  for (int k = 0; k < k_high; k = next(2, k))
    for (int j = 0; j < j_far; j = next(1, j))
      for (int i = 0; i < i_back; i = next(0, i)) {
        if (body({i, j, k}) != Part::none) continue;
        Block block;
        block.name = "H_" + std::to_string(i + 1) + "_" + std::to_string(j + 1) + "_" + std::to_string(k + 1);
        block.nodes = lattice.nodes({i, j, k}, {next(0, i), next(1, j), next(2, k)});
        for (int a = 0; a < 3; ++a) block.extent[a] = block.nodes.extent(a);
        blocks.push_back(block);
      }
  return blocks;
}

char const* name_of(Part part) {
  switch (part) {
    case Part::fuselage: return "fuselage";
    case Part::wing: return "wing";
    case Part::htail: return "htail";
    case Part::vtail: return "vtail";
    default: return "nacelle";
  }
}

std::string family_of(WallFace const& face) {
  bool const moves = face.part == Part::wing && face.cell[0] == i_hinge && face.cell[1] == j_aileron;
  return moves ? "aileron" : name_of(face.part);
}

std::vector<Block> wall_blocks(Lattice const& lattice, std::vector<WallFace> const& faces) {
  std::vector<Block> blocks;
  std::map<Part, int> count;
  for (WallFace const& face : faces) {
    Block block;
    block.name = std::string("O_") + name_of(face.part) + "_" + std::to_string(++count[face.part]);
    block.wall = &face;
    block.nodes = face.nodes;
    block.extent = {face.nodes.extent((face.axis + 1) % 3), face.nodes.extent((face.axis + 2) % 3), lattice.layers + 1};
    blocks.push_back(block);
  }
  return blocks;
}

/// The aircraft in blocks, with what its nodes are.
class Blocks {
 public:
  Blocks(double scale, AircraftOptions const& options)
      : lattice_(scale), faces_(wall_faces(lattice_)), blocks_(lattice_blocks(lattice_)) {
    auto const walls = wall_blocks(lattice_, faces_);
    blocks_.insert(blocks_.end(), walls.begin(), walls.end());
    if (!options.oriented)
      for (std::size_t b = 0; b < blocks_.size(); ++b) blocks_[b].stored = some_orientation(int(b));
  }
  [[nodiscard]] Index n_nodes() const {
    Index n = 0;
    for (Block const& b : blocks_) n += Index(b.extent[0]) * b.extent[1] * b.extent[2];
    return n;
  }
  [[nodiscard]] Mesh mesh(double first_cell) const;

 private:
  Lattice lattice_;
  std::vector<WallFace> faces_;
  std::vector<Block> blocks_;

  /// Indices of the block for those in the mesh.
  [[nodiscard]] static Index3 unstored(Block const& block, Index3 const& p) {
    Index3 own{};
    for (int a = 0; a < 3; ++a) {
      int const at = p[block.stored.axis[a]];
      own[a] = block.stored.sign[a] > 0 ? at : block.extent[a] - 1 - at;
    }
    return own;
  }
  [[nodiscard]] static Index3 on_lattice(Block const& block, Index3 const& own) {
    Index3 p = block.nodes.begin;
    if (block.wall == nullptr)
      for (int a = 0; a < 3; ++a) p[a] += own[a];
    else
      for (int a = 0; a < 2; ++a) p[(block.wall->axis + 1 + a) % 3] += own[a];
    return p;
  }
};

Mesh Blocks::mesh(double first_cell) const {
  Surface const surface(lattice_, faces_, first_cell);
  Mesh mesh;
  mesh.source = "aircraft";
  for (Block const& block : blocks_) {
    Index3 extent{};
    for (int a = 0; a < 3; ++a) extent[block.stored.axis[a]] = block.extent[a];
    mesh.add_zone(block.name, extent);
  }
  mesh.coordinates = Coordinates(mesh.n_nodes());
  for (std::size_t z = 0; z < blocks_.size(); ++z) {
    Block const& block = blocks_[z];
    Zone const& zone = mesh.zones[z];
    Index node = zone.first_node;
    for (int k = 0; k < zone.extent[2]; ++k)
      for (int j = 0; j < zone.extent[1]; ++j)
        for (int i = 0; i < zone.extent[0]; ++i) {
          Index3 const own = unstored(block, {i, j, k}), p = on_lattice(block, own);
          mesh.coordinates.set(node++, block.wall == nullptr
                                           ? lattice_.position(p)
                                           : surface.position(surface.number(lattice_.number(p)), own[2]));
        }
  }

  Index3 const all = lattice_.extent();
  Index const n_lattice = Index(all[0]) * all[1] * all[2];
  auto const identity = [&](int zone, Index3 const& stored) {
    Block const& block = blocks_[zone];
    Index3 const own = unstored(block, stored);
    Index const node = lattice_.number(on_lattice(block, own));
    if (block.wall == nullptr || own[2] == lattice_.layers) return node;
    return n_lattice + Index(surface.number(node)) * lattice_.layers + own[2];
  };
  mesh.families = {"fuselage", "wing", "aileron", "htail", "vtail", "nacelle", "symmetry", "farfield"};
  std::map<std::string, int> count;
  for (demo::OpenFace const& face : demo::join_by_nodes(mesh, identity)) {
    Block const& block = blocks_[face.zone];
    Index3 const own = unstored(block, face.range.begin);
    Index3 middle{};
    for (int a = 0; a < 3; ++a) middle[a] = (face.range.begin[a] + face.range.end[a] - 1) / 2;
    Index3 const at = unstored(block, middle);
    Patch patch;
    patch.zone = face.zone;
    patch.range = face.range;
    if (block.wall != nullptr && face.axis == block.stored.axis[2] && own[2] == 0) {
      patch.families = {family_of(*block.wall)};
      patch.bc_type = "BCWallViscous";
      patch.kind = PatchKind::wall;
    } else if (block.wall != nullptr || (block.stored.axis[1] == face.axis && on_lattice(block, at)[1] == 0)) {
      patch.families = {"symmetry"};
      patch.bc_type = "BCSymmetryPlane";
      patch.kind = PatchKind::symmetry;
    } else {
      patch.families = {"farfield"};
      patch.bc_type = "BCFarfield";
      patch.kind = PatchKind::farfield;
    }
    patch.name = patch.families[0] + "_" + std::to_string(++count[patch.families[0]]);
    mesh.patches.push_back(patch);
  }
  return mesh;
}

}  // namespace aircraft_blocks

}  // namespace

Mesh make_aircraft(AircraftOptions const& options) {
  using aircraft_blocks::Blocks;
  if (options.nodes < 100'000 || options.nodes > 1'000'000'000)
    throw ConfigError("an aircraft has 1e5 to 1e9 nodes, not " + std::to_string(options.nodes));
  if (!(options.first_cell >= 1e-6 && options.first_cell <= 0.02))
    throw ConfigError("the first cell of an aircraft is 1e-6 to 0.02 m high, not " +
                      std::to_string(options.first_cell));
  double low = 0.1, high = 20;
  for (int step = 0; step < 30; ++step) {
    double const scale = 0.5 * (low + high);
    (Blocks(scale, options).n_nodes() < options.nodes ? low : high) = scale;
  }
  return Blocks(high, options).mesh(options.first_cell);
}

}  // namespace gridmorph
