#include <gridmorph/core/for_all.hpp>
#include <gridmorph/mesh/detail/block_sides.hpp>
#include <gridmorph/mesh/detail/hex_links.hpp>
#include <gridmorph/mesh/found_blocks.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <optional>
#include <span>
#include <utility>

namespace gridmorph {

namespace {

using detail::CellSide, detail::cell_side, detail::corner_place, detail::HexLinks, detail::side_at, detail::side_axis,
    detail::side_end, detail::HexLink;

/// An edge of a cell by its two sides there.
struct CellEdge {
  int side, other;
};

/// Edge 4 a + b of a cell runs along axis a.
constexpr std::array<CellEdge, 12> make_edges() {
  std::array<CellEdge, 12> out{};
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 4; ++b) {
      int const first = a == 0 ? 1 : 0, second = a == 2 ? 1 : 2;
      out[4 * a + b] = {side_at[first][b & 1], side_at[second][b >> 1]};
    }
  return out;
}
constexpr std::array<CellEdge, 12> edges = make_edges();

/// A cell and two of its sides that have an edge in common: a place on the way around that edge.
struct Around {
  Index32 cell;
  int through, other;  ///< the side that is left through next, and the one that was come in by, or begun at
};

/// The cell behind `at.through`, which is left by its other side at the same edge. Only where something lies there.
Around next(HexLinks const& links, Around const& at) {
  HexLink const link = links.link(cell_side(at.cell, at.through));
  // The side that was begun at lies at an end of an axis of this cell; there it goes on along the same axis.
  int const axis = side_axis[at.other], there = link.turn->axes.axis[axis];
  bool const flipped = link.turn->axes.sign[axis] < 0;
  int const end = flipped ? 1 - side_end[at.other] : side_end[at.other];
  return {link.cell, side_at[there][end], link.side};
}

/// Whether four different cells lie around an edge inside: what is behind both of its sides has one behind it in
/// common. Where not, is_regular() goes all the way around.
bool has_four_cells(HexLinks const& links, Index32 cell, CellEdge const& edge) {
  if (links.behind(cell_side(cell, edge.side)) < 0 || links.behind(cell_side(cell, edge.other)) < 0) return false;
  Around const a = next(links, {cell, edge.side, edge.other}), b = next(links, {cell, edge.other, edge.side});
  CellSide const behind_b = links.behind(cell_side(b.cell, b.through));
  if (behind_b < 0 || links.behind(cell_side(a.cell, a.through)) < 0) return false;
  Around const c = next(links, a);
  bool const differ = a.cell != b.cell && a.cell != cell && b.cell != cell && c.cell != cell && c.cell != a.cell;
  return differ && cell_side(c.cell, c.through) == behind_b;
}

/// Whether grid lines go on through an edge: four cells around it, or on the boundary one or two.
bool is_regular(HexLinks const& links, Index32 cell, CellEdge const& edge) {
  if (has_four_cells(links, cell, edge)) return true;
  constexpr int most = 5;
  int count = 1;
  Around at{cell, edge.side, edge.other};
  for (; count <= most; ++count) {
    if (links.behind(cell_side(at.cell, at.through)) < 0) break;
    at = next(links, at);
    if (at.cell == cell && at.through == edge.side && at.other == edge.other) return count == 4;
  }
  if (count > most) return false;
  at = {cell, edge.other, edge.side};
  for (; count <= most; ++count) {
    if (links.behind(cell_side(at.cell, at.through)) < 0) return count <= 2;
    at = next(links, at);
  }
  return false;
}

/// The faces that are limits of blocks. A sheet is what one face reaches across regular edges; sheets from edges that
/// are not are limits, and others can be made so.
class Sheets {
 public:
  Sheets(HostInstance const& host, HexLinks const& links, Index n_cells)
      : links_(links), irregular_(std::size_t(n_cells), 0), limit_(std::size_t(6 * n_cells), 0) {
    detail::for_all(host, "gridmorph::regular_edges", n_cells, [&](Index e) {
      if (!links.is_hexahedron(Index32(e))) return;
      for (std::size_t k = 0; k < 12; ++k)
        if (!is_regular(links, Index32(e), edges[k])) irregular_[e] |= std::uint16_t(1u << k);
    });
    for (Index32 e = 0; e < n_cells; ++e)
      for (std::size_t k = 0; k < 12 && irregular_[e] != 0; ++k)
        if (is_irregular(e, k))
          for (int const side : {edges[k].side, edges[k].other}) make_limit(cell_side(e, side));
  }

  /// Blocks end at the whole sheet of a side.
  void make_limit(CellSide s) {
    std::vector<CellSide> pending;
    auto const mark = [&](CellSide side) {
      CellSide const other = links_.behind(side);
      if (other < 0 || limit_[side] != 0) return;
      limit_[side] = limit_[other] = 1;
      pending.push_back(side);
    };
    mark(s);
    while (!pending.empty()) {
      CellSide const from = pending.back();
      pending.pop_back();
      Index32 const e = from / 6;
      // At each regular edge inside it goes on behind the other side there.
      for (std::size_t k = 0; k < 12; ++k) {
        auto const [side, other] = edges[k];
        if ((side != from % 6 && other != from % 6) || is_irregular(e, k)) continue;
        int const through = side == from % 6 ? other : side;
        if (links_.behind(cell_side(e, through)) < 0) continue;
        Around const on = next(links_, {e, through, from % 6});
        mark(cell_side(on.cell, on.through));
      }
    }
  }
  [[nodiscard]] bool is_limit(CellSide s) const { return limit_[s] != 0; }

 private:
  [[nodiscard]] bool is_irregular(Index32 e, std::size_t edge) const { return (irregular_[e] & (1u << edge)) != 0; }

  HexLinks const& links_;
  std::vector<std::uint16_t> irregular_;  ///< a bit per edge
  std::vector<std::uint8_t> limit_;       ///< (6 cells), on both sides of a face
};

/// Where a cell lies in its block.
struct Placed {
  Index3 at{0, 0, 0};
  /// Of the block's axes, counted from 1, the ones that the cell's local axes run along, or (negative) against.
  std::array<std::int8_t, 3> along{1, 2, 3};

  [[nodiscard]] Orientation axes() const {
    Orientation out;
    for (std::size_t a = 0; a < 3; ++a) {
      out.axis[a] = std::abs(along[a]) - 1;
      out.sign[a] = along[a] > 0 ? 1 : -1;
    }
    return out;
  }
  void set(Orientation const& axes) {
    for (std::size_t a = 0; a < 3; ++a) along[a] = std::int8_t(axes.sign[a] * (axes.axis[a] + 1));
  }
};

/// A mesh of quadrilaterals with a layer of hexahedra on it, as readers do with blocks in the plane: node n has node
/// n + n_nodes above it. Zones are joined, since nobody sees them.
Mesh with_layer(Mesh const& flat) {
  auto const n_nodes = Index32(flat.n_nodes());
  Mesh out;
  Zone& zone = out.zones.emplace_back();
  zone.name = flat.zones.front().name;
  zone.n_nodes = 2 * flat.n_nodes();
  zone.n_elements = flat.n_elements();
  double area = 0;
  std::vector<Index32> nodes;
  auto const add_above = [&] {
    std::size_t const n = nodes.size();
    for (std::size_t k = 0; k < n; ++k) nodes.push_back(nodes[k] + n_nodes);
  };
  std::array<Patch, 2> planes;
  for (Patch& plane : planes) {
    plane.name = plane_patch_name;
    plane.bc_type = "BCSymmetryPlane";
    plane.kind = PatchKind::symmetry;
    plane.zone = 0;
  }
  auto const& x = flat.coordinates;
  for (Index e = 0; e < flat.n_elements(); ++e) {
    auto const corners = flat.elements.corners(e);
    nodes.assign(corners.begin(), corners.end());
    area += 0.5 * norm(cross(x[nodes[2]] - x[nodes[0]], x[nodes[3]] - x[nodes[1]]));
    planes[0].faces.add(nodes);
    add_above();
    planes[1].faces.add(std::span(nodes).last(4));
    out.elements.type.push_back(ElementType::hexahedron);
    out.elements.nodes.add(nodes);
  }
  for (Patch const& patch : flat.patches) {
    Patch& own = out.patches.emplace_back(patch);
    own.zone_in_file = flat.zones[patch.zone].name;
    own.zone = 0;
    own.faces = {};
    for (Index f = 0; f < patch.faces.size(); ++f) {
      auto const edge = patch.faces[f];
      own.faces.add(std::array{edge[0], edge[1], edge[1] + n_nodes, edge[0] + n_nodes});
    }
    for (Index32 const n : patch.nodes) own.nodes.push_back(n + n_nodes);
  }
  out.patches.insert(out.patches.end(), planes.begin(), planes.end());
  for (Connection const& connection : flat.connections) {
    Connection& own = out.connections.emplace_back(connection);
    own.zone = own.donor_zone = 0;
    for (Index32 const n : connection.nodes) own.nodes.push_back(n + n_nodes);
    for (Index32 const n : connection.donor_nodes) own.donor_nodes.push_back(n + n_nodes);
  }
  Vec3 const up = std::sqrt(area / double(std::max<Index>(1, flat.n_elements()))) * plane_normal(flat);
  out.coordinates = Coordinates(2 * flat.n_nodes());
  for (Index n = 0; n < flat.n_nodes(); ++n) {
    out.coordinates.set(n, x[n]);
    out.coordinates.set(n + n_nodes, x[n] + up);
  }
  return out;
}

/// The blocks of a mesh of hexahedra, cell by cell. `named`: the mesh that they are told of in.
class Search {
 public:
  Search(HostInstance const& host, Mesh const& mesh, UnstructuredTopology const& topology, Mesh const& named)
      : host_(host),
        mesh_(mesh),
        named_(named),
        links_(host, mesh, topology),
        sheets_(host, links_, mesh.n_elements()),
        placed_(std::size_t(mesh.n_elements())),
        block_(std::size_t(mesh.n_elements()), none) {}

  FoundBlocks run(BoundaryFacePatches const& face_patches) {
    FoundBlocks out;
    for (Index32 e = 0; e < mesh_.n_elements(); ++e) {
      if (block_[e] != none) continue;
      if (!links_.is_hexahedron(e)) {
        leave(out, {e}, "is no hexahedron");
        continue;
      }
      while (block_[e] == none) find_block(out, e);
    }
    if (out.n_left == 0) detail::add_block_sides(mesh_, links_, face_patches, places(), out.mesh);
    finish(out);
    return out;
  }

 private:
  static constexpr int none = -1, left = -2;

  /// The block around a cell; where it closes on itself it is cut, and found in the next call.
  void find_block(FoundBlocks& out, Index32 first) {
    std::vector<Index32> cells{first};
    placed_[first] = {};
    block_[first] = int(out.mesh.zones.size());
    std::optional<CellSide> conflict;
    for (std::size_t n = 0; n < cells.size() && !conflict; ++n) conflict = visit_neighbours(cells, cells[n]);
    if (conflict) {
      for (Index32 const e : cells) block_[e] = none;
      if (!sheets_.is_limit(*conflict)) return sheets_.make_limit(*conflict);
      return leave(out, cells, "lies among others whose indices contradict one another");
    }
    if (std::string const why = add_block(out, cells); !why.empty()) leave(out, cells, why);
  }

  /// Places what lies behind the sides of a cell. Returns the side behind which a cell has another place already.
  std::optional<CellSide> visit_neighbours(std::vector<Index32>& cells, Index32 e) {
    Placed const own = placed_[e];
    Orientation const axes = own.axes();
    int const block = block_[e];
    for (int side = 0; side < 6; ++side) {
      CellSide const s = cell_side(e, side);
      if (links_.behind(s) < 0 || sheets_.is_limit(s)) continue;
      HexLink const link = links_.link(s);
      int const axis = side_axis[side];
      Placed there{own.at, {}};
      there.set(link.turn->axes.inverse().then(axes));
      int const outwards = side_end[side] == 1 ? 1 : -1;
      there.at[axes.axis[axis]] += outwards * axes.sign[axis];
      if (block_[link.cell] == none) {
        block_[link.cell] = block;
        placed_[link.cell] = there;
        cells.push_back(link.cell);
        continue;
      }
      Placed const& known = placed_[link.cell];
      if (block_[link.cell] != block || known.at != there.at || known.along != there.along) return s;
    }
    return {};
  }

  /// Why the cells are no block; empty: they are one now.
  std::string add_block(FoundBlocks& out, std::vector<Index32> const& cells) {
    Index3 low = placed_[cells.front()].at, high = low;
    for (Index32 const e : cells)
      for (std::size_t a = 0; a < 3; ++a) {
        low[a] = std::min(low[a], placed_[e].at[a]);
        high[a] = std::max(high[a], placed_[e].at[a]);
      }
    Index3 const extent{high[0] - low[0] + 2, high[1] - low[1] + 2, high[2] - low[2] + 2};
    if (Index(extent[0] - 1) * (extent[1] - 1) * (extent[2] - 1) != Index(cells.size()))
      return "lies among others that fill no box of indices";
    for (Index32 const e : cells)
      for (std::size_t a = 0; a < 3; ++a) placed_[e].at[a] -= low[a];
    Mesh& mesh = out.mesh;
    auto const z = std::size_t(mesh.add_zone("block " + std::to_string(mesh.zones.size() + 1), extent));
    Zone const& zone = mesh.zones[z];
    auto const first_node = out.node.size(), first_cell = out.element.size();
    out.node.resize(first_node + std::size_t(zone.size()), -1);
    out.element.resize(first_cell + cells.size(), -1);
    auto const cell_at = [&](Index3 const& p) -> Index32& {
      return out.element[first_cell + std::size_t(p[0] + Index(extent[0] - 1) * (p[1] + Index(extent[1] - 1) * p[2]))];
    };
    for (Index32 const e : cells) cell_at(placed_[e].at) = e;
    std::atomic<bool> torn = false;
    detail::for_all(host_, "gridmorph::nodes_of_block", zone.size(), [&](Index local) {
      Index const n = zone.first_node + local;
      Index3 const p = zone.index(n);
      Index32 node = -1;
      for (int c = 0; c < 8; ++c) {
        Index3 const at{p[0] - (c & 1), p[1] - ((c >> 1) & 1), p[2] - (c >> 2)};
        if (!is_cell(at, extent)) continue;
        Index32 const e = cell_at(at), own = e < 0 ? -1 : links_.node(e, corner_at(placed_[e], c));
        if (own < 0 || (node >= 0 && node != own)) torn = true;
        node = own;
      }
      out.node[n] = node;
    });
    if (!torn) return {};
    out.node.resize(first_node);
    out.element.resize(first_cell);
    mesh.zones.pop_back();
    return "lies among others that are torn along a surface inside of them";
  }

  static bool is_cell(Index3 const& at, Index3 const& extent) {
    for (std::size_t a = 0; a < 3; ++a)
      if (at[a] < 0 || at[a] >= extent[a] - 1) return false;
    return true;
  }

  /// The corner of a cell that is at bit 0, 1, 2 of `place` along the axes of its block.
  static int corner_at(Placed const& placed, int place) {
    Orientation const axes = placed.axes();
    int local = 0;
    for (int a = 0; a < 3; ++a) {
      int const up = (place >> axes.axis[a]) & 1;
      local |= (axes.sign[a] > 0 ? up : 1 - up) << a;
    }
    return corner_place[local];
  }

  /// The indices of a corner in the block of its cell.
  [[nodiscard]] Index3 place_of(Index32 e, int corner) const {
    Orientation const axes = placed_[e].axes();
    Index3 out = placed_[e].at;
    for (std::size_t a = 0; a < 3; ++a) {
      int const up = (corner_place[corner] >> a) & 1;
      out[axes.axis[a]] += axes.sign[a] > 0 ? up : 1 - up;
    }
    return out;
  }

  void leave(FoundBlocks& out, std::vector<Index32> const& cells, std::string const& why) {
    for (Index32 const e : cells) block_[e] = left;
    if (out.n_left == 0) {
      Index32 const first = *std::min_element(cells.begin(), cells.end());
      out.why_left = describe_element(named_, first) + " " + why;
    }
    out.n_left += Index(cells.size());
  }

  /// Where all cells are.
  [[nodiscard]] detail::CellPlaces places() const {
    return {[this](Index32 e) { return block_[e]; }, [this](Index32 e) { return placed_[e].axes(); },
            [this](Index32 e) -> Index3 const& { return placed_[e].at; },
            [this](Index32 e, int c) { return place_of(e, c); }};
  }

  void finish(FoundBlocks& out) const {
    Mesh& mesh = out.mesh;
    mesh.dimension = named_.dimension;
    mesh.source = named_.source;
    mesh.families = named_.families;
    mesh.notes = named_.notes;
    mesh.coordinates = Coordinates(mesh.n_nodes());
    detail::for_all(host_, "gridmorph::coordinates_of_blocks", mesh.n_nodes(),
                    [&](Index n) { mesh.coordinates.set(n, mesh_.coordinates[out.node[n]]); });
    // Of a node's copies in the blocks the first leads back, in the plane that of the first plane.
    std::vector<Index32> of_representative(mesh_.n_nodes(), -1);
    for (std::size_t n = out.node.size(); n-- > 0;) of_representative[out.node[n]] = Index32(n);
    out.in_blocks.resize(named_.n_nodes());
    for (Index32 n = 0; n < named_.n_nodes(); ++n) out.in_blocks[n] = of_representative[links_.representative(n)];
    bool const single =
        std::all_of(named_.zones.begin(), named_.zones.end(), [](Zone const& zone) { return zone.single_precision; });
    for (Zone& zone : mesh.zones) zone.single_precision = single;
  }

  HostInstance host_;
  Mesh const &mesh_, &named_;
  HexLinks links_;
  Sheets sheets_;
  std::vector<Placed> placed_;
  std::vector<int> block_;
};

}  // namespace

FoundBlocks find_blocks(HostInstance const& host, Mesh const& mesh, UnstructuredTopology const& topology,
                        BoundaryFacePatches const& face_patches) {
  if (mesh.dimension == 3) return Search(host, mesh, topology, mesh).run(face_patches);
  for (Index e = 0; e < mesh.n_elements(); ++e)
    if (mesh.elements.type[e] != ElementType::quadrilateral) {
      FoundBlocks out;
      out.n_left = mesh.n_elements();
      out.why_left = describe_element(mesh, e) + " is no quadrilateral";
      return out;
    }
  Mesh const layer = with_layer(mesh);
  UnstructuredTopology const of_layer = make_topology(host, layer);
  FoundBlocks out = Search(host, layer, of_layer, mesh).run(find_face_patches(layer, of_layer));
  for (Index32& n : out.node)
    if (n >= mesh.n_nodes()) n -= Index32(mesh.n_nodes());
  return out;
}

}  // namespace gridmorph
