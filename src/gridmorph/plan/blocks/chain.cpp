#include <gridmorph/plan/blocks/chain.hpp>

#include <algorithm>
#include <cstdlib>
#include <set>

namespace gridmorph {
namespace {

/// The orientation that takes block axis `axis` to s and the other two, in order, to a and b.
Orientation along(int axis) {
  Orientation o;
  int next = 1;
  for (int d = 0; d < 3; ++d) o.axis[d] = d == axis ? 0 : next++;
  return o;
}

struct Crossing {
  enum class Kind { known, boundary, through } kind = Kind::known;
  ChainEnd end;
  ChainStep next;
};

/// What lies beyond the lower (side 0) or upper (side 1) s face of a step.
Crossing cross(Mesh const& mesh, Topology const& topology, Known const& known, ChainStep const& step, int side) {
  Lattice const& lattice = topology.lattice;
  Blocks const& blocks = topology.blocks;
  BlockFace const own_face = end_face(step, side);
  std::vector<int> const entities = blocks.face_entities(lattice, own_face);

  Crossing crossing;
  bool all_known = true;
  for (int e : entities) all_known = all_known && known(lattice.class_of(e));
  int const face = lattice.class_of(entities.front());
  int const patch = blocks.patch_of_face()[face];
  crossing.end = {all_known, all_known ? known.kind[face] : unknown_end, patch};
  if (all_known)
    crossing.end.patches = known.patches[face];
  else if (patch >= 0)
    crossing.end.patches = {patch};
  if (all_known) return crossing;
  auto const sides = lattice.face_sides(face);
  if (sides.size() != 2) {
    crossing.kind = Crossing::Kind::boundary;
    return crossing;
  }
  crossing.kind = Crossing::Kind::through;
  // A block that touches itself has both sides; ours is the one with this face entity on this side of the piece.
  bool const first_is_ours = sides[0].entity == entities.front() && blocks.face_of(sides[0]) == own_face;
  FaceSide const& ours = first_is_ours ? sides[0] : sides[1];
  FaceSide const& theirs = first_is_ours ? sides[1] : sides[0];
  ChainStep& next = crossing.next;
  next.block = blocks.block_of(theirs.piece);
  next.to_chain = blocks.to_block(theirs.piece)
                      .inverse()
                      .then(across(lattice, theirs, ours))
                      .then(blocks.to_block(ours.piece))
                      .then(step.to_chain);
  next.rotation = step.rotation;
  next.translation = step.translation;
  next.rotated = step.rotated;
  int const interface = blocks.interface_of_face()[face];
  if (interface >= 0 && mesh.interfaces[interface].periodic) {
    RigidTransform const &from = lattice.copy_of(ours.entity).transform, &to = lattice.copy_of(theirs.entity).transform;
    Mat3 const to_owner = transpose(from.rotation);
    next.rotation = to.rotation * (to_owner * step.rotation);
    next.translation = to.rotation * (to_owner * (step.translation - from.translation)) + to.translation;
    next.rotated = true;
  }
  return crossing;
}

}  // namespace

BlockFace end_face(ChainStep const& step, int side) {
  Orientation const to_block = step.to_chain.inverse();
  return {step.block, to_block.axis[0], to_block.sign[0] > 0 ? side : 1 - side};
}

std::optional<Chain> find_chain(Mesh const& mesh, Topology const& topology, Known const& known, int block, int axis) {
  ChainStep step{block, along(axis), {}, {}, false};
  std::set<int> seen{block};
  while (true) {  // back to where the chain starts
    Crossing const c = cross(mesh, topology, known, step, 0);
    if (c.kind != Crossing::Kind::through) break;
    if (!seen.insert(c.next.block).second) return std::nullopt;
    step = c.next;
  }
  step.rotation = {};
  step.translation = {};
  step.rotated = false;
  Chain chain;
  chain.first = cross(mesh, topology, known, step, 0).end;
  seen = {step.block};
  while (true) {
    chain.steps.push_back(step);
    Crossing const c = cross(mesh, topology, known, step, 1);
    if (c.kind != Crossing::Kind::through) {
      chain.last = c.end;
      return chain;
    }
    if (!seen.insert(c.next.block).second) return std::nullopt;
    step = c.next;
  }
}

std::optional<Chain> walk_from(Mesh const& mesh, Topology const& topology, Known const& known, BlockFace const& start,
                               std::function<bool(Chain const&)> const& enough) {
  ChainStep step{start.block, along(start.axis), {}, {}, false};
  if (start.side == 1) step.to_chain = step.to_chain.then({{0, 1, 2}, {-1, -1, 1}});
  Chain chain;
  chain.first = cross(mesh, topology, known, step, 0).end;
  std::set<int> seen;
  while (seen.insert(step.block).second) {
    chain.steps.push_back(step);
    if (enough(chain)) return chain;
    Crossing const c = cross(mesh, topology, known, step, 1);
    if (c.kind != Crossing::Kind::through) break;
    step = c.next;
  }
  return std::nullopt;
}

std::vector<std::string> end_names(Mesh const& mesh, ChainEnd const& end) {
  auto const name_of = [](auto const& any) { return any.families.empty() ? any.name : any.families.front(); };
  std::set<std::string> names;
  for (int const p : end.patches) {
    std::size_t const n = std::size_t(p), n_patches = mesh.patches.size();
    names.insert(n < n_patches ? name_of(mesh.patches[n]) : name_of(mesh.interfaces[n - n_patches]));
  }
  return {names.begin(), names.end()};
}

Chain reversed(Chain chain) {
  std::reverse(chain.steps.begin(), chain.steps.end());
  std::swap(chain.first, chain.last);
  Orientation const flip{{0, 1, 2}, {-1, -1, 1}};
  Mat3 const from_new_frame = chain.steps.front().rotated ? chain.steps.front().rotation : Mat3{};
  Vec3 const new_origin = chain.steps.front().translation;
  bool const rotated = chain.steps.front().rotated;
  for (ChainStep& step : chain.steps) {
    step.to_chain = step.to_chain.then(flip);
    // The frame of the first block becomes the chain's frame.
    if (rotated || step.rotated) {
      step.rotation = step.rotation * transpose(from_new_frame);
      step.translation = step.translation - step.rotation * new_origin;
    }
    step.rotated = rotated || step.rotated;
  }
  chain.steps.front().rotation = {};
  chain.steps.front().translation = {};
  chain.steps.front().rotated = false;
  return chain;
}

ChainLayout lay_out(Topology const& topology, Chain const& chain) {
  Blocks const& blocks = topology.blocks;
  Lattice const& lattice = topology.lattice;
  ChainLayout layout;
  layout.first_piece.push_back(0);
  auto extent = [&](ChainStep const& step, int chain_axis) {
    return blocks[step.block].n_pieces[step.to_chain.inverse().axis[chain_axis]];
  };
  layout.n[1] = extent(chain.steps.front(), 1);
  layout.n[2] = extent(chain.steps.front(), 2);
  for (ChainStep const& step : chain.steps) layout.first_piece.push_back(layout.first_piece.back() + extent(step, 0));
  layout.n[0] = layout.first_piece.back();
  layout.pieces.resize(std::size_t(layout.n[0]) * layout.n[1] * layout.n[2]);
  for (int m = 0; m < int(chain.steps.size()); ++m) {
    ChainStep const& step = chain.steps[m];
    Block const& block = blocks[step.block];
    for (int k = 0; k < block.n_pieces[2]; ++k)
      for (int j = 0; j < block.n_pieces[1]; ++j)
        for (int i = 0; i < block.n_pieces[0]; ++i) {
          Index3 const in_block{i, j, k};
          Index3 at{};
          for (int d = 0; d < 3; ++d)
            at[step.to_chain.axis[d]] = step.to_chain.sign[d] > 0 ? in_block[d] : block.n_pieces[d] - 1 - in_block[d];
          PlacedPiece const& placed = block.at(i, j, k);
          layout.pieces[std::size_t(layout.first_piece[m] + at[0]) +
                        std::size_t(layout.n[0]) * (at[1] + std::size_t(layout.n[1]) * at[2])] = {
              placed.piece, placed.to_block.then(step.to_chain), m};
        }
  }
  auto positions = [&](int chain_axis, std::vector<int>& begin) {
    int at = 0;
    for (int p = 0; p < layout.n[chain_axis]; ++p) {
      Index3 which{0, 0, 0};
      which[chain_axis] = p;
      ChainPiece const& piece = layout.at(which[0], which[1], which[2]);
      int const zone_axis = piece.to_chain.inverse().axis[chain_axis];
      // Neighbouring pieces share the nodes between them.
      begin.push_back(at);
      at += lattice.pieces()[piece.piece].nodes.extent(zone_axis) - 1;
    }
    return at + 1;
  };
  layout.n_nodes = {positions(0, layout.s_begin), positions(1, layout.a_begin), positions(2, layout.b_begin)};
  return layout;
}

int chain_entity(Lattice const& lattice, ChainPiece const& piece, Index3 const& which) {
  Index3 in_zone{};
  for (int d = 0; d < 3; ++d) {
    int const w = which[piece.to_chain.axis[d]];
    in_zone[d] = piece.to_chain.sign[d] > 0 ? w : 2 - w;
  }
  return lattice.entity_of_piece(piece.piece, in_zone);
}

PieceNodes piece_nodes(Mesh const& mesh, Lattice const& lattice, ChainPiece const& piece) {
  Piece const& p = lattice.pieces()[piece.piece];
  Zone const& zone = mesh.zones[p.zone];
  auto const stride = zone.strides();
  PieceNodes nodes;
  Index3 first{};
  for (int d = 0; d < 3; ++d) {
    int const c = piece.to_chain.axis[d];
    bool const forward = piece.to_chain.sign[d] > 0;
    first[d] = forward ? p.nodes.begin[d] : p.nodes.end[d] - 1;
    nodes.stride[c] = forward ? stride[d] : -stride[d];
    nodes.count[c] = p.nodes.extent(d);
  }
  nodes.first = zone.node(first);
  return nodes;
}

}  // namespace gridmorph
