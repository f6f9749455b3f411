#include <gridmorph/mesh/detail/block_sides.hpp>

#include <algorithm>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace gridmorph::detail {

namespace {

/// What lies at one cell of a side of a block.
struct Behind {
  int patch = -1;                         ///< number among the patches of the elements
  int block = -1;                         ///< or the donor's
  int connection = -1;                    ///< of that, where it is periodic
  std::array<int, 2> on_patches{-1, -1};  ///< that list periodic sides too: this one, the donor's
  IndexMap to_donor{};                    ///< with the node (0, 0, 0) as its own origin

  [[nodiscard]] bool nothing() const { return patch < 0 && block < 0; }
  friend bool operator==(Behind const& a, Behind const& b) {
    return a.patch == b.patch && a.block == b.block && a.connection == b.connection && a.on_patches == b.on_patches &&
           a.to_donor.orientation == b.to_donor.orientation && a.to_donor.donor_origin == b.to_donor.donor_origin;
  }
};

/// One side of a block as a rectangle of cells.
struct BlockSide {
  int block, axis, end;
  std::array<int, 2> along;    ///< the other axes
  std::array<int, 2> cells;    ///< along these
  std::vector<Behind> behind;  ///< the first of the two fastest

  [[nodiscard]] Behind& at(int u, int v) { return behind[std::size_t(u) + std::size_t(cells[0]) * std::size_t(v)]; }
};

class Sides {
 public:
  Sides(Mesh const& mesh, HexLinks const& links, BoundaryFacePatches const& face_patches, CellPlaces const& places,
        Mesh& blocks)
      : mesh_(mesh), links_(links), face_patches_(face_patches), places_(places), blocks_(blocks) {
    for (int b = 0; b < int(blocks.zones.size()); ++b)
      for (int axis = 0; axis < 3; ++axis)
        for (int end = 0; end < 2; ++end) {
          Index3 const& e = blocks.zones[b].extent;
          std::array<int, 2> const along{axis == 0 ? 1 : 0, axis == 2 ? 1 : 2};
          std::array<int, 2> const cells{e[along[0]] - 1, e[along[1]] - 1};
          sides_.push_back({b, axis, end, along, cells, {}});
          sides_.back().behind.resize(std::size_t(cells[0]) * std::size_t(cells[1]));
        }
  }

  void run() {
    for (Index32 e = 0; e < mesh_.n_elements(); ++e)
      if (places_.block(e) >= 0) look_around(e);
    for (BlockSide& side : sides_) add_rectangles(side);
  }

 private:
  void look_around(Index32 e) {
    Orientation const axes = places_.axes(e);
    Index3 const& p = places_.at(e);
    Index3 const& extent = blocks_.zones[places_.block(e)].extent;
    for (int s = 0; s < 6; ++s) {
      auto const local = std::size_t(side_axis[s]);
      int const axis = axes.axis[local];
      int const end = axes.sign[local] > 0 ? side_end[s] : 1 - side_end[s];
      if (p[axis] != (end == 0 ? 0 : extent[axis] - 2)) continue;
      BlockSide& side = sides_[6 * places_.block(e) + 2 * axis + end];
      side.at(p[side.along[0]], p[side.along[1]]) = what_is_behind(e, s);
    }
  }

  [[nodiscard]] Behind what_is_behind(Index32 e, int s) const {
    CellSide const side = cell_side(e, s);
    if (links_.behind(side) >= 0) {
      HexLink const link = links_.link(side);
      // The one that comes first has the interface.
      auto const order = [&](Index32 cell, int of) { return std::tuple(places_.block(cell), places_.at(cell), of); };
      return order(e, s) < order(link.cell, link.side) ? across(e, s, link) : Behind();
    }
    Behind out;
    Index32 const f = links_.boundary_face(side);
    if (f < 0) return out;  // a line or a point
    if (auto const link = links_.periodic(side)) {
      Index32 const connection = links_.connection(side);
      if (connection % 2 != 0) return out;  // the side whose nodes the connection begins with has it
      out = across(e, s, *link);
      out.connection = connection / 2;
      out.on_patches = {patch_of(f), patch_of(links_.boundary_face(cell_side(link->cell, link->side)))};
      return out;
    }
    out.patch = patch_of(f);
    return out;
  }
  [[nodiscard]] int patch_of(Index32 face) const { return std::max(-1, face_patches_.patch[face]); }

  [[nodiscard]] Behind across(Index32 e, int s, HexLink const& link) const {
    Behind out;
    out.block = places_.block(link.cell);
    out.to_donor.orientation = places_.axes(e).inverse().then(link.turn->axes).then(places_.axes(link.cell));
    int const corner = corners_of_side(s)[0];
    Index3 const here = places_.node(e, corner), there = places_.node(link.cell, link.turn->corner[corner]),
                 step = out.to_donor.orientation.apply(here);
    for (std::size_t a = 0; a < 3; ++a) out.to_donor.donor_origin[a] = there[a] - step[a];
    return out;
  }

  void add_rectangles(BlockSide& side) {
    for (int v = 0; v < side.cells[1]; ++v)
      for (int u = 0; u < side.cells[0]; ++u) {
        Behind const what = side.at(u, v);
        if (what.nothing()) continue;
        auto const same_row = [&](int from, int to, int row) {
          for (int w = from; w < to; ++w)
            if (!(side.at(w, row) == what)) return false;
          return true;
        };
        int u_end = u + 1, v_end = v + 1;
        while (u_end < side.cells[0] && side.at(u_end, v) == what) ++u_end;
        while (v_end < side.cells[1] && same_row(u, u_end, v_end)) ++v_end;
        for (int w = v; w < v_end; ++w)
          for (int k = u; k < u_end; ++k) side.at(k, w) = {};
        add(side, what, {u, v}, {u_end, v_end});
      }
  }

  void add(BlockSide const& side, Behind const& what, std::array<int, 2> const& from, std::array<int, 2> const& to) {
    IndexRange range;
    int const plane = side.end == 0 ? 0 : blocks_.zones[side.block].extent[side.axis] - 1;
    range.begin[side.axis] = plane;
    range.end[side.axis] = plane + 1;
    for (std::size_t k = 0; k < 2; ++k) {
      range.begin[side.along[k]] = from[k];
      range.end[side.along[k]] = to[k] + 1;
    }
    if (what.patch >= 0) {
      Patch const& of = mesh_.patches[what.patch];
      Patch patch;
      patch.name = of.name;
      patch.bc_type = of.bc_type;
      patch.kind = of.kind;
      patch.families = of.families;
      patch.zone_in_file = zone_in_file(of);
      patch.zone = side.block;
      patch.range = range;
      blocks_.patches.push_back(std::move(patch));
      return;
    }
    Interface1to1 out;
    out.zone = side.block;
    out.donor_zone = what.block;
    out.range = range;
    // The origins as files have them: the first node of the range.
    out.to_donor = {what.to_donor.orientation, range.begin, what.to_donor(range.begin)};
    out.name = "interface " + std::to_string(blocks_.interfaces.size() + 1);
    if (what.connection >= 0) {
      Connection const& c = mesh_.connections[what.connection];
      out.name = c.name;
      out.families = c.families;
      out.zone_in_file = mesh_.zones[c.zone].name;
      out.periodic = c.periodic;
      // Rules that name what lists the same faces go on doing so.
      for (int const p : what.on_patches)
        if (p >= 0) add_names(mesh_.patches[p], out.families);
      for (Connection const& other : mesh_.connections)
        if (&other != &c && other.periodic && same_nodes(other.nodes, c.donor_nodes)) add_names(other, out.families);
    }
    blocks_.interfaces.push_back(std::move(out));
  }

  [[nodiscard]] std::string const& zone_in_file(Patch const& of) const {
    return of.zone_in_file.empty() ? mesh_.zones[of.zone].name : of.zone_in_file;
  }

  static bool same_nodes(std::vector<Index32> const& of_a, std::vector<Index32> const& of_b) {
    if (of_a.size() != of_b.size()) return false;
    auto a = of_a, b = of_b;
    std::sort(a.begin(), a.end());
    std::sort(b.begin(), b.end());
    return a == b;
  }

  template <class Named>
  static void add_names(Named const& patch, std::vector<std::string>& to) {
    auto const add = [&](std::string const& name) {
      if (std::find(to.begin(), to.end(), name) == to.end()) to.push_back(name);
    };
    add(patch.name);
    for (std::string const& family : patch.families) add(family);
  }

  Mesh const& mesh_;
  HexLinks const& links_;
  BoundaryFacePatches const& face_patches_;
  CellPlaces const& places_;
  Mesh& blocks_;
  std::vector<BlockSide> sides_;
};

}  // namespace

void add_block_sides(Mesh const& mesh, HexLinks const& links, BoundaryFacePatches const& face_patches,
                     CellPlaces const& places, Mesh& blocks) {
  Sides(mesh, links, face_patches, places, blocks).run();
}

}  // namespace gridmorph::detail
