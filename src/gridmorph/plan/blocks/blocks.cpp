#include <gridmorph/boundary/regions.hpp>
#include <gridmorph/plan/blocks/edge_star.hpp>
#include <gridmorph/plan/topology.hpp>

#include <algorithm>
#include <deque>
#include <map>
#include <numeric>
#include <set>

namespace gridmorph {
namespace {

class UnionFind {
 public:
  explicit UnionFind(int n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  int find(int a) {
    while (parent_[a] != a) a = parent_[a] = parent_[parent_[a]];
    return a;
  }
  void unite(int a, int b) { parent_[find(a)] = find(b); }

 private:
  std::vector<int> parent_;
};

}  // namespace

Orientation across(Lattice const& lattice, FaceSide const& from, FaceSide const& to) {
  return lattice.copy_of(from.entity)
      .from_owner.orientation.inverse()
      .then(lattice.copy_of(to.entity).from_owner.orientation);
}

Blocks::Blocks(Mesh const& mesh, Links const& links, Lattice const& lattice, MergeLimits const& limits) {
  label_faces(mesh, links, lattice);
  label_regions(mesh, lattice);
  std::vector<char> removable = removable_faces(mesh, links, lattice, limits);
  while (!assemble(lattice, removable)) {
  }
}

void Blocks::label_faces(Mesh const& mesh, Links const& links, Lattice const& lattice) {
  patch_of_face_.assign(lattice.n_classes(), -1);
  interface_of_face_.assign(lattice.n_classes(), -1);
  auto for_each_face_entity = [&](int zone, IndexRange const& range, auto&& visit) {
    ZoneCuts const& c = lattice.cuts()[zone];
    Index3 lo, hi;
    for (int a = 0; a < 3; ++a) {
      lo[a] = 2 * int(std::lower_bound(c[a].begin(), c[a].end(), range.begin[a]) - c[a].begin());
      hi[a] = 2 * int(std::lower_bound(c[a].begin(), c[a].end(), range.end[a] - 1) - c[a].begin());
    }
    for (int r = lo[2]; r <= hi[2]; ++r)
      for (int q = lo[1]; q <= hi[1]; ++q)
        for (int p = lo[0]; p <= hi[0]; ++p)
          if (p % 2 + q % 2 + r % 2 == 2) visit(lattice.class_of(lattice.entity(zone, {p, q, r})));
  };
  for (int p = 0; p < int(mesh.patches.size()); ++p)
    if (!is_box(mesh.patches[p]))
      for_each_face_entity(mesh.patches[p].zone, mesh.patches[p].range, [&](int f) { patch_of_face_[f] = p; });
  for (Link const& link : links.all)
    for_each_face_entity(link.zone, link.range, [&](int f) { interface_of_face_[f] = link.interface; });
}

/// Faces around regions belong to these where they are inside the domain.
void Blocks::label_regions(Mesh const& mesh, Lattice const& lattice) {
  auto const n = int(lattice.pieces().size());
  region_of_piece_.assign(n, -1);
  for (int p = 0; p < int(mesh.patches.size()); ++p) {
    Patch const& patch = mesh.patches[p];
    if (!is_box(patch)) continue;
    for (int piece = 0; piece < n; ++piece)
      if (region_of_piece_[piece] < 0 && is_within(lattice.pieces()[piece], patch)) region_of_piece_[piece] = p;
  }
  auto const region = [&](FaceSide const& side) {
    int const p = region_of_piece_[side.piece];
    return p < 0 ? std::string_view() : std::string_view(mesh.patches[p].name);
  };
  for (int piece = 0; piece < n; ++piece) {
    if (region_of_piece_[piece] < 0) continue;
    for (int axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 2; ++side) {
        Index3 which{1, 1, 1};
        which[axis] = 2 * side;
        int const face = lattice.class_of(lattice.entity_of_piece(piece, which));
        auto const sides = lattice.face_sides(face);
        if (patch_of_face_[face] < 0 && sides.size() == 2 && region(sides[0]) != region(sides[1]))
          patch_of_face_[face] = region_of_piece_[piece];
      }
  }
}

std::vector<char> Blocks::removable_faces(Mesh const& mesh, Links const& links, Lattice const& lattice,
                                          MergeLimits const& limits) {
  int const n = lattice.n_classes();
  std::vector<char> is_interior(n, 0), keep(n, 0);
  std::vector<int> label(n, 0);
  std::vector<char> periodic_interface(mesh.interfaces.size(), 0);
  for (Link const& link : links.all) periodic_interface[link.interface] = link.periodic;

  for (int c = 0; c < n; ++c) {
    if (lattice.dimension(lattice.copies(c).front().entity) != 2) continue;
    int const patch = patch_of_face_[c], face = interface_of_face_[c];
    if (patch >= 0) label[c] = 1 + limits.patch_label[patch];
    auto const sides = lattice.face_sides(c);
    if (sides.size() != 2) continue;
    is_interior[c] = 1;
    if (patch >= 0) keep[c] = 1;
    if (face >= 0 && periodic_interface[face]) {
      if (patch < 0) label[c] = -1 - limits.interface_label[face];
      keep[c] = 1;
    }
    if (sides[0].piece == sides[1].piece) keep[c] = 1;
  }
  for (CutPlane const& plane : limits.kept_planes) {
    ZoneCuts const& cuts = lattice.cuts()[plane.zone];
    int const c =
        int(std::lower_bound(cuts[plane.axis].begin(), cuts[plane.axis].end(), plane.index) - cuts[plane.axis].begin());
    int const u = plane.axis == 0 ? 1 : 0, v = plane.axis == 2 ? 1 : 2;
    for (int q = 1; q < 2 * int(cuts[v].size()) - 1; q += 2)
      for (int p = 1; p < 2 * int(cuts[u].size()) - 1; p += 2) {
        Index3 at;
        at[plane.axis] = 2 * c;
        at[u] = p;
        at[v] = q;
        keep[lattice.class_of(lattice.entity(plane.zone, at))] = 1;
      }
  }

  UnionFind sheets(n);
  std::vector<int> to_keep;
  for (int e = 0; e < n; ++e) {
    if (lattice.dimension(lattice.copies(e).front().entity) != 1) continue;
    EdgeStar const star = star_of(lattice, e);
    std::vector<int> interior, boundary;
    for (int f : star.faces) (is_interior[f] ? interior : boundary).push_back(f);
    // Four corners meet at a regular inner edge. A face that lies on two sides of it (a ring or a period of one piece)
    // touches all four and is its own opposite.
    bool const regular_inside = star.pieces.size() == 4 && boundary.empty() && interior.size() >= 2;
    bool const regular_boundary = star.pieces.size() == 2 && interior.size() == 1 && boundary.size() == 2;
    if (regular_inside) {
      auto opposite_of = [&](int f) {
        std::vector<int> apart;  // faces that share no piece corner with f
        int corners = 0;
        for (auto const& c : star.corner_faces) corners += c.first == f || c.second == f;
        if (corners == 4) return f;
        for (int g : interior)
          if (g != f && std::none_of(star.corner_faces.begin(), star.corner_faces.end(), [&](auto const& c) {
                return (c.first == f && c.second == g) || (c.first == g && c.second == f);
              }))
            apart.push_back(g);
        return apart.size() == 1 && corners == 2 ? apart.front() : -1;
      };
      bool regular = true;
      for (int f : interior) regular = regular && opposite_of(f) >= 0 && opposite_of(opposite_of(f)) == f;
      if (regular) {
        for (int f : interior) {
          int const opposite = opposite_of(f);
          sheets.unite(f, opposite);
          if (label[f] == label[opposite]) continue;
          for (int g : interior)
            if (g != f && g != opposite) to_keep.push_back(g);
        }
        continue;
      }
    }
    if (regular_boundary) {
      if (label[boundary[0]] != label[boundary[1]]) to_keep.push_back(interior[0]);
      continue;
    }
    to_keep.insert(to_keep.end(), interior.begin(), interior.end());
  }
  for (int f : to_keep) keep[f] = 1;
  std::vector<char> keep_sheet(n, 0), removable(n, 0);
  for (int f = 0; f < n; ++f)
    if (keep[f]) keep_sheet[sheets.find(f)] = 1;
  sheet_of_face_.resize(n);
  for (int f = 0; f < n; ++f) {
    sheet_of_face_[f] = sheets.find(f);
    removable[f] = is_interior[f] && !keep_sheet[sheet_of_face_[f]];
  }
  return removable;
}

/// Grows blocks through removable faces. False when a sheet had to be kept after all (pieces that close a ring, or do
/// not form a cuboid): `removable` is updated and the caller tries again.
bool Blocks::assemble(Lattice const& lattice, std::vector<char>& removable) {
  int const n = int(lattice.pieces().size());
  blocks_.clear();
  block_of_.assign(n, -1);
  to_block_.assign(n, {});
  std::vector<Index3> place(n);
  auto keep_sheet_of = [&](int face_class) {
    for (std::size_t f = 0; f < removable.size(); ++f)
      if (sheet_of_face_[f] == sheet_of_face_[face_class]) removable[f] = 0;
  };
  for (int seed = 0; seed < n; ++seed) {
    if (block_of_[seed] >= 0) continue;
    int const number = int(blocks_.size());
    std::vector<int> members{seed};
    block_of_[seed] = number;
    place[seed] = {0, 0, 0};
    int last_sheet = -1;
    for (std::size_t m = 0; m < members.size(); ++m) {
      int const piece = members[m];
      for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side) {
          Index3 which{1, 1, 1};
          which[axis] = 2 * side;
          int const face = lattice.class_of(lattice.entity_of_piece(piece, which));
          if (!removable[face]) continue;
          auto const sides = lattice.face_sides(face);
          FaceSide const& from = sides[0].piece == piece ? sides[0] : sides[1];
          FaceSide const& to = sides[0].piece == piece ? sides[1] : sides[0];
          Orientation const to_block = across(lattice, to, from).then(to_block_[piece]);
          Index3 step{0, 0, 0};
          step[axis] = side == 0 ? -1 : 1;
          step = to_block_[piece].apply(step);
          Index3 const there{place[piece][0] + step[0], place[piece][1] + step[1], place[piece][2] + step[2]};
          last_sheet = face;
          if (block_of_[to.piece] < 0) {
            block_of_[to.piece] = number;
            to_block_[to.piece] = to_block;
            place[to.piece] = there;
            members.push_back(to.piece);
          } else if (place[to.piece] != there || !(to_block_[to.piece] == to_block)) {
            // The piece comes up again at another place, or turned: these close a ring.
            keep_sheet_of(face);
            return false;
          }
        }
    }
    Index3 lo = place[seed], hi = place[seed];
    for (int p : members)
      for (int a = 0; a < 3; ++a) {
        lo[a] = std::min(lo[a], place[p][a]);
        hi[a] = std::max(hi[a], place[p][a]);
      }
    Block block;
    for (int a = 0; a < 3; ++a) block.n_pieces[a] = hi[a] - lo[a] + 1;
    std::size_t const volume = std::size_t(block.n_pieces[0]) * block.n_pieces[1] * block.n_pieces[2];
    std::set<Index3> distinct;
    for (int p : members) distinct.insert(place[p]);
    // Pieces that leave gaps in their box or lie on one another are no cuboid: the sheet passed last is kept.
    if (volume != members.size() || distinct.size() != members.size()) {
      keep_sheet_of(last_sheet);
      return false;
    }
    block.pieces.resize(volume);
    for (int p : members) {
      Index3 const at{place[p][0] - lo[0], place[p][1] - lo[1], place[p][2] - lo[2]};
      block.pieces[std::size_t(at[0]) + std::size_t(block.n_pieces[0]) *
                                            (at[1] + std::size_t(block.n_pieces[1]) * at[2])] = {p, to_block_[p]};
    }
    blocks_.push_back(std::move(block));
  }
  return true;
}

BlockFace Blocks::face_of(FaceSide const& side) const {
  Orientation const& placed = to_block_[side.piece];
  return {block_of_[side.piece], placed.axis[side.axis], placed.sign[side.axis] > 0 ? side.side : 1 - side.side};
}

std::vector<int> Blocks::face_entities(Lattice const& lattice, BlockFace const& face) const {
  Block const& block = blocks_[face.block];
  std::vector<int> entities;
  int const u = face.axis == 0 ? 1 : 0, v = face.axis == 2 ? 1 : 2;
  for (int q = 0; q < block.n_pieces[v]; ++q)
    for (int p = 0; p < block.n_pieces[u]; ++p) {
      Index3 at;
      at[face.axis] = face.side == 0 ? 0 : block.n_pieces[face.axis] - 1;
      at[u] = p;
      at[v] = q;
      PlacedPiece const& placed = block.at(at[0], at[1], at[2]);
      // The block axis in the piece's own axes.
      Orientation const to_piece = placed.to_block.inverse();
      int const axis = to_piece.axis[face.axis];
      int const side = to_piece.sign[face.axis] > 0 ? face.side : 1 - face.side;
      Index3 which{1, 1, 1};
      which[axis] = 2 * side;
      entities.push_back(lattice.entity_of_piece(placed.piece, which));
    }
  return entities;
}

}  // namespace gridmorph
